// Which format a file has, told by its content first and by its name's ending second.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace raypick {

enum class FileKind { scene, obj, gltf, ply, stl, nff };

// A file's first bytes.
struct FileHead {
    std::string bytes;
    std::uint64_t file_size = 0;
};

// Throws FileError as read_file does.
FileHead read_head(const std::filesystem::path& file);

// Nothing if neither content nor name says what it is.
std::optional<FileKind> file_kind(const std::filesystem::path& file, const FileHead& head);

// Of an STL file: the text form begins with "solid", but so do some binary ones.
bool is_binary_stl(const FileHead& head);

}  // namespace raypick
