// What the tests of the raster view's look share.
#pragma once

#include "tests/colour_agreement.h"
#include "tests/gl_fixture.h"
#include "tests/tracer_scenes.h"
#include "viewer/raster/rasterizer.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace raypick {

// One channel of one pixel may be off by this, in linear colour of about 0..1.
inline constexpr float kColourTolerance = 1e-3f;

class LookTest : public GlTest {
protected:
    struct Pictures {
        Image raster;
        Image traced;
    };

    Pictures both(Scene scene, const Camera& camera, ImageSize size = {120, 161}) {
        check_scene(scene);
        const auto shared = std::make_shared<const Scene>(std::move(scene));
        accel_ = std::make_unique<Accel>(shared);
        if (!rasterizer_) rasterizer_ = std::make_unique<Rasterizer>();
        rasterizer_->set_scene(shared);
        rasterizer_->draw(camera, size);
        return {rasterizer_->read_image(), trace_local(*accel_, camera, size)};
    }

    // The raster view looks as the traced one; `share` of the pixels may differ, where float noise
    // decides a step (the number of samples of a footprint, the edge of a sharp spot).
    ColourAgreement agree(Scene scene, const Camera& camera, double share = 1e-3,
                          ImageSize size = {120, 161}) {
        const Pictures pictures = both(std::move(scene), camera, size);
        const ColourAgreement result =
            compare_colours(pictures.traced, pictures.raster, kColourTolerance);
        EXPECT_GT(result.pixels, size.pixel_count() * 97 / 100) << result.summary();
        EXPECT_LE(result.share_beyond, share) << result.summary();
        EXPECT_LT(result.mean, 1e-4) << result.summary();
        // A picture of one colour would prove nothing.
        EXPECT_GT(result.contrast, 5e-3) << result.summary();
        return result;
    }

    void TearDown() override { rasterizer_.reset(); }

    std::unique_ptr<Rasterizer> rasterizer_;
    std::unique_ptr<Accel> accel_;
};

inline Camera camera_at(const glm::dvec3& eye, const glm::dvec3& at) {
    Camera camera;
    camera.eye = eye;
    camera.at = at;
    return camera;
}

}  // namespace raypick
