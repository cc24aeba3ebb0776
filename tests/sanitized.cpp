#include "tests/sanitized.h"

namespace raypick {

bool is_sanitized() {
#if defined(RAYPICK_SANITIZED)
    return true;
#else
    return false;
#endif
}

}  // namespace raypick
