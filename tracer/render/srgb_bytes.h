// srgb_byte() of many values, by tables.
#pragma once

#include <array>
#include <cstdint>

namespace raypick {

class SrgbBytes {
public:
    SrgbBytes();

    // srgb_byte(linear), for every float.
    [[nodiscard]] std::uint8_t operator()(float linear) const {
        if (!(linear > 0.0f)) return 0;
        if (linear >= 1.0f) return 255;
        std::uint8_t byte = start_[static_cast<std::size_t>(linear * kSteps)];
        while (linear >= next_[byte])
            ++byte;
        return byte;
    }

private:
    static constexpr int kSteps = 4096;

    // The byte of i / kSteps: that of any value before the next step is at most a few more.
    std::array<std::uint8_t, kSteps> start_{};
    std::array<float, 256> next_{};  // the least value that has a greater byte
};

}  // namespace raypick
