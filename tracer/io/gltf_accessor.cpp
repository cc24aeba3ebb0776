#include "tracer/io/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace raypick {

namespace {

static_assert(std::endian::native == std::endian::little,
              "glTF is little-endian, and is read as it stands");

// An accessor without a buffer view is all zeros; more of them than this are no model.
constexpr std::uint64_t kMaxZeros = 1u << 26u;

std::size_t component_count(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    return 3;
}

template <typename T>
T load(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

}  // namespace

GltfAccessor::GltfAccessor(GltfDocument& document, std::size_t index, std::string_view type)
    : json_(document.array("accessors")[index]), components_(component_count(type)) {
    const JsonValue found = json_.need("type");
    if (found.text() != type) found.refuse(fmt::format("\"{}\" here", type));
    const std::uint64_t count = whole_number(json_.need("count"));
    if (count > std::numeric_limits<std::uint32_t>::max()) {
        json_.need("count").fail("too many elements for this program");
    }
    count_ = static_cast<std::size_t>(count);
    normalized_ = boolean(json_, "normalized", false);
    base_.component = component_type(json_);
    if (json_.find("bufferView")) {
        base_ = array(document, json_, count_, components_, base_.component);
    } else {
        if (count > kMaxZeros) json_.need("count").fail("too many elements without a bufferView");
    }
    if (const std::optional<JsonValue> sparse = json_.find("sparse")) {
        read_sparse(document, *sparse);
    }
}

GltfAccessor::Array GltfAccessor::array(GltfDocument& document, const JsonValue& json,
                                        std::size_t count, std::size_t components,
                                        Component component) {
    Array result;
    const std::size_t view_index = document.index(json.need("bufferView"), "bufferViews");
    const std::string_view bytes = document.buffer_view(view_index);
    result.component = component;
    const std::size_t element_size = components * size_of(result.component);
    const JsonValue& view = document.array("bufferViews")[view_index];
    const std::uint64_t stride = whole_number(view, "byteStride", element_size);
    const std::uint64_t offset = whole_number(json, "byteOffset", 0);
    constexpr std::uint64_t kLargestStride = 252;  // by the specification
    if (stride < element_size) view.need("byteStride").fail("is less than an element");
    if (stride > std::max<std::uint64_t>(kLargestStride, element_size)) {
        view.need("byteStride").fail("must be at most 252");
    }
    const std::uint64_t needed =
        count == 0 ? 0 : (static_cast<std::uint64_t>(count) - 1) * stride + element_size;
    if (offset > bytes.size() || needed > bytes.size() - offset) {
        json.fail(fmt::format("{} elements need bytes {} to {} of a buffer view of {}", count,
                              offset, offset + needed, bytes.size()));
    }
    result.data = bytes.data() + offset;
    result.stride = static_cast<std::size_t>(stride);
    return result;
}

void GltfAccessor::read_sparse(GltfDocument& document, const JsonValue& sparse) {
    const std::uint64_t count = whole_number(sparse.need("count"));
    if (count > count_) sparse.need("count").fail("more than the accessor has elements");
    const JsonValue indices = sparse.need("indices");
    const Array where =
        array(document, indices, static_cast<std::size_t>(count), 1, component_type(indices));
    // The values have the accessor's own type.
    replacements_ = array(document, sparse.need("values"), static_cast<std::size_t>(count),
                          components_, base_.component);
    for (std::size_t i = 0; i < count; ++i) {
        const double index = read(where.data + i * where.stride, where.component);
        const bool ascending =
            index >= 0.0 && (replaced_.empty() || index > static_cast<double>(replaced_.back()));
        if (!ascending || !(index < static_cast<double>(count_))) {
            indices.fail(fmt::format("element {} is {}: indices must ascend and be less than {}", i,
                                     index, count_));
        }
        replaced_.push_back(static_cast<std::uint32_t>(index));
    }
}

const char* GltfAccessor::element(std::size_t index) const {
    if (!replaced_.empty()) {
        const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), index);
        if (found != replaced_.end() && *found == index) {
            const auto at = static_cast<std::size_t>(found - replaced_.begin());
            return replacements_.data + at * replacements_.stride;
        }
    }
    return base_.data == nullptr ? nullptr : base_.data + index * base_.stride;
}

double GltfAccessor::value(const char* element, std::size_t component) const {
    if (element == nullptr) return 0.0;
    const double value = read(element + component * size_of(base_.component), base_.component);
    if (!normalized_) return value;
    switch (base_.component) {
        case Component::int8:
            return std::max(value / 127.0, -1.0);
        case Component::uint8:
            return value / 255.0;
        case Component::int16:
            return std::max(value / 32767.0, -1.0);
        case Component::uint16:
            return value / 65535.0;
        case Component::uint32:
        case Component::float32:
            break;
    }
    return value;
}

glm::dvec3 GltfAccessor::vec3(std::size_t index) const {
    const char* const at = element(index);
    if (at != nullptr && base_.component == Component::float32) return load<glm::vec3>(at);
    return {value(at, 0), value(at, 1), value(at, 2)};
}

glm::dvec2 GltfAccessor::vec2(std::size_t index) const {
    const char* const at = element(index);
    if (at != nullptr && base_.component == Component::float32) return load<glm::vec2>(at);
    return {value(at, 0), value(at, 1)};
}

bool GltfAccessor::holds_indices() const {
    return base_.component == Component::uint8 || base_.component == Component::uint16 ||
           base_.component == Component::uint32;
}

std::uint32_t GltfAccessor::index(std::size_t element_index) const {
    const char* const at = element(element_index);
    if (at == nullptr) return 0;
    switch (base_.component) {
        case Component::uint32:
            return load<std::uint32_t>(at);
        case Component::uint16:
            return load<std::uint16_t>(at);
        default:
            return static_cast<std::uint32_t>(read(at, base_.component));
    }
}

void GltfAccessor::fail(std::size_t element, const std::string& complaint) const {
    json_.fail(fmt::format("element {}: {}", element, complaint));
}

GltfAccessor::Component GltfAccessor::component_type(const JsonValue& json) {
    const JsonValue type = json.need("componentType");
    const std::uint64_t number = whole_number(type);
    constexpr std::array<std::uint64_t, 6> kKnown = {5120, 5121, 5122, 5123, 5125, 5126};
    if (std::find(kKnown.begin(), kKnown.end(), number) == kKnown.end()) {
        type.refuse("one of 5120, 5121, 5122, 5123, 5125, 5126");
    }
    return static_cast<Component>(number);
}

std::size_t GltfAccessor::size_of(Component component) {
    switch (component) {
        case Component::int8:
        case Component::uint8:
            return 1;
        case Component::int16:
        case Component::uint16:
            return 2;
        case Component::uint32:
        case Component::float32:
            break;
    }
    return 4;
}

double GltfAccessor::read(const char* bytes, Component component) {
    switch (component) {
        case Component::int8:
            return load<std::int8_t>(bytes);
        case Component::uint8:
            return load<std::uint8_t>(bytes);
        case Component::int16:
            return load<std::int16_t>(bytes);
        case Component::uint16:
            return load<std::uint16_t>(bytes);
        case Component::uint32:
            return load<std::uint32_t>(bytes);
        case Component::float32:
            break;
    }
    return static_cast<double>(load<float>(bytes));
}

}  // namespace raypick
