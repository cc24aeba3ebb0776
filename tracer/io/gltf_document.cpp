#include "tracer/io/gltf_document.h"

#include "tracer/error.h"
#include "tracer/io/base64.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace raypick {

namespace {

constexpr std::array<std::string_view, 9> kReadExtensions = {
    "KHR_lights_punctual",  "KHR_materials_emissive_strength",
    "KHR_materials_ior",    "KHR_materials_specular",
    "KHR_materials_unlit",  "KHR_materials_transmission",
    "KHR_materials_volume", "KHR_mesh_quantization",
    "KHR_texture_transform"};

constexpr std::array<std::string_view, 10> kArrays = {
    "accessors", "bufferViews", "buffers", "cameras",  "images",
    "materials", "meshes",      "nodes",   "samplers", "textures"};

constexpr std::size_t kHeaderSize = 12;  // of a GLB: magic, version, length
constexpr std::uint32_t kJsonChunk = 0x4e4f534au;
constexpr std::uint32_t kBinaryChunk = 0x004e4942u;

constexpr double kLargestWhole = 9007199254740992.0;  // 2^53
constexpr double kLargestReal = std::numeric_limits<double>::max();

bool is_read(std::string_view extension) {
    return std::find(kReadExtensions.begin(), kReadExtensions.end(), extension) !=
           kReadExtensions.end();
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = (value << 8u) | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

// %20 and the like.
std::string percent_decoded(std::string_view uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escape =
            uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        if (escape) {
            text += static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2]));
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

bool is_data_uri(std::string_view uri) {
    return uri.substr(0, 5) == "data:";
}

}  // namespace

GltfDocument::GltfDocument(const std::filesystem::path& file)
    : path_(file), file_(file.string()), bytes_(read_file(file)) {
    read_container(bytes_.view());
    json_ = parse_json(file_, json_text_);
    if (!json_.is_object()) root().refuse("an object");
    check_version();
    check_extensions();
    for (const std::string_view name : kArrays) {
        std::vector<JsonValue>& elements = arrays_[std::string(name)];
        if (const std::optional<JsonValue> found = root().find(name)) elements = found->elements();
    }
    buffers_.resize(array("buffers").size());
}

void GltfDocument::read_container(std::string_view bytes) {
    if (bytes.substr(0, 4) != "glTF") {
        json_text_ = bytes.substr(bytes.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0);
        return;
    }
    const auto fail = [&](std::size_t at, const std::string& complaint) {
        throw FileError(file_, fmt::format("byte {}: {}", at, complaint));
    };
    if (bytes.size() < kHeaderSize) fail(bytes.size(), "the file ends in the GLB header");
    if (word_at(bytes, 4) != 2) {
        fail(4, fmt::format("GLB version {} is not read: only 2", word_at(bytes, 4)));
    }
    const std::size_t promised = word_at(bytes, 8);
    if (promised > bytes.size()) {
        fail(8, fmt::format("the header promises {} bytes, but the file has {}", promised,
                            bytes.size()));
    }
    std::size_t at = kHeaderSize;
    while (at + 8 <= promised) {
        const std::size_t length = word_at(bytes, at);
        const std::uint32_t type = word_at(bytes, at + 4);
        if (length > promised - at - 8) {
            fail(at,
                 fmt::format("a chunk of {} bytes, but only {} follow", length, promised - at - 8));
        }
        const std::string_view chunk = bytes.substr(at + 8, length);
        if (type == kJsonChunk && json_text_.empty()) json_text_ = chunk;
        if (type == kBinaryChunk && !binary_chunk_) binary_chunk_ = chunk;
        at += 8 + length;
    }
    if (json_text_.empty()) fail(kHeaderSize, "the file has no JSON chunk");
}

void GltfDocument::check_version() const {
    const JsonValue asset = root().need("asset");
    const JsonValue version = asset.need("version");
    if (version.text().substr(0, 2) != "2.") version.refuse("\"2.0\"");
    const std::optional<JsonValue> least = asset.find("minVersion");
    if (least && least->text() != "2.0") least->refuse("\"2.0\"");
}

void GltfDocument::check_extensions() const {
    const std::optional<JsonValue> required = root().find("extensionsRequired");
    if (!required) return;
    for (const JsonValue& name : required->elements()) {
        if (is_read(name.text())) continue;
        name.fail(fmt::format("the file requires the extension {}, which is not read",
                              clean_name(name.text())));
    }
}

std::vector<std::string> GltfDocument::unread_extensions() const {
    std::vector<std::string> unread;
    const std::optional<JsonValue> used = root().find("extensionsUsed");
    if (!used) return unread;
    for (const JsonValue& name : used->elements()) {
        if (!is_read(name.text())) unread.push_back(clean_name(name.text()));
    }
    return unread;
}

const std::vector<JsonValue>& GltfDocument::array(std::string_view name) const {
    const auto found = arrays_.find(name);
    return found != arrays_.end() ? found->second : none_;
}

std::size_t GltfDocument::index(const JsonValue& reference, std::string_view name) const {
    const std::uint64_t index = whole_number(reference);
    const std::size_t count = array(name).size();
    if (index >= count) {
        reference.fail(
            fmt::format("{}/{} does not exist: the file has {} of them", name, index, count));
    }
    return static_cast<std::size_t>(index);
}

