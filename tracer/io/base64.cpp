#include "tracer/io/base64.h"

#include <array>
#include <cstdint>

namespace raypick {

namespace {

constexpr std::uint8_t kInvalid = 0xff;
constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::uint8_t, 256> make_values() {
    std::array<std::uint8_t, 256> values{};
    for (std::uint8_t& value : values)
        value = kInvalid;
    for (std::size_t i = 0; i < kAlphabet.size(); ++i)
        values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
    return values;
}

constexpr std::array<std::uint8_t, 256> kValues = make_values();

}  // namespace

void append_base64(std::string& text, std::string_view bytes) {
    const auto byte = [bytes](std::size_t i) {
        return i < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i]))
                                : 0u;
    };
    text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::uint32_t group = (byte(i) << 16u) | (byte(i + 1) << 8u) | byte(i + 2);
        text += kAlphabet[group >> 18u];
        text += kAlphabet[(group >> 12u) & 63u];
        text += i + 1 < bytes.size() ? kAlphabet[(group >> 6u) & 63u] : '=';
        text += i + 2 < bytes.size() ? kAlphabet[group & 63u] : '=';
    }
}

std::optional<std::string> decode_base64(std::string_view text) {
    for (int i = 0; i < 2 && !text.empty() && text.back() == '='; ++i)
        text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::string bytes(text.size() / 4 * 3 + (text.size() % 4 == 0 ? 0 : text.size() % 4 - 1), '\0');
    std::uint32_t group = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::uint8_t value = kValues[static_cast<unsigned char>(text[i])];
        if (value == kInvalid) return std::nullopt;
        group = (group << 6u) | value;
        // After 2, 3 and 4 characters another byte is complete.
        const std::size_t phase = i % 4;
        if (phase == 0) continue;
        bytes[at++] =
            static_cast<char>((group >> (6u - 2u * static_cast<unsigned>(phase))) & 0xffu);
    }
    return bytes;
}

}  // namespace raypick
