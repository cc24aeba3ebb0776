#include "viewer/app/preview.h"

#include <exception>
#include <utility>

namespace raypick {

namespace {

// Copying and uploading a frame takes time from the tracer.
constexpr std::chrono::milliseconds kUploadInterval{80};

}  // namespace

bool PreviewView::same_scene(const PreviewView& other) const {
    if (!accel || !other.accel) return accel == other.accel;
    return accel->shared_scene() == other.accel->shared_scene();
}

void Preview::want(const PreviewView& view) {
    if (cancelled_ == view) return;
    cancelled_.reset();
    wanted_ = view;
    const bool have_job = job_ || !error_.empty();
    if (have_job && job_view_ == view) return;
    if (may_replace(view)) start(view);
}

bool Preview::may_replace(const PreviewView& view) const {
    return !job_ || job_shown() || job_ended_ || !job_view_.same_scene(view);
}

void Preview::start(const PreviewView& view) {
    retire();
    error_.clear();
    // What rays cost elsewhere says nothing about these.
    if (!job_view_.same_scene(view) || job_view_.settings != view.settings) {
        pace_ = CoarsePace(kCoarseBudget);
    }
    job_view_ = view;
    RenderPlan plan;
    plan.coarse_step = pace_.step_for(view.size);
    plan.on_coarse = notify_;
    try {
        job_ = std::make_shared<RenderJob>(view.accel, view.camera, view.size, view.settings,
                                           std::move(plan));
    } catch (const std::exception& error) {
        error_ = error.what();
    }
}

void Preview::cancel() {
    if (!job_) return;
    job_->cancel();
    cancelled_ = wanted_;
}

const PreviewView* Preview::shown() const {
    if (!shown_ || (cancelled_ && *cancelled_ != *shown_)) return nullptr;
    return &*shown_;
}

void Preview::close() {
    retire();
    collect_ended();
    error_.clear();
    shown_.reset();
    shown_job_.reset();
    frame_ = {};
    job_view_ = {};
    wanted_ = {};
    cancelled_.reset();
}

void Preview::retire() {
    if (job_) {
        job_->cancel();
        retired_.push_back(std::move(job_));
    }
    frame_.version = 0;  // of no other job
    job_ended_ = false;
}

void Preview::collect_ended() {
    // Joining a job whose work has ended takes no time; another one would hold up the window.
    std::erase_if(retired_, [](const auto& job) { return job->progress().finished; });
}

void Preview::update(Presenter& presenter, bool at_once) {
    collect_ended();
    if (!job_) return;
    // Asked before the snapshot: an ended job's snapshot is its last one.
    const bool ended = job_->progress().finished;
    const bool due =
        at_once || !job_shown() || ended || Clock::now() - uploaded_ >= kUploadInterval;
    if (due && job_->snapshot(frame_)) show(presenter);
    if (ended && !job_ended_) {
        job_ended_ = true;
        try {
            job_->wait();
        } catch (const std::exception& error) {
            error_ = error.what();
        }
    }
    // The view has moved on while this picture was made: the next one begins at once.
    if (!cancelled_ && wanted_ != job_view_ && may_replace(wanted_)) start(wanted_);
}

void Preview::show(Presenter& presenter) {
    if (!job_shown()) pace_.learn(frame_.size, frame_.step, job_->progress().coarse_seconds);
    presenter.upload(frame_.image, frame_.traced.empty() ? frame_.step : 1);
    uploaded_ = Clock::now();
    shown_ = job_view_;
    shown_job_ = job_;
}

Pixel Preview::shown_pixel(Pixel pixel) const {
    return shown_ ? frame_.sampled_pixel(pixel) : pixel;
}

PreviewStatus Preview::status() const {
    PreviewStatus status;
    status.error = error_;
    if (job_) {
        status.progress = job_->progress();
        status.state = !status.progress.finished   ? PreviewStatus::State::tracing
                       : status.progress.cancelled ? PreviewStatus::State::cancelled
                                                   : PreviewStatus::State::finished;
    }
    if (!error_.empty()) status.state = PreviewStatus::State::failed;
    return status;
}

bool Preview::busy() const {
    return (job_ && !job_ended_) || !retired_.empty();
}

}  // namespace raypick
