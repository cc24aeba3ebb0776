// Memory of large arrays in large pages.
#pragma once

#include <cstddef>
#include <vector>

namespace raypick {

// Asks for large pages where the system gives them on request (Linux: madvise): touching an image
// for the first time by small ones can take a tenth of the time that its rays take. Nothing
// happens where there are none. The memory must not have been touched yet.
void ask_for_large_pages(void* memory, std::size_t bytes);

// An array of `count` times this value.
template <typename T>
void fill_large(std::vector<T>& array, std::size_t count, const T& value) {
    array.reserve(count);
    ask_for_large_pages(array.data(), count * sizeof(T));
    array.assign(count, value);
}

}  // namespace raypick
