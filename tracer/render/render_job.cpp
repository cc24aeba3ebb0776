#include "tracer/render/render_job.h"

#include "tracer/parallel/parallel.h"
#include "tracer/render/pixel_tracer.h"
#include "tracer/render/tiles.h"
#include "tracer/render/trace_tile.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace raypick {

namespace {

using Clock = std::chrono::steady_clock;

// How many passes over the image show the samples one by one.
int pass_count(const PixelTracer& tracer, bool progressive) {
    const int of_samples = progressive ? tracer.sample_count() : 1;
    switch (tracer.settings().sampling) {
        case Sampling::centre:
        case Sampling::corners:
            return 1;
        case Sampling::stratified:
            return of_samples;
        case Sampling::adaptive:
            return 1 + of_samples;
    }
    return 1;
}

}  // namespace

struct RenderJob::State {
    State(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
          const RenderSettings& settings, RenderPlan how)
        : tracer(std::move(accel), camera, size, settings),
          plan(std::move(how)),
          passes(pass_count(tracer, plan.progressive)),
          tiles(tiles_from_centre(size)),
          start(Clock::now()) {}

    const PixelTracer tracer;
    const RenderPlan plan;
    const int passes;
    const std::vector<Tile> tiles;
    const Clock::time_point start;
    std::stop_source stop;

    // The workers' own: each touches only its tile's pixels, and passes don't overlap.
    std::vector<PixelMean> means;        // of a progressive job, from its first sample on
    std::vector<std::uint8_t> refining;  // of adaptive sampling: pixels worth more samples

    mutable std::mutex mutex;  // guards what follows, up to `failure`
    CoarseImage coarse;
    bool whole = false;  // the image is there and no longer empty; before, it is the workers' own
    Image image;
    std::vector<std::uint8_t> done;    // per pixel: shows its own samples
    std::vector<std::uint8_t> broken;  // per pixel: came out as no number
    std::uint64_t broken_count = 0;
    std::size_t done_count = 0;  // pixels times passes
    RayCounts rays;
    std::uint64_t version = 0;
    bool finished = false;
    double seconds = 0.0;
    double coarse_seconds = 0.0;
    std::exception_ptr failure;

    std::jthread thread;  // last: joined before anything else goes

    void run();
    void run_passes();
    template <typename Body>
    void each_tile(const std::vector<Tile>& of, const Body& body);
    template <typename Body>
    void each_tile(const Body& body) {
        each_tile(tiles, body);
    }

    void trace_coarse();
    void show_coarse(const RayCounts& counts);
    void begin_image();
    void trace_centre_pass();
    void sample_passes();
    void choose_refined(const Tile& tile);
    void sample_tile(const Tile& tile, int first, int end);
    [[nodiscard]] std::vector<Pixel> sampled_pixels(const Tile& tile) const;
    [[nodiscard]] TilePart begun_part(const Tile& tile, bool first_pass) const;

    // The coarse image's rays are some of the first pass's.
    [[nodiscard]] bool coarse_counts() const {
        return tracer.settings().sampling == Sampling::centre ||
               tracer.settings().sampling == Sampling::adaptive;
    }

