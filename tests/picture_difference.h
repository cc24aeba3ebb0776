// How far two pictures of the same size are apart, in linear colour.
#pragma once

#include "tracer/render/image.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

// The mean of each n x n pixels.
inline Image shrunk(const Image& large, int n) {
    Image small = make_image({large.size.rows / n, large.size.cols / n});
    for (int row = 0; row < small.size.rows * n; ++row) {
        for (int col = 0; col < small.size.cols * n; ++col) {
            small.colour[small.size.index({row / n, col / n})] +=
                large.colour[large.size.index({row, col})] / static_cast<float>(n * n);
        }
    }
    return small;
}

struct Difference {
    double mean = 0.0;
    double near = 0.0;  // share of the pixels
};

// Of what a screen would show of them, linear. Near is a pixel none of whose channels differs by
// more than `near`.
inline Difference difference(const Image& a, const Image& b, double near) {
    Difference result;
    const auto count = static_cast<double>(a.colour.size());
    for (std::size_t i = 0; i < a.colour.size(); ++i) {
        const auto shown = [i](const Image& image) {
            return glm::clamp(glm::dvec3(image.colour[i]), 0.0, 1.0);
        };
        const glm::dvec3 apart = glm::abs(shown(a) - shown(b));
        result.mean += (apart.x + apart.y + apart.z) / 3.0 / count;
        if (std::max({apart.x, apart.y, apart.z}) <= near) result.near += 1.0 / count;
    }
    return result;
}

// How much a picture has to tell: the standard deviation of its grey.
inline double contrast(const Image& image) {
    double sum = 0.0;
    double squares = 0.0;
    for (const glm::vec3& c : image.colour) {
        const auto value = static_cast<double>(c.x + c.y + c.z) / 3.0;
        sum += value;
        squares += value * value;
    }
    const auto count = static_cast<double>(image.colour.size());
    return std::sqrt(std::max(squares / count - sum * sum / (count * count), 0.0));
}

}  // namespace raypick
