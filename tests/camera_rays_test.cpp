// Many rays of a camera at once against one after the other, and the order of an image's pixels.
#include "tests/each_instruction_set.h"
#include "tracer/geometry/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {
namespace {

constexpr ImageSize kOdd{37, 53};

Camera slanted(Projection projection) {
    Camera camera;
    camera.eye = {3.0, 2.0, 7.0};
    camera.at = {-1.0, 0.5, 1.0};
    camera.up = {0.1, 1.0, -0.2};
    camera.fovy = 71.0;
    camera.near = 0.3;
    camera.projection = projection;
    return camera;
}

std::uint32_t bits(float x) {
    return std::bit_cast<std::uint32_t>(x);
}

void expect_same_bits(const Ray& got, const Ray& wanted) {
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(bits(got.origin[k]), bits(wanted.origin[k]));
        EXPECT_EQ(bits(got.direction[k]), bits(wanted.direction[k]));
    }
    EXPECT_EQ(bits(got.t_min), bits(wanted.t_min));
    EXPECT_EQ(bits(got.t_max), bits(wanted.t_max));
}

class CameraRays : public OnInstructionSet {};

TEST_P(CameraRays, AreThoseOfOnePointEach) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const RayGenerator generator(slanted(projection), kOdd);
        std::vector<double> aside;
        std::vector<double> above;
        for (int row = 0; row < kOdd.rows; ++row) {
            for (int col = 0; col < kOdd.cols; ++col) {
                const ImagePoint point = pixel_centre({row, col});
                aside.push_back(generator.aside(point.c));
                above.push_back(generator.above(point.r));
            }
        }
        Ray none;
        none.t_min = none.t_max = -1.0f;
        std::vector<Ray> rays(aside.size() + 1, none);
        generator.rays(aside, above, std::span(rays).first(aside.size()));
        for (std::size_t i = 0; i < aside.size(); ++i) {
            SCOPED_TRACE(i);
            expect_same_bits(rays[i], generator.ray(aside[i], above[i]));
        }
        expect_same_bits(rays.back(), none);
    }
}

// None, one, and around what a vector holds.
TEST_P(CameraRays, OfAnyNumber) {
    const RayGenerator generator(slanted(Projection::perspective), kOdd);
    for (std::size_t count = 0; count < 35; ++count) {
        SCOPED_TRACE(count);
        const std::vector<double> aside(count, 0.25);
        const std::vector<double> above(count, -0.5);
        std::vector<Ray> rays(count);
        generator.rays(aside, above, rays);
        for (const Ray& ray : rays)
            expect_same_bits(ray, generator.ray(0.25, -0.5));
    }
}

RAYPICK_ON_EACH_INSTRUCTION_SET(CameraRays);

// Of any 4^n in a row that begin at a multiple of it, where no edge cuts the order off.
TEST(PixelsInSquares, NeighboursInTheOrderAreNeighboursInTheImage) {
    const std::vector<Pixel> pixels = pixels_in_squares({32, 32});
    ASSERT_EQ(pixels.size(), 1024u);
    for (const int side : {4, 8, 16, 32}) {
        const auto count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
        for (std::size_t first = 0; first < pixels.size(); first += count) {
            const Pixel corner = pixels[first];
            EXPECT_EQ(corner.row % side, 0);
            EXPECT_EQ(corner.col % side, 0);
            for (std::size_t i = first; i < first + count; ++i) {
                EXPECT_EQ(pixels[i].row / side, corner.row / side);
                EXPECT_EQ(pixels[i].col / side, corner.col / side);
            }
        }
    }
}

TEST(PixelsInSquares, EachPixelIsThereOnceWhateverTheSize) {
    for (const ImageSize size : {ImageSize{1, 1}, {1, 7}, {9, 1}, {3, 5}, {33, 33}, {37, 101}}) {
        std::vector<int> times(size.pixel_count(), 0);
        for (const Pixel& pixel : pixels_in_squares(size)) {
            ASSERT_TRUE(size.contains(pixel));
            ++times[size.index(pixel)];
        }
        EXPECT_EQ(std::count(times.begin(), times.end(), 1),
                  static_cast<std::ptrdiff_t>(times.size()));
    }
    EXPECT_TRUE(pixels_in_squares({0, 5}).empty());
}

}  // namespace
}  // namespace raypick
