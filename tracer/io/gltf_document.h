// A glTF 2.0 file opened: its JSON and the bytes of its buffers, from .gltf or .glb.
#pragma once

#include "tracer/io/file_bytes.h"
#include "tracer/io/json_value.h"
#include "tracer/io/texture_library.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

class GltfDocument {
public:
    // Throws FileError: not glTF 2, an extension that is required and that we don't read, broken
    // JSON or container.
    explicit GltfDocument(const std::filesystem::path& file);
    GltfDocument(const GltfDocument&) = delete;
    GltfDocument& operator=(const GltfDocument&) = delete;
    ~GltfDocument() = default;

    // The elements of an array of the file's root; none if it is not there.
    [[nodiscard]] const std::vector<JsonValue>& array(std::string_view name) const;
    [[nodiscard]] JsonValue root() const { return {file_, json_}; }
    [[nodiscard]] const std::string& file() const { return file_; }
    // Extensions that are used, not required, and not read.
    [[nodiscard]] std::vector<std::string> unread_extensions() const;

    // The element of array `name` that `reference` (an index) names; fails if there is none.
    [[nodiscard]] std::size_t index(const JsonValue& reference, std::string_view name) const;

    // Bytes of a buffer view; read from beside the file or decoded when first asked for. Several
    // threads may ask at once.
    std::string_view buffer_view(std::size_t index);

    // The image of an element of /textures, wherever it is stored. What is wrong with it becomes
    // its problem, because a picture without it is better than none.
    ImageSource texture_image(const JsonValue& texture);

private:
    void read_container(std::string_view bytes);
    void check_version() const;
    void check_extensions() const;
    std::string_view buffer(std::size_t index);
    std::string_view load_buffer(std::size_t index);
    void locate_image(std::size_t index, ImageSource& source);
    std::string_view decoded_data(const JsonValue& uri, std::string_view text);
    [[nodiscard]] std::filesystem::path path_beside(const JsonValue& uri,
                                                    const std::string& text) const;

    std::filesystem::path path_;
    std::string file_;  // named in errors
    FileBytes bytes_;
    std::string_view json_text_;
    std::optional<std::string_view> binary_chunk_;
    Json json_;
    std::map<std::string, std::vector<JsonValue>, std::less<>> arrays_;
    std::vector<JsonValue> none_;
    std::mutex buffers_mutex_;
    std::vector<std::optional<std::string_view>> buffers_;
    std::list<std::string> decoded_;  // lists, because views point into them
    std::list<FileBytes> beside_;
    std::map<std::size_t, ImageSource> images_;
};

// Whole numbers 0, 1, 2, ... as counts, offsets and indices are.
std::uint64_t whole_number(const JsonValue& value);
std::uint64_t whole_number(const JsonValue& object, std::string_view key, std::uint64_t otherwise);

double real_number(const JsonValue& value);
double real_number(const JsonValue& object, std::string_view key, double otherwise);

bool boolean(const JsonValue& object, std::string_view key, bool otherwise);

// A name, cleaned; "" if there is none.
std::string name_of(const JsonValue& object);

// The object of an extension; nothing if it is not used there.
std::optional<JsonValue> extension(const JsonValue& object, std::string_view name);

}  // namespace raypick
