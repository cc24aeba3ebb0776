#include "tracer/geometry/camera.h"

#include "tests/random.h"
#include "tracer/error.h"

#include <gtest/gtest.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_projection.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raypick {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr ImageSize kOdd{241, 323};

Camera slanted_camera() {
    Camera camera;
    camera.eye = {3.0, 2.0, 7.0};
    camera.at = {-1.0, 0.5, 1.0};
    camera.up = {0.1, 1.0, -0.2};
    camera.fovy = 37.0;
    camera.near = 0.25;
    return camera;
}

void expect_near(const glm::dvec3& got, const glm::dvec3& wanted, double tolerance) {
    EXPECT_NEAR(got.x, wanted.x, tolerance);
    EXPECT_NEAR(got.y, wanted.y, tolerance);
    EXPECT_NEAR(got.z, wanted.z, tolerance);
}

void expect_near(const glm::dmat4& got, const glm::dmat4& wanted, double tolerance) {
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r)
            EXPECT_NEAR(got[c][r], wanted[c][r], tolerance) << c << r;
    }
}

void expect_orthonormal(const CameraFrame& f) {
    EXPECT_NEAR(glm::length(f.vx), 1.0, 1e-12);
    EXPECT_NEAR(glm::length(f.vy), 1.0, 1e-12);
    EXPECT_NEAR(glm::length(f.vz), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(f.vx, f.vy), 0.0, 1e-12);
    EXPECT_NEAR(glm::dot(f.vy, f.vz), 0.0, 1e-12);
    expect_near(glm::cross(f.vx, f.vy), f.vz, 1e-12);
}

TEST(Camera, FrameByHand) {
    Camera camera;
    camera.eye = {0.0, 0.0, 5.0};
    camera.at = {0.0, 0.0, 0.0};
    camera.up = {0.3, 2.0, 9.0};  // need not be perpendicular nor of unit length
    camera.up.x = 0.0;
    const CameraFrame f = camera_frame(camera);
    expect_near(f.vx, {1.0, 0.0, 0.0}, 1e-15);
    expect_near(f.vy, {0.0, 1.0, 0.0}, 1e-15);
    expect_near(f.vz, {0.0, 0.0, 1.0}, 1e-15);
    camera.at = {5.0, 0.0, 5.0};  // looks along +x
    camera.up = {0.0, 0.0, 1.0};
    const CameraFrame side = camera_frame(camera);
    expect_near(side.vz, {-1.0, 0.0, 0.0}, 1e-15);
    expect_near(side.vx, {0.0, -1.0, 0.0}, 1e-15);
    expect_near(side.vy, {0.0, 0.0, 1.0}, 1e-15);
}

TEST(Camera, FrameIsOrthonormalWhereUpIsParallelToTheView) {
    for (const double s : {1.0, -1.0, 1e-3}) {
        for (const glm::dvec3& view :
             {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(1, 2, 3)}) {
            Camera camera;
            camera.eye = {1.0, 1.0, 1.0};
            camera.at = camera.eye + 4.0 * view;
            camera.up = s * view;
            const CameraFrame f = camera_frame(camera);
            expect_orthonormal(f);
            expect_near(f.vz, -glm::normalize(view), 1e-12);
            const Ray ray = camera_ray(camera, {3, 3}, Pixel{1, 1});
            expect_near(glm::dvec3(ray.direction), glm::normalize(view), 1e-6);
        }
    }
}

// The notes' formula by hand: fovy 90 gives h = 2; a 2 x 4 image has w = 4.
TEST(Camera, RayThroughACornerByHand) {
    Camera camera;
    camera.eye = {0.0, 0.0, 5.0};
    camera.fovy = 90.0;
    const ImageSize size{2, 4};
    // r = 0, c = 0: a_y = -2 (0/2 - 1/2) = 1, a_x = 4 (0/4 - 1/2) = -2.
    const Ray corner = camera_ray(camera, size, ImagePoint{0.0, 0.0});
    expect_near(glm::dvec3(corner.direction), glm::dvec3(-2, 1, -1) / std::sqrt(6.0), 1e-7);
    expect_near(glm::dvec3(corner.origin), {0.0, 0.0, 5.0}, 0.0);
    // r = 2, c = 3: a_y = -2 (2/2 - 1/2) = -1, a_x = 4 (3/4 - 1/2) = 1.
    const Ray low = camera_ray(camera, size, ImagePoint{2.0, 3.0});
    expect_near(glm::dvec3(low.direction), glm::dvec3(1, -1, -1) / std::sqrt(3.0), 1e-7);
    // The middle of the image is the view itself.
    const Ray middle = camera_ray(camera, size, ImagePoint{1.0, 2.0});
    expect_near(glm::dvec3(middle.direction), {0.0, 0.0, -1.0}, 1e-7);
}

