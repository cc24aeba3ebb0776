#include "tracer/parallel/large_array.h"

#include <algorithm>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace raypick {

namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;

std::align_val_t aligned(std::size_t bytes, std::size_t alignment) {
    return std::align_val_t{bytes >= 2 * kLargePage ? std::max(alignment, kLargePage) : alignment};
}

}  // namespace

void* allocate_large(std::size_t bytes, std::size_t alignment) {
    void* const memory = ::operator new(bytes, aligned(bytes, alignment));
#ifdef MADV_HUGEPAGE
    if (bytes >= 2 * kLargePage) madvise(memory, bytes, MADV_HUGEPAGE);  // no harm if it fails
#endif
    return memory;
}

void free_large(void* memory, std::size_t bytes, std::size_t alignment) noexcept {
    ::operator delete(memory, aligned(bytes, alignment));
}

}  // namespace raypick
