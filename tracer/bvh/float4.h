// Four floats that are added, compared and so on at once, in the compiler's own vector type: on
// x86-64 these are SSE2's instructions, on ARM NEON's. For builders of trees, which gain nothing
// from wider ones: a box has three axes.
#pragma once

#include "tracer/geometry/bounds.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <cstring>
#include <limits>

namespace raypick {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

inline Float4 all4(float value) {
    return Float4{value, value, value, value};
}

// The second argument where one is NaN.
inline Float4 min4(Float4 a, Float4 b) {
    return a < b ? a : b;
}
inline Float4 max4(Float4 a, Float4 b) {
    return a > b ? a : b;
}

// The same bits.
inline Int4 bits_of(Float4 value) {
    Int4 bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return bits;
}
inline Float4 from_bits(Int4 bits) {
    Float4 value;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
}

// A box whose fourth lanes mean nothing. The default is empty.
struct Box4 {
    Float4 min = all4(std::numeric_limits<float>::infinity());
    Float4 max = all4(-std::numeric_limits<float>::infinity());

    void extend(Float4 p) {
        min = min4(min, p);
        max = max4(max, p);
    }
    void extend(const Box4& b) {
        min = min4(min, b.min);
        max = max4(max, b.max);
    }
    [[nodiscard]] float half_area() const {
        const Float4 e = from_bits(bits_of(max - min) & Int4{-1, -1, -1, 0});
        const Float4 sides = e * __builtin_shufflevector(e, e, 1, 2, 0, 3);
        return sides[0] + sides[1] + sides[2];
    }
    [[nodiscard]] Bounds bounds() const {
        return {glm::vec3(min[0], min[1], min[2]), glm::vec3(max[0], max[1], max[2])};
    }
};

}  // namespace raypick
