#include "viewer/app/scene_view.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

constexpr double kZoomStep = 0.88;  // of the distance that a wheel step leaves

// Depth along the view axis of what is under the point, as far as zooming should care: a floor's
// horizon does not count for more than the far end of the scene.
double depth_under(const Accel& accel, const Bounds& bounds, const Camera& camera, ImageSize size,
                   ImagePoint at, double background_depth) {
    const Ray ray = camera_ray(camera, size, at);
    const std::optional<Hit> hit = accel.intersect(ray);
    if (!hit) return background_depth;
    const glm::dvec3 forward = -camera_frame(camera).vz;
    const double depth = hit->t * glm::dot(glm::dvec3(ray.direction), forward);
    if (bounds.empty()) return depth;
    const double radius = 0.5 * glm::length(glm::dvec3(bounds.extent()));
    const double far_end = glm::distance(camera.eye, glm::dvec3(bounds.centre())) + radius;
    return std::min(depth, far_end);
}

}  // namespace

void SceneView::set_scene(std::shared_ptr<const Scene> scene, const Bounds& bounds,
                          const Camera& camera) {
    rasterizer_.set_scene(scene);
    scene_ = std::move(scene);
    bounds_ = bounds;
    accel_.reset();
    camera_ = OrbitCamera(camera);
    preview_.close();
    rasterised_.reset();
    shown_.reset();
}

void SceneView::set_accel(std::shared_ptr<const Accel> accel) {
    assert(!accel || accel->shared_scene() == scene_);
    accel_ = std::move(accel);
}

void SceneView::zoom(double steps, std::optional<ImagePoint> at) {
    if (!shown_) return;
    const ImageSize size = shown_->size;
    const ImagePoint point = at.value_or(ImagePoint{0.5 * size.rows, 0.5 * size.cols});
    if (steps > 0.0 && accel_) {
        camera_.set_pivot_depth(
            depth_under(*accel_, bounds_, camera_.camera(), size, point, camera_.pivot_distance()));
    }
    camera_.zoom(size, point, std::pow(kZoomStep, steps));
}

void SceneView::frame_all() {
    if (shown_) camera_.frame(bounds_, shown_->size);
}

void SceneView::frame_objects(std::span<const ObjectId> objects, const glm::dvec3& fallback_point) {
    if (!shown_) return;
    Bounds bounds;
    for (const ObjectId id : objects) {
        if (const Object* object = find_object(*scene_, id)) {
            bounds.extend(object_bounds(*scene_, *object));
        }
    }
    if (bounds.empty()) {
        camera_.look_at(fallback_point - scene_->origin);
    } else {
        camera_.frame(bounds, shown_->size);
    }
}

void SceneView::prepare(ImageSize size, const RenderSettings* trace) {
    if (!scene_ || size.rows <= 0 || size.cols <= 0) {
        shown_.reset();
        return;
    }
    camera_.fit_to_scene(bounds_);
    if (trace == nullptr) {
        preview_.close();
    } else if (accel_) {
        preview_.want({accel_, camera_.camera(), size, *trace});
        if (cancel_wanted_) preview_.cancel();
        preview_.update(presenter_);
    }
    cancel_wanted_ = false;
    if (shows_trace(size)) {
        shown_ = ShownFrame{scene_, preview_.shown()->camera, size, true};
    } else {
        rasterise(size);
        shown_ = rasterised_;
    }
}

bool SceneView::shows_trace(ImageSize size) const {
    const PreviewView* traced = preview_.shown();
    return traced != nullptr && traced->accel->shared_scene() == scene_ && traced->size == size;
}

void SceneView::rasterise(ImageSize size) {
    const ShownFrame wanted{scene_, camera_.camera(), size, false};
    if (rasterised_ == wanted) return;
    rasterizer_.draw(wanted.camera, size);
    rasterised_ = wanted;
}

void SceneView::present(const ViewRect& view, int framebuffer_rows,
                        std::span<const ObjectId> selected) {
    if (!shown_) return;
    if (shown_->traced) {
        presenter_.present(presenter_.colour_texture(), presenter_.object_texture(), view,
                           framebuffer_rows, selected, kNoObject);
    } else {
        presenter_.present(rasterizer_.colour_texture(), rasterizer_.object_texture(), view,
                           framebuffer_rows, selected, kNoObject);
    }
}

std::optional<PixelPick> SceneView::pick(Pixel pixel) const {
    const std::optional<PickQuestion> asked = question(pixel);
    return asked ? answer(*asked) : std::nullopt;
}

std::optional<PickQuestion> SceneView::question(Pixel pixel) const {
    if (!shown_ || !shown_->size.contains(pixel)) return std::nullopt;
    return PickQuestion{*shown_, sampled_pixel(pixel)};
}

std::optional<PixelPick> SceneView::answer(const PickQuestion& question) const {
    const ShownFrame& frame = question.frame;
    if (!accel_ || frame.scene != scene_) return std::nullopt;
    return PixelPick{question.pixel, pick_pixel(*accel_, frame.camera, frame.size, question.pixel)};
}

Pixel SceneView::sampled_pixel(Pixel pixel) const {
    return shown_ && shown_->traced ? preview_.shown_pixel(pixel) : pixel;
}

Image SceneView::picture() {
    if (!shown_) return {};
    if (!shown_->traced) return rasterizer_.read_image();
    preview_.update(presenter_, true);
    // Picks go by the picture on the GPU, which may be another camera's now.
    if (shows_trace(shown_->size)) shown_->camera = preview_.shown()->camera;
    return preview_.image();
}

}  // namespace raypick
