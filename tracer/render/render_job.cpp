#include "tracer/render/render_job.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

namespace raypick {

namespace {

using Clock = std::chrono::steady_clock;

// Pixels [row_begin, row_end) x [col_begin, col_end).
struct Tile {
    int row_begin = 0;
    int row_end = 0;
    int col_begin = 0;
    int col_end = 0;

    [[nodiscard]] ImageSize size() const { return {row_end - row_begin, col_end - col_begin}; }
    [[nodiscard]] double distance_squared(ImageSize image) const {
        const double r = 0.5 * (row_begin + row_end - image.rows);
        const double c = 0.5 * (col_begin + col_end - image.cols);
        return r * r + c * c;
    }
};

// All tiles of an image, those nearest to its centre first.
std::vector<Tile> tiles_from_centre(ImageSize size) {
    std::vector<Tile> tiles;
    constexpr int kStep = RenderJob::kTileSize;
    for (int row = 0; row < size.rows; row += kStep) {
        for (int col = 0; col < size.cols; col += kStep) {
            tiles.push_back(
                {row, std::min(row + kStep, size.rows), col, std::min(col + kStep, size.cols)});
        }
    }
    std::stable_sort(tiles.begin(), tiles.end(), [&](const Tile& a, const Tile& b) {
        return a.distance_squared(size) < b.distance_squared(size);
    });
    return tiles;
}

// The centre of the coarse block that holds a pixel; blocks are cut off at the image's edge.
Pixel coarse_sample(Pixel pixel, ImageSize size) {
    constexpr int kStep = RenderJob::kCoarseStep;
    const auto along = [](int i, int count) {
        return std::min(i / kStep * kStep + kStep / 2, count - 1);
    };
    return {along(pixel.row, size.rows), along(pixel.col, size.cols)};
}

void store(Image& image, std::size_t index, const TracedRay& traced) {
    image.colour[index] = traced.colour;
    if (!traced.hit.valid()) return;
    image.depth[index] = traced.hit.t;
    image.normal[index] = traced.normal;
    image.object[index] = traced.hit.object;
    image.primitive[index] = traced.hit.primitive;
}

template <typename T>
void copy_rows(const std::vector<T>& from, const Tile& tile, std::vector<T>& to, ImageSize size) {
    const ImageSize small = tile.size();
    for (int row = 0; row < small.rows; ++row) {
        const auto first = from.begin() + static_cast<std::ptrdiff_t>(small.index({row, 0}));
        std::copy(first, first + small.cols,
                  to.begin() + static_cast<std::ptrdiff_t>(
                                   size.index({tile.row_begin + row, tile.col_begin})));
    }
}

void copy_tile(const Image& from, const Tile& tile, Image& to) {
    copy_rows(from.colour, tile, to.colour, to.size);
    copy_rows(from.depth, tile, to.depth, to.size);
    copy_rows(from.normal, tile, to.normal, to.size);
    copy_rows(from.object, tile, to.object, to.size);
    copy_rows(from.primitive, tile, to.primitive, to.size);
}

// What a frame is traced from; immutable while it is.
class FrameTracer {
public:
    FrameTracer(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                const RenderSettings& settings)
        : accel_(std::move(accel)),
          camera_(camera),
          size_(size),
          settings_(settings),
          rays_(camera, size),
          lights_(effective_lights(accel_->scene(), camera)) {}

    [[nodiscard]] TracedRay pixel(Pixel p, RayCounts& counts, const std::stop_token& stop) const {
        return trace(*accel_, lights_, settings_, rays_.ray(pixel_centre(p)), counts, stop);
    }
    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] ImageSize size() const { return size_; }
    [[nodiscard]] int threads() const { return settings_.threads; }

private:
    std::shared_ptr<const Accel> accel_;
    Camera camera_;
    ImageSize size_;
    RenderSettings settings_;
    RayGenerator rays_;
    std::vector<Light> lights_;
};

// Checked before any of it is used.
FrameTracer checked_tracer(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                           const RenderSettings& settings) {
    check_camera(camera);
    if (size.rows <= 0 || size.cols <= 0) throw Error("an image needs at least one row and column");
    return {std::move(accel), camera, size, settings};
}

}  // namespace

struct RenderJob::State {
    State(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
          const RenderSettings& settings)
        : tracer(checked_tracer(std::move(accel), camera, size, settings)),
          tiles(tiles_from_centre(size)),
          start(Clock::now()),
          image(make_image(size)),
          done(size.pixel_count(), 0) {}

    FrameTracer tracer;
    std::vector<Tile> tiles;
    Clock::time_point start;
    std::stop_source stop;

    mutable std::mutex mutex;  // guards what follows, up to `failure`
    Image image;
    std::vector<std::uint8_t> done;  // per pixel: shows its own sample
    std::size_t done_count = 0;
    RayCounts rays;
    std::uint64_t version = 0;
    bool finished = false;
    double seconds = 0.0;
    std::exception_ptr failure;

    std::jthread thread;  // last: joined before anything else goes