TEST(Camera, RayThroughAPixelCentreByHand) {
    Camera camera;
    camera.eye = {0.0, 0.0, 5.0};
    camera.fovy = 90.0;
    const ImageSize size{2, 4};
    // Pixel (0, 0) is sampled at r = c = 0.5: a_y = 0.5, a_x = -1.5.
    const Ray first = camera_ray(camera, size, Pixel{0, 0});
    expect_near(glm::dvec3(first.direction), glm::dvec3(-1.5, 0.5, -1) / std::sqrt(3.5), 1e-7);
    // Pixel (1, 2): r = 1.5, c = 2.5: a_y = -0.5, a_x = 0.5.
    const Ray inner = camera_ray(camera, size, Pixel{1, 2});
    expect_near(glm::dvec3(inner.direction), glm::dvec3(0.5, -0.5, -1) / std::sqrt(1.5), 1e-7);
}

TEST(Camera, RowsCountFromTheTopAndColumnsFromTheLeft) {
    const Camera camera = slanted_camera();
    const CameraFrame f = camera_frame(camera);
    const glm::dvec3 top_left(camera_ray(camera, kOdd, Pixel{0, 0}).direction);
    EXPECT_GT(glm::dot(top_left, f.vy), 0.0);
    EXPECT_LT(glm::dot(top_left, f.vx), 0.0);
}

TEST(Camera, PixelRayIsTheRayThroughItsCentre) {
    const Camera camera = slanted_camera();
    const RayGenerator generator(camera, kOdd);
    for (int row = 0; row < kOdd.rows; row += 7) {
        for (int col = 0; col < kOdd.cols; col += 5) {
            const Pixel pixel{row, col};
            const Ray a = camera_ray(camera, kOdd, pixel);
            const Ray b = camera_ray(camera, kOdd, ImagePoint{row + 0.5, col + 0.5});
            const Ray c = generator.ray(pixel_centre(pixel));
            EXPECT_EQ(a.direction, b.direction);
            EXPECT_EQ(a.direction, c.direction);
            EXPECT_EQ(a.origin, c.origin);
            EXPECT_EQ(a.t_min, b.t_min);
            EXPECT_EQ(a.t_min, c.t_min);
            EXPECT_EQ(a.t_max, std::numeric_limits<float>::infinity());
        }
    }
}

TEST(Camera, DirectionsHaveUnitLengthAndStartAtTheNearPlane) {
    const Camera camera = slanted_camera();
    const CameraFrame f = camera_frame(camera);
    for (const ImagePoint point : {ImagePoint{0, 0}, ImagePoint{120.5, 161.5}, ImagePoint{241, 323},
                                   ImagePoint{17.25, 300.75}}) {
        const Ray ray = camera_ray(camera, kOdd, point);
        const glm::dvec3 d(ray.direction);
        EXPECT_NEAR(glm::length(d), 1.0, 2e-7);
        const double cosine = glm::dot(d, -f.vz);
        EXPECT_NEAR(static_cast<double>(ray.t_min), camera.near / cosine, 1e-6 * camera.near);
    }
}

TEST(Camera, PointsOnRaysProjectBack) {
    const Camera camera = slanted_camera();
    const auto check = [&](ImagePoint point) {
        const Ray ray = camera_ray(camera, kOdd, point);
        for (const double t : {0.5, 8.0, 1e4}) {
            const std::optional<ImagePoint> back =
                project(camera, kOdd, camera.eye + t * glm::dvec3(ray.direction));
            ASSERT_TRUE(back.has_value());
            EXPECT_NEAR(back->r, point.r, 1e-4);
            EXPECT_NEAR(back->c, point.c, 1e-4);
        }
    };
    for (const Pixel p : {Pixel{0, 0}, Pixel{0, 322}, Pixel{240, 0}, Pixel{240, 322},
                          Pixel{120, 161}, Pixel{33, 257}}) {
        check(pixel_centre(p));
        check({static_cast<double>(p.row), static_cast<double>(p.col)});
    }
    check({241.0, 323.0});
}

TEST(Camera, ProjectByHand) {
    Camera camera;
    camera.eye = {0.0, 0.0, 5.0};
    camera.fovy = 90.0;
    // One unit right and half a unit up at distance 5: a_x = 0.2, a_y = 0.1; h = 2, w = 4.
    const std::optional<ImagePoint> point = project(camera, {100, 200}, {1.0, 0.5, 0.0});
    ASSERT_TRUE(point.has_value());
    EXPECT_NEAR(point->c, 200 * (0.2 / 4 + 0.5), 1e-9);
    EXPECT_NEAR(point->r, 100 * (-0.1 / 2 + 0.5), 1e-9);
}

