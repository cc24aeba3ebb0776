#include "viewer/cli/raster_start.h"

namespace raypick {

RasterStart::RasterStart(ImageSize size) {
    try {
        context_.emplace();
        rasterizer_.emplace();
        rasterizer_->warm_up(size);
    } catch (...) {
        failure_ = std::current_exception();
    }
}

const OffscreenContext& RasterStart::context() const {
    if (!context_) std::rethrow_exception(failure_);
    return *context_;
}

Rasterizer& RasterStart::rasterizer() {
    if (failure_) std::rethrow_exception(failure_);
    return *rasterizer_;
}

}  // namespace raypick