    enum class Piece { whole, colour };
    void publish(const TilePart& part, Piece piece);
    void count_broken(const TilePart& part);
    [[nodiscard]] bool stopped() const { return stop.stop_requested(); }
    [[nodiscard]] std::size_t work() const {
        return tracer.size().pixel_count() * static_cast<std::size_t>(passes);
    }
    [[nodiscard]] double elapsed() const {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
};

template <typename Body>
void RenderJob::State::each_tile(const std::vector<Tile>& of, const Body& body) {
    parallel_for(of.size(), tracer.settings().threads, stop.get_token(),
                 [&](std::size_t i) { body(of[i]); });
}

void RenderJob::State::run() {
    std::exception_ptr thrown;
    try {
        run_passes();
    } catch (...) {
        thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    failure = thrown;
    finished = true;
    seconds = elapsed();
    if (version > 0) ++version;
}

void RenderJob::State::run_passes() {
    if (plan.progressive) trace_coarse();
    if (stopped()) return;
    begin_image();
    if (stopped()) return;
    switch (tracer.settings().sampling) {
        case Sampling::centre:
            trace_centre_pass();
            break;
        case Sampling::corners:
            each_tile([this](const Tile& tile) {
                TilePart part(tile, plan.channels);
                trace_corners(tracer, part, stop.get_token());
                publish(part, Piece::whole);
            });
            break;
        case Sampling::stratified:
            sample_passes();
            break;
        case Sampling::adaptive:
            trace_centre_pass();
            if (stopped()) return;
            refining.resize(image.size.pixel_count());
            each_tile([this](const Tile& tile) { choose_refined(tile); });
            sample_passes();
            break;
    }
}

void RenderJob::State::trace_coarse() {
    // So many blocks make rays that are worth to be traced together.
    constexpr int kBlocks = 16;
    {
        CoarseImage empty(tracer.size(), plan.coarse_step, plan.channels);
        const std::lock_guard lock(mutex);
        coarse = std::move(empty);
    }
    RayCounts counts;
    each_tile(tiles_from_centre(coarse.image.size, kBlocks), [&](const Tile& tile) {
        TilePart part(tile, plan.channels);
        trace_blocks(tracer, coarse.step, part, stop.get_token());
        const std::lock_guard lock(mutex);
        copy_tile(part.image, tile, coarse.image);
        copy_tile(part.broken, tile, coarse.broken, coarse.image.size);
        counts += part.rays;
    });
    if (!stopped()) show_coarse(counts);
}

void RenderJob::State::show_coarse(const RayCounts& counts) {
    {
        const std::lock_guard lock(mutex);
        ++version;
        coarse_seconds = elapsed();
        if (coarse_counts()) rays += counts;
    }
    if (plan.on_coarse) plan.on_coarse();
}

// Not before the coarse image is shown: nobody waits for this one so soon.
void RenderJob::State::begin_image() {
    const ImageSize size = tracer.size();
    image = make_image(size, plan.channels, tracer.settings().threads);
    done.assign(size.pixel_count(), 0);
    broken.assign(size.pixel_count(), 0);
    if (plan.progressive) {
        each_tile([this](const Tile& tile) { fill_tile(coarse.image, coarse.step, tile, image); });
    }
    if (stopped()) return;
    const std::lock_guard lock(mutex);
    whole = true;
}

void RenderJob::State::trace_centre_pass() {
    const CoarseImage* known = plan.progressive ? &coarse : nullptr;
    each_tile([&](const Tile& tile) {
        TilePart part(tile, plan.channels);
        trace_centres(tracer, known, part, stop.get_token());
        publish(part, Piece::whole);
    });
}

void RenderJob::State::sample_passes() {
    const int samples = tracer.sample_count();
    const int step = plan.progressive ? 1 : samples;
    if (plan.progressive) means.resize(image.size.pixel_count());
    for (int first = 0; first < samples && !stopped(); first += step)
        each_tile([&](const Tile& tile) { sample_tile(tile, first, first + step); });
}

void RenderJob::State::choose_refined(const Tile& tile) {
    const RenderSettings& settings = tracer.settings();
    // The filter must not blend a pixel with an edge that the choice has not seen.
    const int reach =
        std::max(1, static_cast<int>(std::ceil(filter_radius(settings.filter) - 0.5)));
    // Through a lens even what is of one colour in the sharp image may not be.
    const bool all = settings.aperture > 0.0;
    copy_tile(all ? std::vector<std::uint8_t>(tile.size().pixel_count(), 1)
                  : contrasting_pixels(image, tile, reach, settings.contrast),
              tile, refining, image.size);
}

// What the pixels show before these samples.
TilePart RenderJob::State::begun_part(const Tile& tile, bool first_pass) const {
    TilePart part(tile, plan.channels);
    if (first_pass) {
        look_at_centres(tracer, part, stop.get_token());
        return part;
    }
    const ImageSize size = part.image.size;
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            const std::size_t at = size.index({row, col});
            const std::size_t in_image = image.size.index(tile.in_image({row, col}));
            part.image.colour[at] = image.colour[in_image];
            part.broken[at] = broken[in_image];
            part.any_broken = part.any_broken || broken[in_image] != 0;
        }
    }
    return part;
}

// The pixels of a tile that take more samples.
std::vector<Pixel> RenderJob::State::sampled_pixels(const Tile& tile) const {
    std::vector<Pixel> pixels = pixels_in_squares(tile.size());
    if (refining.empty()) return pixels;
    std::erase_if(pixels, [&](const Pixel& pixel) {
        return refining[image.size.index(tile.in_image(pixel))] == 0;
    });
    return pixels;
}

