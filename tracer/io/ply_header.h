// What a PLY file says about itself before its data.
#pragma once

#include "tracer/io/text_scanner.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

enum class PlyFormat { ascii, little_endian, big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t byte_size(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> list_count;  // the type of the length, if this is a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::size_t line = 0;  // where the header promises it
    std::vector<PlyProperty> properties;

    // Place of a property; nothing if there is none of the name.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
    // What one item takes at least: bytes in a binary file (lists empty), characters in ascii.
    [[nodiscard]] std::size_t smallest_item(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::size_t data_offset = 0;  // of the first byte after the header
};

// Throws FileError with the line. Lines that the format doesn't know become warnings.
PlyHeader parse_ply_header(TextScanner& scanner, std::vector<std::string>& warnings);

}  // namespace raypick
