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
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat},
    {"float32", PlyType::kFloat},
    {"double", PlyType::kDouble},
    {"float64", PlyType::kDouble},
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
            header_.format = PlyFormat::kAscii;
        } else if (word == "binary_little_endian") {
            header_.format = PlyFormat::kLittleEndian;
        } else if (word == "binary_big_endian") {
            header_.format = PlyFormat::kBigEndian;
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
            const bool whole =
                *property.list_count != PlyType::kFloat && *property.list_count != PlyType::kDouble;
            if (!whole) scanner_.fail("the length of a list must have an integer type");
            type_word = scanner_.word();
        }
        property.type = type(type_word);
        property.name = scanner_.word();
        if (property.name.empty()) scanner_.fail("a property without a name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    [[nodiscard]] PlyType type(std::string_view word) const {
        const auto known = std::find_if(kTypeNames.begin(), kTypeNames.end(),
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
        case PlyType::kInt8:
        case PlyType::kUint8:
            return 1;
        case PlyType::kInt16:
        case PlyType::kUint16:
            return 2;
        case PlyType::kInt32:
        case PlyType::kUint32:
        case PlyType::kFloat:
            return 4;
        case PlyType::kDouble:
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
    if (format == PlyFormat::kAscii) return 2 * properties.size();  // a digit and a blank each
    std::size_t size = 0;
    for (const PlyProperty& property : properties)
        size += byte_size(property.list_count.value_or(property.type));
    return size;
}

PlyHeader parse_ply_header(TextScanner& scanner, std::vector<std::string>& warnings) {
    return HeaderParser(scanner, warnings).parse();
}

}  // namespace raypick