TEST(Camera, NothingBehindTheEyeProjects) {
    Camera camera;
    camera.eye = {0.0, 0.0, 5.0};
    EXPECT_FALSE(project(camera, kOdd, {0.0, 0.0, 6.0}).has_value());
    EXPECT_FALSE(project(camera, kOdd, {1.0, 2.0, 5.0}).has_value());
    EXPECT_FALSE(project(camera, kOdd, camera.eye).has_value());
    EXPECT_TRUE(project(camera, kOdd, {50.0, 0.0, 4.0}).has_value()) << "in front, off the image";
}

TEST(Camera, MatricesAreGlms) {
    const Camera camera = slanted_camera();
    expect_near(eye_from_world(camera), glm::lookAt(camera.eye, camera.at, camera.up), 1e-12);
    const double fovy = glm::radians(camera.fovy);
    expect_near(clip_from_eye(camera, kOdd),
                glm::infinitePerspective(fovy, kOdd.aspect(), camera.near), 1e-12);
    // A far plane far away comes to the same.
    expect_near(clip_from_eye(camera, kOdd),
                glm::perspective(fovy, kOdd.aspect(), camera.near, 1e12), 1e-9);
}

TEST(Camera, RaysAreGlmsUnProject) {
    const Camera camera = slanted_camera();
    const glm::dmat4 projection = clip_from_eye(camera, kOdd);
    const glm::dmat4 view = eye_from_world(camera);
    const glm::dvec4 viewport(0.0, 0.0, kOdd.cols, kOdd.rows);
    for (const ImagePoint point : {ImagePoint{0, 0}, ImagePoint{0.5, 0.5}, ImagePoint{120.5, 161.5},
                                   ImagePoint{240.5, 322.5}, ImagePoint{241, 323}}) {
        // GL windows count rows from the bottom; depth 0 is the near plane.
        const glm::dvec3 near_point = glm::unProject(glm::dvec3(point.c, kOdd.rows - point.r, 0.0),
                                                     view, projection, viewport);
        const Ray ray = camera_ray(camera, kOdd, point);
        expect_near(glm::dvec3(ray.direction), glm::normalize(near_point - camera.eye), 1.5e-7);
        EXPECT_NEAR(static_cast<double>(ray.t_min), glm::distance(near_point, camera.eye), 1e-7);
        const glm::dvec3 window =
            glm::project(glm::dvec3(ray.at(9.0f)), view, projection, viewport);
        EXPECT_NEAR(kOdd.rows - window.y, point.r, 3e-4);  // ray.at rounds to float
        EXPECT_NEAR(window.x, point.c, 3e-4);
    }
}

TEST(Camera, CheckRefusesWhatMakesNoView) {
    EXPECT_NO_THROW(check_camera(Camera{}));
    EXPECT_NO_THROW(check_camera(slanted_camera()));
    Camera camera;
    camera.at = camera.eye;
    EXPECT_THROW(check_camera(camera), Error);
    for (const double fovy : {0.0, 180.0, -30.0, 400.0, kNaN, kInfinity}) {
        camera = Camera{};
        camera.fovy = fovy;
        EXPECT_THROW(check_camera(camera), Error) << fovy;
    }
    for (const double near : {0.0, -1.0, kNaN, kInfinity}) {
        camera = Camera{};
        camera.near = near;
        EXPECT_THROW(check_camera(camera), Error) << near;
    }
    for (const double bad : {kNaN, kInfinity}) {
        for (int axis = 0; axis < 3; ++axis) {
            for (glm::dvec3 Camera::*member : {&Camera::eye, &Camera::at, &Camera::up}) {
                camera = Camera{};
                (camera.*member)[axis] = bad;
                EXPECT_THROW(check_camera(camera), Error) << axis << ' ' << bad;
            }
        }
    }
}

std::array<glm::dvec3, 8> corners_of(const Bounds& b) {
    std::array<glm::dvec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
        corners[i] =
            glm::dvec3((i & 1u) != 0 ? b.max.x : b.min.x, (i & 2u) != 0 ? b.max.y : b.min.y,
                       (i & 4u) != 0 ? b.max.z : b.min.z);
    }
    return corners;
}

