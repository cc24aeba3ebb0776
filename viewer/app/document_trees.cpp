#include "viewer/app/document_trees.h"

#include <utility>

namespace raypick {

DocumentTrees::DocumentTrees(std::function<void()> notify, BackgroundBuild::Build build)
    : notify_(std::move(notify)), build_how_(std::move(build)) {}

void DocumentTrees::set_scene(std::shared_ptr<const Scene> scene) {
    give_up();
    scene_ = std::move(scene);
    progress_ = {};
}

bool DocumentTrees::update(bool hold) {
    // Joining a thread that has ended takes no time; another one would hold up the window.
    std::erase_if(given_up_, [](const auto& build) { return build->progress().finished; });
    const bool changed = news();
    if (changed) take_over();
    if (hold && progress_.accel) give_up();
    if (!hold && !build_ && lacks_trees()) {
        progress_.finished = false;
        build_ = std::make_unique<BackgroundBuild>(scene_, notify_, progress_.accel, build_how_);
    }
    return changed;
}

bool DocumentTrees::news() const {
    if (!build_) return false;
    const BuildProgress now = build_->progress();
    return now.accel != progress_.accel || now.finished != progress_.finished;
}

void DocumentTrees::take_over() {
    // That of the first ones may be from a build before.
    const double first_seconds = progress_.first_seconds;
    progress_ = build_->progress();
    if (progress_.first_seconds == 0.0) progress_.first_seconds = first_seconds;
    if (progress_.finished) build_.reset();
}

void DocumentTrees::give_up() {
    if (!build_) return;
    build_->cancel();
    given_up_.push_back(std::move(build_));
}

bool DocumentTrees::lacks_trees() const {
    return scene_ && progress_.error.empty() &&
           (!progress_.accel || progress_.quality == TreeQuality::first);
}

}  // namespace raypick
