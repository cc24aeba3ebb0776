// The sRGB transfer curve for bytes (IEC 61966-2-1), by tables.
#pragma once

#include <array>
#include <cstdint>

namespace raypick {

// The linear value, 0..1, of each sRGB byte.
const std::array<float, 256>& srgb_to_linear_table();

// The sRGB byte nearest to linear values.
class SrgbEncoder {
public:
    SrgbEncoder();

    // NaN and values below 0 become 0, values above 1 become 255.
    [[nodiscard]] std::uint8_t byte(float linear) const;

private:
    static constexpr int kSteps = 4096;

    // The byte of i / kSteps; from there at most a few bytes up to that of any value before the
    // next.
    std::array<std::uint8_t, kSteps + 1> start_{};
    std::array<float, 256> upper_{};  // the least linear value that is nearer to the next byte
};

}  // namespace raypick