// How far out the outermost corner lies: 0 in the image's centre, 1 on its border.
double fill(const Camera& camera, ImageSize size, const Bounds& bounds) {
    double outermost = 0.0;
    for (const glm::dvec3& corner : corners_of(bounds)) {
        const std::optional<ImagePoint> p = project(camera, size, corner);
        if (!p) return std::numeric_limits<double>::infinity();
        outermost = std::max({outermost, std::abs(2.0 * p->r / size.rows - 1.0),
                              std::abs(2.0 * p->c / size.cols - 1.0)});
    }
    return outermost;
}

TEST(Camera, FrameBoundsFillsTheImage) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const double size = std::pow(10.0, random.between(-3.0, 5.0));
        const glm::dvec3 centre = size * 10.0 * random.direction();
        const glm::dvec3 half = size * random.point(glm::dvec3(0.05), glm::dvec3(1.0));
        Bounds bounds;
        bounds.extend(glm::vec3(centre - half));
        bounds.extend(glm::vec3(centre + half));
        const ImageSize image{static_cast<int>(random.between(100, 900)),
                              static_cast<int>(random.between(100, 900))};
        const glm::dvec3 direction = random.direction();
        const double fovy = random.between(10.0, 100.0);
        const Camera camera =
            frame_bounds(bounds, 3.0 * direction, {0.0, 1.0, 0.0}, fovy, image.aspect());
        EXPECT_NO_THROW(check_camera(camera));
        EXPECT_EQ(camera.fovy, fovy);
        expect_near(glm::normalize(camera.at - camera.eye), direction, 1e-6);
        const double outermost = fill(camera, image, bounds);
        EXPECT_LE(outermost, 1.0) << "a corner is cut off";
        EXPECT_GE(outermost, 0.9) << "too much is left free";
    }
}

TEST(Camera, FrameBoundsOfNothingIsTheUnitCubesView) {
    const Camera nothing = frame_bounds(Bounds{}, {-1, -1, -1}, {0, 1, 0}, 45.0, 1.5);
    EXPECT_NO_THROW(check_camera(nothing));
    EXPECT_LT(glm::distance(nothing.at, glm::dvec3(0.0)), 2.0);
    EXPECT_LT(glm::distance(nothing.eye, nothing.at), 20.0);
}

TEST(Camera, FrameBoundsOfAPointIsAView) {
    Bounds point;
    point.extend(glm::vec3(3.0f, 4.0f, 5.0f));
    const Camera camera = frame_bounds(point, {0, 0, -1}, {0, 1, 0}, 45.0, 1.0);
    EXPECT_NO_THROW(check_camera(camera));
    const std::optional<ImagePoint> p = project(camera, {100, 100}, {3.0, 4.0, 5.0});
    ASSERT_TRUE(p.has_value());
    EXPECT_NEAR(p->r, 50.0, 1.0);
    EXPECT_NEAR(p->c, 50.0, 1.0);
}

TEST(Camera, NearPlaneLiesInFrontOfAllThatIsSeen) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const double size = std::pow(10.0, random.between(-4.0, 6.0));
        Bounds bounds;
        bounds.extend(glm::vec3(-size * random.point(glm::dvec3(0.1), glm::dvec3(1.0))));
        bounds.extend(glm::vec3(size * random.point(glm::dvec3(0.1), glm::dvec3(1.0))));
        Camera camera;
        camera.eye = size * random.between(2.0, 50.0) * random.direction();
        camera.at = 0.3 * size * random.direction();
        camera.near = near_for_bounds(camera, bounds);
        EXPECT_NO_THROW(check_camera(camera));
        const CameraFrame f = camera_frame(camera);
        double nearest = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& corner : corners_of(bounds)) {
            nearest = std::min(nearest, glm::dot(corner - camera.eye, -f.vz));
        }
        EXPECT_LE(camera.near, nearest);
        EXPECT_GE(camera.near, 1e-6 * glm::distance(camera.eye, glm::dvec3(0.0)))
            << "depth precision suffers";
    }
}

TEST(Camera, NearPlaneFromInsideTheBounds) {
    Bounds bounds;
    bounds.extend(glm::vec3(-10.0f));
    bounds.extend(glm::vec3(10.0f));
    Camera camera;
    camera.eye = {1.0, 2.0, 3.0};
    const double near = near_for_bounds(camera, bounds);
    EXPECT_GT(near, 1e-6 * 20.0);
    EXPECT_LT(near, 1e-2 * 20.0) << "what stands before the eye would be cut";
}

TEST(Camera, NearPlaneWithoutBounds) {
    const double near = near_for_bounds(Camera{}, Bounds{});
    EXPECT_TRUE(std::isfinite(near));
    EXPECT_GT(near, 0.0);
}

}  // namespace
}  // namespace raypick