std::string_view GltfDocument::buffer_view(std::size_t index) {
    const JsonValue& view = array("bufferViews")[index];
    const std::string_view bytes = buffer(this->index(view.need("buffer"), "buffers"));
    const std::uint64_t offset = whole_number(view, "byteOffset", 0);
    const std::uint64_t length = whole_number(view.need("byteLength"));
    if (offset > bytes.size() || length > bytes.size() - offset) {
        view.fail(
            fmt::format("bytes {} to {} of a buffer of {}", offset, offset + length, bytes.size()));
    }
    return bytes.substr(offset, length);
}

std::string_view GltfDocument::buffer(std::size_t index) {
    const std::scoped_lock lock(buffers_mutex_);
    if (buffers_[index]) return *buffers_[index];
    const JsonValue& json = array("buffers")[index];
    const std::string_view bytes = load_buffer(index);
    const std::uint64_t length = whole_number(json.need("byteLength"));
    if (length > bytes.size()) {
        json.need("byteLength")
            .fail(fmt::format("promises {} bytes, but there are {}", length, bytes.size()));
    }
    buffers_[index] = bytes.substr(0, length);
    return *buffers_[index];
}

std::string_view GltfDocument::load_buffer(std::size_t index) {
    const JsonValue& json = array("buffers")[index];
    const std::optional<JsonValue> uri = json.find("uri");
    if (!uri) {
        if (index != 0 || !binary_chunk_) {
            json.fail("has no uri, and the file has no binary chunk for it");
        }
        return *binary_chunk_;
    }
    const std::string text = uri->text();
    if (is_data_uri(text)) return decoded_data(*uri, text);
    const std::filesystem::path path = path_beside(*uri, text);
    try {
        beside_.push_back(read_file(path));
    } catch (const FileError& error) {
        uri->fail(error.what());
    }
    return beside_.back().view();
}

std::string_view GltfDocument::decoded_data(const JsonValue& uri, std::string_view text) {
    const std::size_t comma = text.find(',');
    const bool base64 = comma != std::string_view::npos && comma >= 12 &&
                        text.compare(comma - 7, 7, ";base64") == 0;
    if (!base64) uri.fail("a data URI must be base64");
    std::optional<std::string> bytes = decode_base64(text.substr(comma + 1));
    if (!bytes) uri.fail("the data are not base64");
    decoded_.push_back(*std::move(bytes));
    return decoded_.back();
}

std::filesystem::path GltfDocument::path_beside(const JsonValue& uri,
                                                const std::string& text) const {
    const std::filesystem::path relative(percent_decoded(text));
    if (text.find("://") != std::string::npos || relative.is_absolute())
        uri.fail("must be a path relative to this file");
    return path_.parent_path() / relative;
}

ImageSource GltfDocument::texture_image(const JsonValue& texture) {
    ImageSource source;
    source.place = file_;
    try {
        const std::optional<JsonValue> reference = texture.find("source");
        if (!reference) texture.fail("has no source that is read");
        const std::size_t number = index(*reference, "images");
        if (const auto known = images_.find(number); known != images_.end()) return known->second;
        source.name = fmt::format("/images/{}", number);
        locate_image(number, source);
        images_.emplace(number, source);
    } catch (const FileError& error) {
        // Without the file's name, which the place is.
        const std::string complaint = std::string(error.what()).substr(error.file().size() + 2);
        if (source.name.empty()) source.name = complaint;
        source.problem = fmt::format("can't be read ({})", complaint);
    }
    return source;
}

void GltfDocument::locate_image(std::size_t index, ImageSource& source) {
    const JsonValue& json = array("images")[index];
    if (const std::optional<JsonValue> view = json.find("bufferView")) {
        source.bytes = buffer_view(this->index(*view, "bufferViews"));
        return;
    }
    const JsonValue uri = json.need("uri");
    const std::string& text = uri.text();
    if (is_data_uri(text)) {
        source.bytes = decoded_data(uri, text);
    } else {
        source.file = path_beside(uri, text);
        source.name = source.file.string();
    }
}

std::uint64_t whole_number(const JsonValue& value) {
    constexpr NumberRule kWhole{0.0, kLargestWhole, true, "a whole number, 0 or more"};
    const double number = value.number(kWhole);
    if (number != std::floor(number)) value.refuse(kWhole.words);
    return static_cast<std::uint64_t>(number);
}

std::uint64_t whole_number(const JsonValue& object, std::string_view key, std::uint64_t otherwise) {
    const std::optional<JsonValue> value = object.find(key);
    return value ? whole_number(*value) : otherwise;
}

double real_number(const JsonValue& value) {
    constexpr NumberRule kReal{-kLargestReal, kLargestReal, true, "a number"};
    return value.number(kReal);
}

double real_number(const JsonValue& object, std::string_view key, double otherwise) {
    const std::optional<JsonValue> value = object.find(key);
    return value ? real_number(*value) : otherwise;
}

bool boolean(const JsonValue& object, std::string_view key, bool otherwise) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value) return otherwise;
    if (!value->equals(true) && !value->equals(false)) value->refuse("true or false");
    return value->equals(true);
}

std::string name_of(const JsonValue& object) {
    const std::optional<JsonValue> name = object.find("name");
    if (!name) return "";
    return name->equals("") ? "" : clean_name(name->text());
}

std::optional<JsonValue> extension(const JsonValue& object, std::string_view name) {
    const std::optional<JsonValue> extensions = object.find("extensions");
    return extensions ? extensions->find(name) : std::nullopt;
}

}  // namespace raypick
