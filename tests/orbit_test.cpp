// The camera as the mouse moves it.
#include "viewer/app/orbit_camera.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <random>

namespace raypick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr ImageSize kSize{301, 517};

Camera some_camera() {
    return {{3.0, 2.5, 7.0}, {0.5, 1.0, -1.0}, {0.0, 1.0, 0.0}, 40.0, 0.01};
}

Bounds box(const glm::vec3& min, const glm::vec3& max) {
    Bounds bounds;
    bounds.extend(min);
    bounds.extend(max);
    return bounds;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

// The axis must not lean to a side: its image is upright.
void expect_level(const Camera& camera, const glm::dvec3& axis) {
    EXPECT_NEAR(glm::dot(camera_frame(camera).vx, axis), 0.0, 1e-9);
}

TEST(OrbitCameraTest, IsExactlyTheGivenCameraUntilMoved) {
    EXPECT_EQ(OrbitCamera(some_camera()).camera(), some_camera());
}

TEST(OrbitCameraTest, ATurnByHandMovesTheEyeAgainstTheCursor) {
    // At (0, 0, 5) looking at the origin: dragging a quarter turn to the right pushes the front of
    // the scene to the right, so that its left side (-x) is seen.
    OrbitCamera camera(Camera{{0.0, 0.0, 5.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 45.0, 0.1});
    camera.orbit(kPi / 2.0, 0.0);
    expect_near(camera.camera().eye, {-5.0, 0.0, 0.0}, 1e-12);
    camera.orbit(0.0, kPi / 6.0);  // dragging down shows the top
    expect_near(camera.camera().eye, {-5.0 * std::cos(kPi / 6.0), 2.5, 0.0}, 1e-12);
    expect_near(camera.camera().at, {0.0, 0.0, 0.0}, 0.0);
}

TEST(OrbitCameraTest, KeepsDistancePivotAndHorizon) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> turn(-2.0, 2.0);
    for (const glm::dvec3 up : {glm::dvec3{0, 1, 0}, {0, 0, 1}, {0.3, 1.0, -0.2}}) {
        Camera start = some_camera();
        start.up = up;
        OrbitCamera camera(start);
        const double distance = camera.pivot_distance();
        for (int i = 0; i < 10000; ++i)
            camera.orbit(turn(random), turn(random));
        EXPECT_NEAR(camera.pivot_distance(), distance, 1e-9 * distance);
        EXPECT_EQ(camera.camera().at, start.at);
        expect_level(camera.camera(), glm::normalize(up));
    }
}

TEST(OrbitCameraTest, StopsAtThePolesWithoutFlippingOver) {
    OrbitCamera camera(some_camera());
    const glm::dvec3 right = camera_frame(camera.camera()).vx;
    for (int i = 0; i < 50; ++i) {
        camera.orbit(0.0, 0.1);
        expect_near(camera_frame(camera.camera()).vx, right, 1e-9);
    }
    const Camera& top = camera.camera();
    EXPECT_NEAR(top.eye.x, top.at.x, 1e-9);
    EXPECT_NEAR(top.eye.z, top.at.z, 1e-9);
    EXPECT_GT(top.eye.y, top.at.y);
    // From the pole, turning still turns the picture, about its centre.
    camera.orbit(kPi / 2.0, 0.0);
    EXPECT_NEAR(glm::dot(camera_frame(camera.camera()).vx, right), 0.0, 1e-9);
    camera.orbit(-kPi / 2.0, -0.3);
    expect_near(camera_frame(camera.camera()).vx, right, 1e-9);
    for (int i = 0; i < 50; ++i)
        camera.orbit(0.0, -0.1);
    EXPECT_LT(camera.camera().eye.y, camera.camera().at.y);
    expect_near(camera_frame(camera.camera()).vx, right, 1e-9);
}

TEST(OrbitCameraTest, StartsWellWhenItLooksAlongItsUp) {
    OrbitCamera camera(Camera{{0.0, 4.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 45.0, 0.1});
    const CameraFrame before = camera_frame(camera.camera());
    camera.orbit(0.0, 0.0);
    expect_near(camera_frame(camera.camera()).vx, before.vx, 1e-9);
    expect_near(camera_frame(camera.camera()).vy, before.vy, 1e-9);
    camera.orbit(0.2, -0.5);
    expect_level(camera.camera(), {0.0, 1.0, 0.0});
    EXPECT_NEAR(camera.pivot_distance(), 4.0, 1e-12);
}

TEST(OrbitCameraTest, PanKeepsThePivotsPlaneUnderTheCursor) {
    OrbitCamera camera(some_camera());
    const ImagePoint from{100.25, 30.0};
    const ImagePoint to{220.5, 410.75};
    // The point of the pivot's plane under `from`.
    const CameraFrame frame = camera_frame(camera.camera());
    const Ray ray = camera_ray(camera.camera(), kSize, from);
    const glm::dvec3 direction(ray.direction);
    const double along = camera.pivot_distance() / glm::dot(direction, -frame.vz);
    const glm::dvec3 point = camera.camera().eye + along * direction;
    camera.pan(kSize, from, to);
    const std::optional<ImagePoint> now = project(camera.camera(), kSize, point);
    ASSERT_TRUE(now.has_value());
    EXPECT_NEAR(now->r, to.r, 1e-3);
    EXPECT_NEAR(now->c, to.c, 1e-3);
    expect_near(camera_frame(camera.camera()).vz, frame.vz, 1e-12);
}

TEST(OrbitCameraTest, ZoomKeepsWhatIsUnderTheCursor) {
    for (const double factor : {0.5, 0.9, 1.3}) {
        OrbitCamera camera(some_camera());
        const ImagePoint cursor{40.0, 480.0};
        camera.set_pivot_depth(3.0);
        const Ray ray = camera_ray(camera.camera(), kSize, cursor);
        const CameraFrame frame = camera_frame(camera.camera());
        const glm::dvec3 direction(ray.direction);
        const glm::dvec3 point =
            camera.camera().eye + 3.0 / glm::dot(direction, -frame.vz) * direction;
        camera.zoom(kSize, cursor, factor);
        EXPECT_NEAR(camera.pivot_distance(), 3.0 * factor, 1e-9);
        const std::optional<ImagePoint> now = project(camera.camera(), kSize, point);
        ASSERT_TRUE(now.has_value());
        EXPECT_NEAR(now->r, cursor.r, 1e-3) << factor;
        EXPECT_NEAR(now->c, cursor.c, 1e-3) << factor;
    }
}

TEST(OrbitCameraTest, ZoomEndsBeforeTheNumbersDo) {
    OrbitCamera camera(some_camera());
    camera.fit_to_scene(box(glm::vec3(-1.0f), glm::vec3(1.0f)));
    for (int i = 0; i < 1000; ++i)
        camera.zoom(kSize, {150.0, 250.0}, 0.5);
    EXPECT_GT(camera.pivot_distance(), 0.0);
    EXPECT_NO_THROW(check_camera(camera.camera()));
    for (int i = 0; i < 1000; ++i)
        camera.zoom(kSize, {150.0, 250.0}, 2.0);
    EXPECT_LT(camera.pivot_distance(), 1e6);
    EXPECT_NO_THROW(check_camera(camera.camera()));
}

TEST(OrbitCameraTest, PivotDepthLeavesThePictureAlone) {
    OrbitCamera camera(some_camera());
    const CameraFrame before = camera_frame(camera.camera());
    const glm::dvec3 eye = camera.camera().eye;
    camera.set_pivot_depth(2.0);
    EXPECT_EQ(camera.camera().eye, eye);
    expect_near(camera_frame(camera.camera()).vz, before.vz, 1e-12);
    EXPECT_NEAR(camera.pivot_distance(), 2.0, 1e-12);
}

TEST(OrbitCameraTest, FramingShowsTheWholeBox) {
    OrbitCamera camera(some_camera());
    camera.orbit(0.7, 0.4);
    const CameraFrame before = camera_frame(camera.camera());
    const Bounds bounds = box({10.0f, -3.0f, 2.0f}, {14.0f, -1.0f, 9.0f});
    camera.frame(bounds, kSize);
    camera.fit_to_scene(bounds);
    expect_near(camera_frame(camera.camera()).vz, before.vz, 1e-6);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point{(corner & 1) != 0 ? bounds.max.x : bounds.min.x,
                               (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                               (corner & 4) != 0 ? bounds.max.z : bounds.min.z};
        const std::optional<ImagePoint> at = project(camera.camera(), kSize, point);
        ASSERT_TRUE(at.has_value()) << corner;
        EXPECT_TRUE(at->r >= 0.0 && at->r <= kSize.rows && at->c >= 0.0 && at->c <= kSize.cols)
            << corner << " at " << at->r << ", " << at->c;
    }
    camera.orbit(0.3, 0.1);
    expect_level(camera.camera(), {0.0, 1.0, 0.0});
}

TEST(OrbitCameraTest, FramingAPointOrNothingKeepsAValidCamera) {
    OrbitCamera camera(some_camera());
    camera.frame(Bounds{}, kSize);
    EXPECT_EQ(camera.camera(), some_camera());
    camera.frame(box({1.0f, 2.0f, 3.0f}, {1.0f, 2.0f, 3.0f}), kSize);
    EXPECT_NO_THROW(check_camera(camera.camera()));
    expect_near(camera.camera().at, {1.0, 2.0, 3.0}, 1e-5);
    camera.frame(box(glm::vec3(0.0f), glm::vec3(1.0f)), {0, 0});
    expect_near(camera.camera().at, {1.0, 2.0, 3.0}, 1e-5);
}

TEST(OrbitCameraTest, LookingAtAPointKeepsTheView) {
    OrbitCamera camera(some_camera());
    const glm::dvec3 offset = camera.camera().eye - camera.camera().at;
    camera.look_at({-4.0, 0.0, 9.0});
    EXPECT_EQ(camera.camera().at, (glm::dvec3{-4.0, 0.0, 9.0}));
    expect_near(camera.camera().eye - camera.camera().at, offset, 1e-12);
}

TEST(OrbitCameraTest, NearFollowsTheSceneAtEachFrame) {
    OrbitCamera camera(some_camera());
    const Bounds bounds = box(glm::vec3(-1.0f), glm::vec3(1.0f));
    camera.fit_to_scene(bounds);
    EXPECT_EQ(camera.camera().near, near_for_bounds(camera.camera(), bounds));
    camera.zoom(kSize, {150.0, 250.0}, 0.05);
    camera.fit_to_scene(bounds);
    EXPECT_EQ(camera.camera().near, near_for_bounds(camera.camera(), bounds));
}

}  // namespace
}  // namespace raypick
