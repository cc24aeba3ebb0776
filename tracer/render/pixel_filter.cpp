#include "tracer/render/pixel_filter.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace raypick {

namespace {

constexpr double kGaussianSigma = 0.5;

// Enough that the density within a cell may be taken as constant.
constexpr int kCells = 2048;

double gaussian(double x) {
    const double z = x / kGaussianSigma;
    // What is left of the integral within the radius.
    const double kept =
        std::erf(filter_radius(PixelFilter::gaussian) / (kGaussianSigma * std::numbers::sqrt2));
    return std::exp(-0.5 * z * z) / (kGaussianSigma * std::sqrt(2.0 * std::numbers::pi) * kept);
}

// With B = C = 1/3, in Horner's form.
double mitchell(double x) {
    const double inner = ((7.0 * x - 12.0) * x * x + 16.0 / 3.0) / 6.0;
    const double outer = (((-7.0 / 3.0 * x + 12.0) * x - 20.0) * x + 32.0 / 3.0) / 6.0;
    return x < 1.0 ? inner : outer;
}

// The mean of n + 1 values whose first n have this one.
glm::vec3 mean_with(const glm::vec3& mean, const glm::vec3& value, std::uint16_t count) {
    return mean + (value - mean) / static_cast<float>(count);
}

}  // namespace

double filter_radius(PixelFilter filter) {
    switch (filter) {
        case PixelFilter::box:
            return 0.5;
        case PixelFilter::tent:
            return 1.0;
        case PixelFilter::gaussian:
            return 1.5;
        case PixelFilter::mitchell:
            return 2.0;
    }
    return 0.5;
}

double filter_value(PixelFilter filter, double x) {
    const double distance = std::abs(x);
    if (!(distance < filter_radius(filter))) return 0.0;
    switch (filter) {
        case PixelFilter::box:
            return 1.0;
        case PixelFilter::tent:
            return 1.0 - distance;
        case PixelFilter::gaussian:
            return gaussian(distance);
        case PixelFilter::mitchell:
            return mitchell(distance);
    }
    return 0.0;
}

FilterSampler::FilterSampler(PixelFilter filter) : filter_(filter), radius_(filter_radius(filter)) {
    const double width = 2.0 * radius_ / kCells;
    double positive = 0.0;
    double negative = 0.0;
    cumulated_.reserve(kCells);
    for (int cell = 0; cell < kCells; ++cell) {
        const double share = width * filter_value(filter, -radius_ + width * (cell + 0.5));
        (share < 0.0 ? negative : positive) += std::abs(share);
        cumulated_.push_back(positive + negative);
    }
    for (double& sum : cumulated_)
        sum /= positive + negative;
    // The product is negative where exactly one factor is. Divided by the integral, which the cells
    // give almost as 1.
    const double integral = positive - negative;
    negative_share_ = 2.0 * positive * negative / (integral * integral);
}

FilterOffset FilterSampler::sample(double u) const {
    const auto cell = std::upper_bound(cumulated_.begin(), cumulated_.end() - 1, u);
    const double before = cell == cumulated_.begin() ? 0.0 : *(cell - 1);
    const double within = *cell > before ? (u - before) / (*cell - before) : 0.5;
    const auto index = static_cast<double>(cell - cumulated_.begin());
    const double offset = radius_ * (2.0 * (index + within) / kCells - 1.0);
    return {offset, filter_value(filter_, offset) < 0.0};
}

void PixelMean::add(const glm::vec3& colour, bool negative) {
    if (negative) {
        negative_ = mean_with(negative_, colour, ++negatives_);
    } else {
        positive_ = mean_with(positive_, colour, ++positives_);
    }
}

glm::vec3 PixelMean::colour(const FilterSampler& filter) const {
    if (positives_ == 0) return negative_;
    if (negatives_ == 0) return positive_;
    const auto share = static_cast<float>(filter.negative_share());
    return glm::max(positive_ + share * (positive_ - negative_), glm::vec3(0.0f));
}

}  // namespace raypick
