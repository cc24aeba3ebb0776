// Large arrays that several threads fill.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace raypick {

// Memory that has not been touched, in large pages where it is large and the system has them:
// getting a small page costs as much time as building a tree over what stands on it does. Throws
// std::bad_alloc.
void* allocate_large(std::size_t bytes, std::size_t alignment);
void free_large(void* memory, std::size_t bytes, std::size_t alignment) noexcept;

template <typename T>
struct LargeAllocator {
    static_assert(std::is_trivially_copyable_v<T>);
    using value_type = T;  // NOLINT(readability-identifier-naming): asked for by containers

    LargeAllocator() = default;
    template <typename U>
    explicit LargeAllocator(const LargeAllocator<U>& /*other*/) noexcept {}

    T* allocate(std::size_t count) {
        return static_cast<T*>(allocate_large(count * sizeof(T), alignof(T)));
    }
    void deallocate(T* memory, std::size_t count) noexcept {
        free_large(memory, count * sizeof(T), alignof(T));
    }
    // Without a value an element stays what the memory holds.
    template <typename U>
    void construct(U* /*element*/) noexcept {}
    template <typename U, typename... Values>
    void construct(U* element, Values&&... values) {
        std::construct_at(element, std::forward<Values>(values)...);
    }

    friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

// Its resize() leaves new elements uninitialised, for the threads that fill them.
template <typename T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

// Gives the memory back, which `array = {}` and clear() don't.
template <typename T>
void free_array(LargeArray<T>& array) {
    LargeArray<T>().swap(array);
}

}  // namespace raypick