// Adds samples [first, end) to each pixel that takes them, one of each pixel after the other.
void RenderJob::State::sample_tile(const Tile& tile, int first, int end) {
    const bool first_pass = first == 0 && refining.empty();
    TilePart part = begun_part(tile, first_pass);
    const std::vector<Pixel> pixels = sampled_pixels(tile);
    std::vector<PixelMean> sums(pixels.size());
    const auto in_image = [&](std::size_t i) { return image.size.index(tile.in_image(pixels[i])); };
    for (std::size_t i = 0; i < pixels.size() && !means.empty(); ++i)
        sums[i] = means[in_image(i)];
    for (int sample = first; sample < end && !stopped(); ++sample)
        add_samples(tracer, tile, pixels, sample, sums, part.rays, stop.get_token());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!means.empty()) means[in_image(i)] = sums[i];
        part.set_colour(part.image.size.index(pixels[i]), sums[i].colour(tracer.filter()));
    }
    publish(part, first_pass ? Piece::whole : Piece::colour);
}

void RenderJob::State::publish(const TilePart& part, Piece piece) {
    if (stopped()) return;  // the last pixel may be half traced
    const std::lock_guard lock(mutex);
    const Tile& tile = part.tile;
    if (piece == Piece::colour) {
        copy_tile(part.image.colour, tile, image.colour, image.size);
    } else {
        copy_tile(part.image, tile, image);
    }
    count_broken(part);
    for (int row = tile.row_begin; row < tile.row_end; ++row) {
        const auto first = static_cast<std::ptrdiff_t>(image.size.index({row, tile.col_begin}));
        std::fill_n(done.begin() + first, part.image.size.cols, std::uint8_t{1});
    }
    done_count += part.image.size.pixel_count();
    rays += part.rays;
    ++version;
}

void RenderJob::State::count_broken(const TilePart& part) {
    if (!part.any_broken && broken_count == 0) return;
    const ImageSize size = part.image.size;
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            const std::uint8_t is = part.broken[size.index({row, col})];
            std::uint8_t& was = broken[image.size.index(part.tile.in_image({row, col}))];
            broken_count += is;
            broken_count -= was;
            was = is;
        }
    }
}

Pixel FrameSnapshot::sampled_pixel(Pixel pixel) const {
    if (!size.contains(pixel)) return pixel;
    if (!traced.empty() && traced[size.index(pixel)] != 0) return pixel;
    return block_sample(block_of(pixel, step), step, size);
}

Image FrameSnapshot::whole() const {
    if (image.size == size) return image;
    Image filled = make_image(size, image.depth.empty() ? Channels::colour : Channels::all);
    fill_tile(image, step, {0, size.rows, 0, size.cols}, filled);
    return filled;
}

RenderJob::RenderJob(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                     const RenderSettings& settings, RenderPlan plan)
    : state_(std::make_unique<State>(std::move(accel), camera, size, settings, std::move(plan))) {
    state_->thread = std::jthread([state = state_.get()] { state->run(); });
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
    const std::size_t pixels = state_->tracer.size().pixel_count();
    progress.fraction =
        static_cast<double>(state_->done_count) / static_cast<double>(state_->work());
    progress.passes = state_->passes;
    progress.pass = std::min(static_cast<int>(state_->done_count / pixels) + 1, state_->passes);
    progress.seconds = state_->finished ? state_->seconds : state_->elapsed();
    progress.coarse_seconds = state_->coarse_seconds;
    progress.rays = state_->rays;
    progress.nan_pixels = state_->broken_count;
    progress.version = state_->version;
    progress.finished = state_->finished;
    progress.cancelled =
        state_->finished && !state_->failure && state_->done_count < state_->work();
    return progress;
}

bool RenderJob::snapshot(FrameSnapshot& frame) const {
    const std::lock_guard lock(state_->mutex);
    if (frame.version == state_->version || state_->version == 0) return false;
    frame.version = state_->version;
    frame.size = state_->tracer.size();
    frame.step = state_->coarse.step;
    frame.image = state_->whole ? state_->image : state_->coarse.image;
    if (state_->whole) {
        frame.traced = state_->done;
    } else {
        frame.traced.clear();
    }
    return true;
}

Image RenderJob::take_image() {
    wait();
    return state_->whole ? std::move(state_->image)
                         : make_image(state_->tracer.size(), state_->plan.channels);
}

const Camera& RenderJob::camera() const {
    return state_->tracer.camera();
}
ImageSize RenderJob::size() const {
    return state_->tracer.size();
}

RenderedFrame render(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                     const RenderSettings& settings, Channels channels) {
    RenderJob job(std::move(accel), camera, size, settings,
                  {.progressive = false, .channels = channels});
    job.wait();
    RenderedFrame frame;
    const RenderProgress progress = job.progress();
    frame.rays = progress.rays;
    frame.nan_pixels = progress.nan_pixels;
    frame.seconds = progress.seconds;
    frame.image = job.take_image();
    return frame;
}

}  // namespace raypick
