#include "tracer/scene/texel_coding.h"

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

constexpr double kOctaves = 13.0;
static_assert(kLogarithmicSpan == 1 << 13);

template <typename Value>
std::array<float, 256> table_of(const Value& value) {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = static_cast<float>(value(static_cast<double>(i) / 255.0));
    return table;
}

}  // namespace

const std::array<float, 256>& texel_values(TexelCoding coding) {
    static const std::array<float, 256> linear = table_of([](double x) { return x; });
    static const std::array<float, 256> logarithmic =
        table_of([](double x) { return std::exp2(kOctaves * (x - 1.0)); });
    switch (coding) {
        case TexelCoding::linear:
            return linear;
        case TexelCoding::logarithmic:
            return logarithmic;
        case TexelCoding::srgb:
            break;
    }
    return srgb_to_linear_table();
}

std::uint8_t TexelEncoder::byte(float value) const {
    if (coding_ == TexelCoding::srgb) return srgb_.byte(value);
    float share = value > 0.0f ? std::min(value, 1.0f) : 0.0f;
    if (coding_ == TexelCoding::logarithmic) {
        share = value > 1.0f / kLogarithmicSpan
                    ? std::min(1.0f + std::log2(value) / static_cast<float>(kOctaves), 1.0f)
                    : 0.0f;
    }
    return static_cast<std::uint8_t>(std::lround(255.0f * share));
}

}  // namespace raypick
