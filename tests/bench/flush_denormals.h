// The processor's mode that Embree's manual asks for.
#pragma once

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace raypick::bench {

// While it is there, this thread's denormal numbers are zeros.
class FlushDenormals {
public:
#ifdef __SSE__
    FlushDenormals() {
        _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero);
    }
    ~FlushDenormals() {
        _mm_setcsr(before_);
    }
#else
    FlushDenormals() = default;
    ~FlushDenormals() = default;
#endif
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
#ifdef __SSE__
    static constexpr unsigned kFlushToZero = 0x8000u;
    static constexpr unsigned kDenormalsAreZero = 0x0040u;

    unsigned before_ = _mm_getcsr();
#endif
};

}  // namespace raypick::bench
