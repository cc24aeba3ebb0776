// A ray-traced frame in the making: start, watch, cancel, wait.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/geometry/camera.h"
#include "tracer/render/image.h"
#include "tracer/shade/ray_counts.h"
#include "tracer/shade/settings.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace raypick {

struct RenderProgress {
    double fraction = 0.0;  // of the work: pixels times passes
    int pass = 1;           // the one at work, from 1 to passes
    int passes = 1;
    double seconds = 0.0;         // since the start; stops at the end
    double coarse_seconds = 0.0;  // from the start to the coarse image; 0: it is not there
    RayCounts rays;
    // Whose colour, or normal if the image has them, is no number; 0 in the image.
    std::uint64_t nan_pixels = 0;
    std::uint64_t version = 0;  // grows whenever the image changed; 0: no whole image yet
    bool finished = false;      // ended for whatever reason
    bool cancelled = false;
};

// What a job has traced so far. At first, and as long as `traced` is empty, `image` holds one pixel
// for each block of `step` x `step` of the frame's; then it is of the frame's size, and blocks are
// filled where nothing finer is there.
struct FrameSnapshot {
    ImageSize size;  // the frame's
    int step = 1;
    Image image;
    std::vector<std::uint8_t> traced;  // a pixel: 1 if it shows its own samples
    std::uint64_t version = 0;

    // The pixel whose sample is shown at `pixel`: itself if it was traced, before that its coarse
    // block's centre.
    [[nodiscard]] Pixel sampled_pixel(Pixel pixel) const;
    // The image in the frame's size.
    [[nodiscard]] Image whole() const;
};

// How a job goes about its frame. What the finished image holds is bit for bit the same for all.
struct RenderPlan {
    bool progressive = true;            // there is somebody who watches
    int coarse_step = 8;                // side of a block of the coarse image, pixels
    std::function<void()> on_coarse{};  // called from a worker once the coarse image is there
    Channels channels = Channels::all;  // of the image and its snapshots
};

// Traces one frame on worker threads, in tiles from the centre outwards. The finished image is bit
// for bit the same for any number of threads and any plan. It works on an immutable snapshot:
// nothing that happens to the scene elsewhere reaches it. The destructor cancels and joins.
//
// A progressive job is there to be watched: first it makes a coarse image (the pixel in the middle
// of each block fills it). With one sample a pixel, at its centre, these are not traced again; with
// several, each pass over the image adds one of them, and the image is the mean so far.
//
// All channels but the colour are those of the ray through the pixel's centre, however the pixel is
// sampled: what a pick there hits.
class RenderJob {
public:
    // Starts at once. `camera.near` limits the eye rays. Throws Error on a bad camera, an empty
    // size or bad settings (check_settings).
    RenderJob(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
              const RenderSettings& settings, RenderPlan plan = {});
    ~RenderJob();
    RenderJob(const RenderJob&) = delete;
    RenderJob& operator=(const RenderJob&) = delete;

    // Asks to stop and returns at once; the workers stop within 20 ms.
    void cancel();
    // Returns when the workers have ended. Rethrows what a worker threw.
    void wait();

    // The same, and the image without a copy of it: neither snapshots nor progress mean anything
    // afterwards.
    [[nodiscard]] Image take_image();

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
    std::uint64_t nan_pixels = 0;
    double seconds = 0.0;
};
RenderedFrame render(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                     const RenderSettings& settings, Channels channels = Channels::all);

}  // namespace raypick
