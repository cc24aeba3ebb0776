// Arrays of a scene file that are written as text: the base64 of their raw little-endian bytes.
// They keep every bit and are quick to read.
#pragma once

#include "tracer/io/base64.h"
#include "tracer/io/json_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace raypick {

// Turns numbers of `size` bytes each between this machine's order of bytes and little-endian.
inline void swap_if_big_endian(std::string& bytes, std::size_t size) {
    if constexpr (std::endian::native == std::endian::big) {
        for (std::size_t at = 0; at + size <= bytes.size(); at += size) {
            const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
            std::reverse(begin, begin + static_cast<std::ptrdiff_t>(size));
        }
    }
}

// Numbers that are written one by one can't be NaN or infinite either.
inline void check_finite(const JsonValue& value, std::span<const float> numbers, std::size_t size) {
    const auto broken = std::find_if_not(numbers.begin(), numbers.end(),
                                         [](float number) { return std::isfinite(number); });
    if (broken == numbers.end()) return;
    const auto place = static_cast<std::size_t>(broken - numbers.begin());
    value.fail(fmt::format("element {} holds {}, which is not finite", place / size, *broken));
}

// `Element` consists of numbers of type Number and nothing else.
template <typename Element, typename Number>
std::vector<Element> decode_array(const JsonValue& value) {
    static_assert(std::is_trivially_copyable_v<Element> && sizeof(Element) % sizeof(Number) == 0);
    std::optional<std::string> bytes = decode_base64(value.text_or_empty());
    if (!bytes) value.fail("is no base64");
    if (bytes->size() % sizeof(Element) != 0) {
        value.fail(fmt::format("holds {} bytes, which is no multiple of {}", bytes->size(),
                               sizeof(Element)));
    }
    swap_if_big_endian(*bytes, sizeof(Number));
    std::vector<Element> elements(bytes->size() / sizeof(Element));
    if (!elements.empty()) std::memcpy(elements.data(), bytes->data(), bytes->size());
    if constexpr (std::is_same_v<Number, float>) {
        constexpr std::size_t kSize = sizeof(Element) / sizeof(float);
        const auto* const first = reinterpret_cast<const float*>(elements.data());
        check_finite(value, {first, kSize * elements.size()}, kSize);
    }
    return elements;
}

}  // namespace raypick
