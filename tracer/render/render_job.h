// A ray-traced frame in the making: start, watch, cancel, wait.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/geometry/camera.h"
#include "tracer/render/image.h"
#include "tracer/shade/settings.h"
#include "tracer/shade/trace.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace raypick {

struct RenderProgress {
    double fraction = 0.0;  // of the full-resolution pixels
    double seconds = 0.0;   // since the start; stops at the end
    RayCounts rays;
    std::uint64_t version = 0;  // grows whenever the image changed; 0: no whole image yet
    bool finished = false;      // ended for whatever reason
    bool cancelled = false;
};

// What a job has traced so far.
struct FrameSnapshot {
    Image image;
    std::vector<std::uint8_t> traced;  // a pixel: 1 if it shows its own sample
    std::uint64_t version = 0;

    // The pixel whose sample is shown at `pixel`: itself if it was traced, before that its coarse
    // block's centre.
    [[nodiscard]] Pixel sampled_pixel(Pixel pixel) const;
};

// Traces one frame on worker threads: a coarse image first (one pixel in kCoarseStep x kCoarseStep
// at each block's centre fills its block), then tiles at full resolution from the centre outwards.
// The finished image is bit for bit the same for any number of threads. It works on an immutable
// snapshot: nothing that happens to the scene elsewhere reaches it. The destructor cancels and
// joins.
class RenderJob {
public:
    static constexpr int kCoarseStep = 8;
    static constexpr int kTileSize = 32;

    // Starts at once. `camera.near` limits the eye rays. Who won't look at it before it is done
    // leaves the coarse image out. Throws Error on a bad camera or an empty size.
    RenderJob(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
              const RenderSettings& settings, bool coarse_first = true);
    ~RenderJob();
    RenderJob(const RenderJob&) = delete;
    RenderJob& operator=(const RenderJob&) = delete;

    // Asks to stop and returns at once; the workers stop within 20 ms.
    void cancel();
    // Returns when the workers have ended. Rethrows what a worker threw.
    void wait();

    [[nodiscard]] RenderProgress progress() const;
    // Brings `frame` up to date. Does nothing and returns false if it is, by its version, or as
    // long as the coarse image is not whole. Cheap enough for each GUI frame; never waits for the
    // tracer.
    bool snapshot(FrameSnapshot& frame) const;

    [[nodiscard]] const Camera& camera() const;
    [[nodiscard]] ImageSize size() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

// The whole frame in the calling thread's time.
struct RenderedFrame {
    Image image;
    RayCounts rays;
    double seconds = 0.0;
};
RenderedFrame render(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                     const RenderSettings& settings);

}  // namespace raypick
