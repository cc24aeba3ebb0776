#include "viewer/app/document.h"

#include "tracer/error.h"
#include "tracer/io/load.h"

#include <chrono>
#include <new>
#include <utility>

namespace raypick {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

struct DocumentOpener::Work {
    std::filesystem::path file;
    LoadOptions options;
    Clock::time_point start = Clock::now();
    std::atomic<float> fraction = 0.0f;
    std::atomic<bool> ended = false;  // `result` is written before, read after
    std::optional<OpenResult> result;

    [[nodiscard]] Document open() const;
    void run();
};

Document DocumentOpener::Work::open() const {
    LoadedScene loaded = load_scene(file, options);
    Document document;
    document.file = file;
    document.warnings = std::move(loaded.warnings);
    check_scene(loaded.scene);
    document.bounds = scene_bounds(loaded.scene);
    document.scene = std::make_shared<const Scene>(std::move(loaded.scene));
    document.load_seconds = seconds_since(start);
    return document;
}

void DocumentOpener::Work::run() {
    try {
        result = open();
    } catch (const Cancelled&) {
        // Nobody waits for it any more.
    } catch (const std::bad_alloc&) {
        result = OpenFailure{file, file.string() + ": not enough memory"};
    } catch (const FileError& error) {
        result = OpenFailure{file, error.what()};
    } catch (const std::exception& error) {
        result = OpenFailure{file, file.string() + ": " + error.what()};
    }
    ended = true;
}

DocumentOpener::DocumentOpener(std::function<void()> notify) : notify_(std::move(notify)) {}

DocumentOpener::~DocumentOpener() {
    cancel();
}

void DocumentOpener::open(const std::filesystem::path& file, double crease_degrees,
                          ObjectId first_object_id) {
    cancel();
    work_ = std::make_shared<Work>();
    work_->file = file;
    work_->options.crease_degrees = crease_degrees;
    work_->options.first_object_id = first_object_id;
    work_->options.progress = &work_->fraction;
    thread_ = std::jthread([work = work_, notify = notify_](const std::stop_token& stop) {
        work->options.stop = stop;
        work->run();
        notify();
    });
}

void DocumentOpener::cancel() {
    join_ended();
    if (!work_) return;
    thread_.request_stop();
    given_up_.emplace_back(std::move(work_), std::move(thread_));
    work_.reset();
}

std::optional<OpenResult> DocumentOpener::take_result() {
    join_ended();
    if (!work_ || !work_->ended) return std::nullopt;
    thread_.join();
    std::optional<OpenResult> result = std::move(work_->result);
    work_.reset();
    return result;
}

std::optional<OpenProgress> DocumentOpener::progress() const {
    if (!work_) return std::nullopt;
    return OpenProgress{work_->file, work_->fraction, seconds_since(work_->start)};
}

void DocumentOpener::join_ended() {
    std::erase_if(given_up_, [](const auto& pair) { return pair.first->ended.load(); });
}

}  // namespace raypick
