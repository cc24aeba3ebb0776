// OpenGL made ready for a frame while the scene is still being loaded.
#pragma once

#include "viewer/headless/offscreen_context.h"
#include "viewer/raster/rasterizer.h"

#include <exception>
#include <optional>

namespace raypick {

// Belongs to the thread that makes it.
class RasterStart {
public:
    // Throws nothing: what went wrong is kept until somebody asks for what failed.
    explicit RasterStart(ImageSize size);

    // Both throw what kept them from being made.
    [[nodiscard]] const OffscreenContext& context() const;
    [[nodiscard]] Rasterizer& rasterizer();

private:
    std::optional<OffscreenContext> context_;
    std::optional<Rasterizer> rasterizer_;
    std::exception_ptr failure_;
};

}  // namespace raypick
