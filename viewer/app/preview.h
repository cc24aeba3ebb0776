// The ray-traced preview: keeps a render job on the view that is wanted and its newest picture on
// the GPU. Never waits for the tracer.
#pragma once

#include "tracer/render/coarse_pace.h"
#include "tracer/render/render_job.h"
#include "viewer/raster/presenter.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace raypick {

// What a frame is traced of. Two equal ones give the same picture: whichever of a scene's trees the
// rays go down, they hit the same.
struct PreviewView {
    std::shared_ptr<const Accel> accel;
    Camera camera;
    ImageSize size;
    RenderSettings settings;

    [[nodiscard]] bool same_scene(const PreviewView& other) const;
    friend bool operator==(const PreviewView& a, const PreviewView& b) {
        return a.same_scene(b) && a.camera == b.camera && a.size == b.size &&
               a.settings == b.settings;
    }
};

struct PreviewStatus {
    enum class State { off, tracing, finished, cancelled, failed };

    State state = State::off;
    RenderProgress progress;
    std::string error;  // if failed
};

class Preview {
public:
    // What a coarse picture may take, seconds: with what it takes to show it, about 30 a second.
    static constexpr double kCoarseBudget = 0.025;

    // `notify` is called from a working thread when there is a first picture to take over.
    explicit Preview(std::function<void()> notify = {}) : notify_(std::move(notify)) {}

    // Asks for a picture of this view. A running job of another view is replaced as soon as its
    // first coarse picture is there, so that a moving camera is shown, too. That one is as coarse
    // as it must be to come in time.
    void want(const PreviewView& view);
    // Ends the running job; its picture so far stays, and nothing starts until another view is
    // wanted.
    void cancel();
    // Ends the job and forgets its picture.
    void close();
    // Takes over what the job has by now and uploads it if it is new. `at_once`: even if the last
    // upload was just before.
    void update(Presenter& presenter, bool at_once = false);

    // The view that the picture on the GPU shows; nullptr if there is none, or if it was cancelled
    // on the way to another view.
    [[nodiscard]] const PreviewView* shown() const;
    // That picture.
    [[nodiscard]] Image image() const { return frame_.whole(); }
    // The pixel whose sample is shown at `pixel`.
    [[nodiscard]] Pixel shown_pixel(Pixel pixel) const;

    [[nodiscard]] PreviewStatus status() const;
    // A view was asked for whose first picture is still to come.
    [[nodiscard]] bool awaits_picture() const { return job_ && !job_shown() && !job_ended_; }
    // There is something to come, or a thread to wait for.
    [[nodiscard]] bool busy() const;

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] bool may_replace(const PreviewView& view) const;
    void start(const PreviewView& view);
    void show(Presenter& presenter);
    void retire();
    void collect_ended();

    [[nodiscard]] bool job_shown() const { return job_ && job_ == shown_job_; }

    std::function<void()> notify_;
    CoarsePace pace_{kCoarseBudget};
    std::shared_ptr<RenderJob> job_;
    PreviewView job_view_;
    PreviewView wanted_;
    std::optional<PreviewView> cancelled_;  // the view that was wanted then
    bool job_ended_ = false;                // and wait() has been asked for its error
    std::string error_;
    std::vector<std::shared_ptr<RenderJob>> retired_;  // cancelled, their threads still ending

    // The picture on the GPU: of job_, or of the one before as long as job_ has none.
    FrameSnapshot frame_;
    std::optional<PreviewView> shown_;
    std::shared_ptr<RenderJob> shown_job_;
    Clock::time_point uploaded_;
};

}  // namespace raypick
