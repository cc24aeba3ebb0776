#include "tracer/io/file_kind.h"

#include "tracer/io/file_bytes.h"
#include "tracer/io/load.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <string_view>
#include <vector>

namespace raypick {

namespace {

constexpr std::size_t kHeadSize = 4096;

struct Ending {
    std::string_view ending;
    FileKind kind;
};

constexpr std::array<Ending, 7> kEndings{{
    {".json", FileKind::scene},
    {".obj", FileKind::obj},
    {".gltf", FileKind::gltf},
    {".glb", FileKind::gltf},
    {".ply", FileKind::ply},
    {".stl", FileKind::stl},
    {".nff", FileKind::nff},
}};

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::optional<FileKind> kind_by_ending(const std::filesystem::path& file) {
    const std::string ending = lower_case(file.extension().string());
    for (const Ending& known : kEndings) {
        if (known.ending == ending) return known.kind;
    }
    return std::nullopt;
}

bool begins_with(std::string_view text, std::string_view start) {
    return text.substr(0, start.size()) == start;
}

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

std::string_view without_mark_and_blanks(std::string_view text) {
    if (begins_with(text, "\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

std::uint32_t binary_stl_facets(std::string_view bytes) {
    std::uint32_t count = 0;
    for (std::size_t i = 4; i-- > 0;)
        count = (count << 8u) | static_cast<unsigned char>(bytes[80 + i]);
    return count;
}

bool has_binary_stl_size(const FileHead& head) {
    return head.bytes.size() >= 84 &&
           head.file_size == 84 + std::uint64_t{50} * binary_stl_facets(head.bytes);
}

bool begins_with_solid(const FileHead& head) {
    const std::string_view text = without_mark_and_blanks(head.bytes);
    return begins_with(lower_case(std::string(text.substr(0, 5))), "solid");
}

// JSON is ours unless it says that it is glTF.
FileKind json_kind(const std::filesystem::path& file, std::string_view text) {
    const std::optional<FileKind> named = kind_by_ending(file);
    if (named == FileKind::scene || named == FileKind::gltf) return *named;
    const bool gltf = contains(text, "\"asset\"") || contains(text, "\"bufferViews\"") ||
                      contains(text, "\"accessors\"");
    return gltf ? FileKind::gltf : FileKind::scene;
}

// Does the first line that is no comment look like OBJ?
bool looks_like_obj(std::string_view text) {
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
        if (!word.empty() && word[0] != '#') {
            constexpr std::array<std::string_view, 9> kKeywords = {
                "v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"};
            return std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end();
        }
        text.remove_prefix(std::min(text.size(), line.size() + 1));
    }
    return false;
}

// Does the first line that is no comment look like NFF? What could as well be OBJ does not.
bool looks_like_nff(std::string_view text) {
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        const std::string_view rest = without_mark_and_blanks(line);
        if (!rest.empty() && rest[0] != '#') {
            const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r"));
            const bool alone = rest.find_last_not_of(" \t\r") + 1 == word.size();
            return word == "b" || (word == "v" && alone);
        }
        text.remove_prefix(std::min(text.size(), line.size() + 1));
    }
    return false;
}

}  // namespace

FileHead read_head(const std::filesystem::path& file) {
    FileHead head;
    const FileBytes bytes = read_file(file, kHeadSize);
    head.bytes = bytes.view();
    head.file_size = std::filesystem::file_size(file);
    return head;
}

bool is_binary_stl(const FileHead& head) {
    if (has_binary_stl_size(head)) return true;
    const bool text = !contains(head.bytes, std::string_view("\0", 1));
    return !(begins_with_solid(head) && text);
}

std::optional<FileKind> file_kind(const std::filesystem::path& file, const FileHead& head) {
    const std::string_view text = without_mark_and_blanks(head.bytes);
    if (begins_with(text, "glTF")) return FileKind::gltf;
    if (begins_with(text, "ply\n") || begins_with(text, "ply\r")) return FileKind::ply;
    if (begins_with_solid(head) || has_binary_stl_size(head)) return FileKind::stl;
    for (const std::string_view start : {"{", "//", "/*"}) {
        if (begins_with(text, start)) return json_kind(file, text);
    }
    if (const std::optional<FileKind> named = kind_by_ending(file)) return named;
    if (looks_like_nff(text)) return FileKind::nff;
    if (looks_like_obj(text)) return FileKind::obj;
    return std::nullopt;
}

std::vector<std::string> readable_extensions() {
    std::vector<std::string> endings;
    endings.reserve(kEndings.size());
    for (const Ending& known : kEndings)
        endings.emplace_back(known.ending);
    return endings;
}

}  // namespace raypick
