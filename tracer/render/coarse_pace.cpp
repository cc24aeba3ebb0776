#include "tracer/render/coarse_pace.h"

#include "tracer/render/coarse_image.h"

#include <algorithm>

namespace raypick {

int CoarsePace::step_for(ImageSize size) const {
    if (measured_ == 0) return kUnknown;
    const int fits = finest_within(budget_, size);
    const int fits_easily = finest_within(0.75 * budget_, size);
    return std::clamp(last_step_, fits, fits_easily);
}

int CoarsePace::finest_within(double seconds, ImageSize size) const {
    int step = 1;
    // Written so that a cost that is no number makes it coarse.
    while (step < kCoarsest &&
           !(cost() * static_cast<double>(block_grid(size, step).pixel_count()) <= seconds)) {
        ++step;
    }
    return step;
}

double CoarsePace::cost() const {
    std::array<double, 5> sorted = costs_;
    const std::size_t count = std::min(measured_, sorted.size());
    std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count));
    return sorted[count / 2];
}

void CoarsePace::learn(ImageSize size, int step, double seconds) {
    const auto blocks = static_cast<double>(block_grid(size, step).pixel_count());
    costs_[measured_++ % costs_.size()] = seconds / std::max(blocks, 1.0);
    last_step_ = step;
}

}  // namespace raypick
