#include "tracer/render/srgb_bytes.h"

#include "tracer/render/image.h"

#include <bit>
#include <limits>

namespace raypick {

namespace {

// The least float in (0, 1] with a byte greater than `byte`. Positive floats are ordered as their
// bits are.
float first_above(std::uint8_t byte) {
    auto below = std::bit_cast<std::uint32_t>(0.0f);
    auto above = std::bit_cast<std::uint32_t>(1.0f);
    while (above - below > 1) {
        const std::uint32_t middle = below + (above - below) / 2;
        (srgb_byte(std::bit_cast<float>(middle)) > byte ? above : below) = middle;
    }
    return std::bit_cast<float>(above);
}

}  // namespace

SrgbBytes::SrgbBytes() {
    for (std::size_t byte = 0; byte < 255; ++byte)
        next_[byte] = first_above(static_cast<std::uint8_t>(byte));
    next_[255] = std::numeric_limits<float>::infinity();
    std::uint8_t byte = 0;
    for (std::size_t step = 0; step < start_.size(); ++step) {
        while (static_cast<float>(step) / kSteps >= next_[byte])
            ++byte;
        start_[step] = byte;
    }
}

}  // namespace raypick
