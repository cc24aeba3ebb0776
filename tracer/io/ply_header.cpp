#include "tracer/io/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace raypick {

namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr std::array<TypeName, 16> kTypeNames{{
    {"char", PlyType::int8},
    {"int8", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},
    {"short", PlyType::int16},
    {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"uint16", PlyType::uint16},
    {"int", PlyType::int32},
    {"int32", PlyType::int32},
    {"uint", PlyType::uint32},
    {"uint32", PlyType::uint32},
    {"float", PlyType::float32},
    {"float32", PlyType::float32},
    {"double", PlyType::float64},
    {"float64", PlyType::float64},
}};

class HeaderParser {
public:
    HeaderParser(TextScanner& scanner, std::vector<std::string>& warnings)
        : scanner_(scanner), warnings_(warnings) {}

    PlyHeader parse() {
        if (scanner_.word() != "ply") scanner_.fail("does not begin with the word ply");
        do {
            scanner_.next_line();
            if (scanner_.at_end()) scanner_.fail("the header has no end_header");
        } while (read_line(scanner_.word()));
        scanner_.next_line();
        if (!format_given_) scanner_.fail("the header has no format line");
        header_.data_offset = scanner_.offset();
        return std::move(header_);
    }

private:
    // False after the last line.
    bool read_line(std::string_view keyword) {
        if (keyword == "format") {
            read_format();
        } else if (keyword == "element") {
            read_element();
        } else if (keyword == "property") {
            read_property();
        } else if (keyword == "end_header") {
            return false;
        } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info" &&
                   !std::exchange(told_unknown_, true)) {
            warnings_.push_back(
                scanner_.place(in_quotes(keyword) + " is no PLY keyword: the line is ignored"));
        }
        return true;
    }

    void read_format() {
        const std::string_view word = scanner_.word();
        if (word == "ascii") {
            header_.format = PlyFormat::ascii;
        } else if (word == "binary_little_endian") {
            header_.format = PlyFormat::little_endian;
        } else if (word == "binary_big_endian") {
            header_.format = PlyFormat::big_endian;
        } else {
            scanner_.fail(in_quotes(word) +
                          " is no PLY format: ascii, binary_little_endian or "
                          "binary_big_endian");
        }
        format_given_ = true;
    }

    void read_element() {
        PlyElement element;
        element.name = scanner_.word();
        element.line = scanner_.line(scanner_.offset());
        const std::string_view count = scanner_.word();
        const auto [stop, error] =
            std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc() || stop != count.data() + count.size()) {
            scanner_.fail(fmt::format("the number of elements {} is {}: not a count",
                                      in_quotes(element.name), in_quotes(count)));
        }
        header_.elements.push_back(std::move(element));
    }

    void read_property() {
        if (header_.elements.empty()) scanner_.fail("a property before the first element");
        PlyProperty property;
        std::string_view type_word = scanner_.word();
        if (type_word == "list") {
            property.list_count = type(scanner_.word());
            const bool whole = *property.list_count != PlyType::float32 &&
                               *property.list_count != PlyType::float64;
            if (!whole) scanner_.fail("the length of a list must have an integer type");
            type_word = scanner_.word();
        }
        property.type = type(type_word);
        property.name = scanner_.word();
        if (property.name.empty()) scanner_.fail("a property without a name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    [[nodiscard]] PlyType type(std::string_view word) const {
        const auto* const known = std::find_if(kTypeNames.begin(), kTypeNames.end(),
                                               [&](const TypeName& t) { return t.name == word; });
        if (known == kTypeNames.end()) scanner_.fail(in_quotes(word) + " is no PLY type");
        return known->type;
    }

    TextScanner& scanner_;
    std::vector<std::string>& warnings_;
    PlyHeader header_;
    bool format_given_ = false;
    bool told_unknown_ = false;
};

}  // namespace

std::size_t byte_size(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::int32:
        case PlyType::uint32:
        case PlyType::float32:
            return 4;
        case PlyType::float64:
            break;
    }
    return 8;
}

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
        if (properties[i].name == property) return i;
    }
    return std::nullopt;
}

std::size_t PlyElement::smallest_item(PlyFormat format) const {
    if (format == PlyFormat::ascii) return 2 * properties.size();  // a digit and a blank each
    std::size_t size = 0;
    for (const PlyProperty& property : properties)
        size += byte_size(property.list_count.value_or(property.type));
    return size;
}

PlyHeader parse_ply_header(TextScanner& scanner, std::vector<std::string>& warnings) {
    return HeaderParser(scanner, warnings).parse();
}

}  // namespace raypick
