// Typed arrays in a glTF file's buffers.
#pragma once

#include "tracer/io/gltf_document.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

// An accessor checked against its buffer, so that every element can be read. The document must
// outlive it.
class GltfAccessor {
public:
    // `type` is what it must hold: "SCALAR", "VEC2", "VEC3". Throws FileError.
    GltfAccessor(GltfDocument& document, std::size_t index, std::string_view type);

    [[nodiscard]] std::size_t count() const { return count_; }

    // Integers scaled to [0, 1] or [-1, 1] if the accessor says so.
    [[nodiscard]] glm::dvec3 vec3(std::size_t index) const;
    [[nodiscard]] glm::dvec2 vec2(std::size_t index) const;
    // Of an accessor of unsigned integers.
    [[nodiscard]] std::uint32_t index(std::size_t element_index) const;
    [[nodiscard]] bool holds_indices() const;

    // Throws FileError that names the accessor and the element.
    [[noreturn]] void fail(std::size_t element, const std::string& complaint) const;

private:
    enum class Component {
        int8 = 5120,
        uint8 = 5121,
        int16 = 5122,
        uint16 = 5123,
        uint32 = 5125,
        float32 = 5126
    };

    // Elements at equal distances in a buffer view.
    struct Array {
        const char* data = nullptr;  // nullptr: all 0
        std::size_t stride = 0;
        Component component = Component::float32;
    };

    // The elements that `json` (an accessor, sparse indices or sparse values) describes.
    [[nodiscard]] static Array array(GltfDocument& document, const JsonValue& json,
                                     std::size_t count, std::size_t components,
                                     Component component);
    void read_sparse(GltfDocument& document, const JsonValue& sparse);
    [[nodiscard]] const char* element(std::size_t index) const;
    [[nodiscard]] double value(const char* element, std::size_t component) const;
    static Component component_type(const JsonValue& json);
    static std::size_t size_of(Component component);
    static double read(const char* bytes, Component component);

    JsonValue json_;
    std::size_t components_ = 0;
    std::size_t count_ = 0;
    bool normalized_ = false;
    Array base_;
    // Sparse: elements (ascending) whose values stand elsewhere.
    std::vector<std::uint32_t> replaced_;
    Array replacements_;
};

}  // namespace raypick