    void run(bool coarse_first);
    void coarse_tile(const Tile& tile);
    void show_coarse();
    void fine_tile(const Tile& tile);
    void publish(const Tile& tile, const Image& part, const RayCounts& counts, bool final);
    [[nodiscard]] double elapsed() const {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
};

void RenderJob::State::run(bool coarse_first) {
    std::exception_ptr thrown;
    try {
        const auto each_tile = [&](void (State::*body)(const Tile&)) {
            parallel_for(tiles.size(), tracer.threads(), stop.get_token(),
                         [&](std::size_t i) { (this->*body)(tiles[i]); });
        };
        if (coarse_first) {
            each_tile(&State::coarse_tile);
            show_coarse();
        }
        each_tile(&State::fine_tile);
    } catch (...) {
        thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    failure = thrown;
    finished = true;
    seconds = elapsed();
    if (version > 0) ++version;
}

void RenderJob::State::show_coarse() {
    if (stop.stop_requested()) return;
    const std::lock_guard lock(mutex);
    ++version;
}

void RenderJob::State::coarse_tile(const Tile& tile) {
    const ImageSize size = tracer.size();
    Image part = make_image(tile.size());
    RayCounts not_counted;  // these pixels are traced again
    const std::stop_token token = stop.get_token();
    for (int row = 0; row < part.size.rows; row += kCoarseStep) {
        for (int col = 0; col < part.size.cols; col += kCoarseStep) {
            if (token.stop_requested()) return;
            const Pixel sample = coarse_sample({tile.row_begin + row, tile.col_begin + col}, size);
            const TracedRay traced = tracer.pixel(sample, not_counted, token);
            for (int r = row; r < std::min(row + kCoarseStep, part.size.rows); ++r) {
                for (int c = col; c < std::min(col + kCoarseStep, part.size.cols); ++c) {
                    store(part, part.size.index({r, c}), traced);
                }
            }
        }
    }
    publish(tile, part, {}, false);
}

void RenderJob::State::fine_tile(const Tile& tile) {
    Image part = make_image(tile.size());
    RayCounts counts;
    const std::stop_token token = stop.get_token();
    for (int row = 0; row < part.size.rows; ++row) {
        for (int col = 0; col < part.size.cols; ++col) {
            if (token.stop_requested()) return;
            const Pixel pixel{tile.row_begin + row, tile.col_begin + col};
            store(part, part.size.index({row, col}), tracer.pixel(pixel, counts, token));
        }
    }
    publish(tile, part, counts, true);
}

void RenderJob::State::publish(const Tile& tile, const Image& part, const RayCounts& counts,
                               bool final) {
    if (stop.stop_requested()) return;  // the last pixel may be half traced
    const std::lock_guard lock(mutex);
    copy_tile(part, tile, image);
    if (final) {
        copy_rows(std::vector<std::uint8_t>(part.size.pixel_count(), 1), tile, done, image.size);
        done_count += part.size.pixel_count();
    }
    rays += counts;
    // Pieces of a coarse image are not shown: what is between them would be black.
    if (final) ++version;
}

Pixel FrameSnapshot::sampled_pixel(Pixel pixel) const {
    if (!image.size.contains(pixel) || traced[image.size.index(pixel)] != 0) return pixel;
    return coarse_sample(pixel, image.size);
}

RenderJob::RenderJob(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                     const RenderSettings& settings, bool coarse_first)
    : state_(std::make_unique<State>(std::move(accel), camera, size, settings)) {
    state_->thread =
        std::jthread([state = state_.get(), coarse_first] { state->run(coarse_first); });
}

RenderJob::~RenderJob() {
    cancel();
}

void RenderJob::cancel() {
    state_->stop.request_stop();
}

void RenderJob::wait() {
    if (state_->thread.joinable()) state_->thread.join();
    const std::lock_guard lock(state_->mutex);
    if (state_->failure) std::rethrow_exception(state_->failure);
}

RenderProgress RenderJob::progress() const {
    const std::lock_guard lock(state_->mutex);
    RenderProgress progress;
    progress.fraction = static_cast<double>(state_->done_count) /
                        static_cast<double>(state_->image.size.pixel_count());
    progress.seconds = state_->finished ? state_->seconds : state_->elapsed();
    progress.rays = state_->rays;
    progress.version = state_->version;
    progress.finished = state_->finished;
    progress.cancelled =
        state_->finished && !state_->failure && state_->done_count < state_->done.size();
    return progress;
}

bool RenderJob::snapshot(FrameSnapshot& frame) const {
    const std::lock_guard lock(state_->mutex);
    if (frame.version == state_->version || state_->version == 0) return false;
    frame.version = state_->version;
    frame.image = state_->image;
    frame.traced = state_->done;
    return true;
}

const Camera& RenderJob::camera() const {
    return state_->tracer.camera();
}
ImageSize RenderJob::size() const {
    return state_->tracer.size();
}

RenderedFrame render(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                     const RenderSettings& settings) {
    RenderJob job(std::move(accel), camera, size, settings, false);
    job.wait();
    RenderedFrame frame;
    const RenderProgress progress = job.progress();
    frame.rays = progress.rays;
    frame.seconds = progress.seconds;
    FrameSnapshot snapshot;
    job.snapshot(snapshot);
    frame.image = std::move(snapshot.image);
    return frame;
}

}  // namespace raypick
