// The scene on the screen: rasterised, or traced in place. Knows what the last frame showed, so
// that a pick sees the same.
#pragma once

#include "picking/pick.h"
#include "viewer/app/orbit_camera.h"
#include "viewer/app/preview.h"
#include "viewer/raster/presenter.h"
#include "viewer/raster/rasterizer.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace raypick {

// What a frame showed.
struct ShownFrame {
    std::shared_ptr<const Scene> scene;
    Camera camera;
    ImageSize size;
    bool traced = false;

    friend bool operator==(const ShownFrame&, const ShownFrame&) = default;
};

// What a click asks: which ray, through what that frame showed.
struct PickQuestion {
    ShownFrame frame;
    Pixel pixel;  // whose sample was shown there
};

// Needs a current OpenGL 3.3 core context, the same one in every call.
class SceneView {
public:
    // `notify` is called from a working thread when the next prepare() will show something new.
    explicit SceneView(std::function<void()> notify = {}) : preview_(std::move(notify)) {}

    // Shows another scene from this camera. `bounds` are those of its finite objects.
    void set_scene(std::shared_ptr<const Scene> scene, const Bounds& bounds, const Camera& camera);
    // What rays go through from now on, of the scene that is shown. Without it, as a new scene is,
    // nothing is traced and no pick answered. A frame that is being traced goes on with the one it
    // began with.
    void set_accel(std::shared_ptr<const Accel> accel);
    // What of the scene OpenGL shows coarser than it is.
    [[nodiscard]] std::vector<std::string> warnings() const { return rasterizer_.warnings(); }

    [[nodiscard]] OrbitCamera& camera() { return camera_; }
    // Wheel steps towards what is shown at a point of the view (its centre: nothing).
    void zoom(double steps, std::optional<ImagePoint> at);
    // Fits everything, or these objects, into the view.
    void frame_all();
    void frame_objects(std::span<const ObjectId> objects, const glm::dvec3& fallback_point);

    // Makes the frame that present() shows: traced if `trace` says how and a picture is there.
    void prepare(ImageSize size, const RenderSettings* trace);
    void present(const ViewRect& view, int framebuffer_rows, std::span<const ObjectId> selected);

    // What the last prepared frame shows; nothing if the view is empty.
    [[nodiscard]] const std::optional<ShownFrame>& shown() const { return shown_; }
    // What is under a pixel of it: the pick of the pixel whose ray is shown there. Nothing outside
    // the view, and as long as there is no Accel.
    [[nodiscard]] std::optional<PixelPick> pick(Pixel pixel) const;
    // The same in two steps: the question belongs to the frame that is shown now, the answer may
    // come later.
    [[nodiscard]] std::optional<PickQuestion> question(Pixel pixel) const;
    [[nodiscard]] std::optional<PixelPick> answer(const PickQuestion& question) const;
    // The pixel whose sample is shown at `pixel`: another one while a traced preview is coarse.
    [[nodiscard]] Pixel sampled_pixel(Pixel pixel) const;
    // The shown picture itself.
    [[nodiscard]] Image picture();

    [[nodiscard]] PreviewStatus trace_status() const { return preview_.status(); }
    // Ends the tracing of whatever the next prepare() would trace.
    void cancel_trace() { cancel_wanted_ = true; }
    // A traced picture is on its way.
    [[nodiscard]] bool busy() const { return preview_.busy(); }
    // What is shown was traced, and the same of another view is on its way.
    [[nodiscard]] bool awaits_picture() const {
        return shown_ && shown_->traced && preview_.awaits_picture();
    }

private:
    void rasterise(ImageSize size);
    [[nodiscard]] bool shows_trace(ImageSize size) const;

    std::shared_ptr<const Scene> scene_;
    Bounds bounds_;
    std::shared_ptr<const Accel> accel_;  // of scene_; nullptr: not yet there
    OrbitCamera camera_;
    Rasterizer rasterizer_;
    Presenter presenter_;
    Preview preview_;
    bool cancel_wanted_ = false;
    std::optional<ShownFrame> rasterised_;  // what the rasteriser's buffers hold
    std::optional<ShownFrame> shown_;
};

}  // namespace raypick
