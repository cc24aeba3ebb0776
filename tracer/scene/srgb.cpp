#include "tracer/scene/srgb.h"

#include <cmath>
#include <limits>

namespace raypick {

namespace {

double linear_from(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

}  // namespace

const std::array<float, 256>& srgb_to_linear_table() {
    static const std::array<float, 256> by_byte = [] {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i)
            table[i] = static_cast<float>(linear_from(static_cast<double>(i) / 255.0));
        return table;
    }();
    return by_byte;
}

SrgbEncoder::SrgbEncoder() {
    for (std::size_t i = 0; i < upper_.size(); ++i)
        upper_[i] = static_cast<float>(linear_from((static_cast<double>(i) + 0.5) / 255.0));
    upper_[255] = std::numeric_limits<float>::infinity();
    std::uint8_t byte = 0;
    for (std::size_t step = 0; step < start_.size(); ++step) {
        while (static_cast<float>(step) / kSteps >= upper_[byte])
            ++byte;
        start_[step] = byte;
    }
}

std::uint8_t SrgbEncoder::byte(float linear) const {
    if (!(linear > 0.0f)) return 0;
    if (linear >= 1.0f) return 255;
    std::uint8_t byte = start_[static_cast<std::size_t>(linear * kSteps)];
    while (linear >= upper_[byte])
        ++byte;
    return byte;
}

}  // namespace raypick
