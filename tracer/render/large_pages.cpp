#include "tracer/render/large_pages.h"

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <memory>

namespace raypick {

void ask_for_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::size_t kWorthIt = std::size_t{1} << 21u;  // the size of a large page
    if (bytes < kWorthIt) return;
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    // From the first whole page to the last; the answer doesn't matter.
    if (std::align(page, page, memory, bytes) == nullptr) return;
    static_cast<void>(madvise(memory, bytes / page * page, MADV_HUGEPAGE));
#endif
}

}  // namespace raypick
