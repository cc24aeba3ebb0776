// The camera as the mouse moves it.
#include "viewer/app/orbit_camera.h"

#include "viewer/app/view_words.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

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

// Where points of the pivot's plane are seen, to compare before and after.
std::optional<ImagePoint> seen(const OrbitCamera& camera, const glm::dvec2& in_plane) {
    const CameraFrame frame = camera_frame(camera.camera());
    const glm::dvec3 point = camera.camera().at + in_plane.x * frame.vx + in_plane.y * frame.vy;
    return project(camera.camera(), kSize, point);
}

TEST(OrbitCameraTest, TogglingTheProjectionKeepsTheSizeAtThePivot) {
    OrbitCamera camera(some_camera());
    camera.fit_to_scene(box(glm::vec3(-20.0f), glm::vec3(20.0f)));
    const ImagePoint before = *seen(camera, {1.5, -0.7});
    const Camera perspective = camera.camera();
    camera.toggle_projection();
    EXPECT_EQ(camera.camera().projection, Projection::orthographic);
    EXPECT_NEAR(seen(camera, {1.5, -0.7})->r, before.r, 1e-9);
    EXPECT_NEAR(seen(camera, {1.5, -0.7})->c, before.c, 1e-9);
    camera.toggle_projection();
    EXPECT_EQ(camera.camera().projection, Projection::perspective);
    expect_near(camera.camera().eye, perspective.eye, 1e-9);
    expect_near(camera.camera().at, perspective.at, 0.0);
}

// Whatever one does, no corner of the scene is behind an orthographic eye.
TEST(OrbitCameraTest, NothingIsBehindAnOrthographicEye) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    const Bounds bounds = box({-3.0f, -9.0f, 2.0f}, {14.0f, 1.0f, 40.0f});
    OrbitCamera camera(some_camera());
    camera.fit_to_scene(bounds);
    camera.toggle_projection();
    for (int i = 0; i < 2000; ++i) {
        const ImagePoint at{150.0 + 140.0 * number(random), 250.0 + 240.0 * number(random)};
        switch (i % 5) {
            case 0:
                camera.orbit(number(random), number(random));
                break;
            case 1:
                camera.pan(kSize, at, {150.0, 250.0});
                break;
            case 2:
                camera.zoom(kSize, at, std::exp(number(random)));
                break;
            case 3:
                camera.look_from(static_cast<ViewSide>(i / 5 % 6));
                break;
            default:
                camera.look_at({number(random), number(random), number(random)});
        }
        camera.fit_to_scene(bounds);
        ASSERT_NO_THROW(check_camera(camera.camera()));
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 point{(corner & 1) != 0 ? bounds.max.x : bounds.min.x,
                                   (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                                   (corner & 4) != 0 ? bounds.max.z : bounds.min.z};
            ASSERT_TRUE(project(camera.camera(), kSize, point).has_value()) << i;
        }
    }
}

TEST(OrbitCameraTest, OrthographicPanAndZoomKeepWhatIsUnderTheCursor) {
    OrbitCamera camera(some_camera());
    camera.fit_to_scene(box(glm::vec3(-5.0f), glm::vec3(5.0f)));
    camera.toggle_projection();
    const ImagePoint cursor{40.0, 480.0};
    const Ray ray = camera_ray(camera.camera(), kSize, cursor);
    const glm::dvec3 point(ray.at(7.0f));
    const double height = camera.camera().height;
    camera.zoom(kSize, cursor, 0.5);
    EXPECT_NEAR(camera.camera().height, 0.5 * height, 1e-12);
    EXPECT_NEAR(project(camera.camera(), kSize, point)->r, cursor.r, 1e-3);
    EXPECT_NEAR(project(camera.camera(), kSize, point)->c, cursor.c, 1e-3);
    camera.pan(kSize, cursor, {200.0, 100.0});
    EXPECT_NEAR(project(camera.camera(), kSize, point)->r, 200.0, 1e-3);
    EXPECT_NEAR(project(camera.camera(), kSize, point)->c, 100.0, 1e-3);
}

TEST(OrbitCameraTest, FramingAnOrthographicViewShowsTheWholeBox) {
    OrbitCamera camera(some_camera());
    const Bounds bounds = box({10.0f, -3.0f, 2.0f}, {14.0f, -1.0f, 9.0f});
    camera.fit_to_scene(bounds);
    camera.toggle_projection();
    camera.frame(bounds, kSize);
    EXPECT_EQ(camera.camera().projection, Projection::orthographic);
    double highest = 1e9;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point{(corner & 1) != 0 ? bounds.max.x : bounds.min.x,
                               (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                               (corner & 4) != 0 ? bounds.max.z : bounds.min.z};
        const std::optional<ImagePoint> at = project(camera.camera(), kSize, point);
        ASSERT_TRUE(at.has_value()) << corner;
        EXPECT_TRUE(at->r >= 0.0 && at->r <= kSize.rows && at->c >= 0.0 && at->c <= kSize.cols);
        highest = std::min({highest, at->r, at->c, kSize.rows - at->r, kSize.cols - at->c});
    }
    EXPECT_LT(highest, 0.05 * kSize.cols) << "just fits";
}

TEST(OrbitCameraTest, KeysLookFromTheSides) {
    struct Case {
        glm::dvec3 axis;
        ViewSide side;
        glm::dvec3 to_eye, up;
    };
    const std::vector<Case> cases = {
        {{0, 1, 0}, ViewSide::front, {0, 0, 1}, {0, 1, 0}},
        {{0, 1, 0}, ViewSide::back, {0, 0, -1}, {0, 1, 0}},
        {{0, 1, 0}, ViewSide::right, {1, 0, 0}, {0, 1, 0}},
        {{0, 1, 0}, ViewSide::left, {-1, 0, 0}, {0, 1, 0}},
        {{0, 1, 0}, ViewSide::top, {0, 1, 0}, {0, 0, -1}},
        {{0, 1, 0}, ViewSide::bottom, {0, -1, 0}, {0, 0, 1}},
        {{0, 0, 1}, ViewSide::front, {0, -1, 0}, {0, 0, 1}},
        {{0, 0, 1}, ViewSide::right, {1, 0, 0}, {0, 0, 1}},
        {{0, 0, 1}, ViewSide::top, {0, 0, 1}, {0, 1, 0}},
    };
    for (const Case& wanted : cases) {
        SCOPED_TRACE(static_cast<int>(wanted.side));
        Camera start = some_camera();
        start.up = wanted.axis;
        OrbitCamera camera(start);
        const double distance = camera.pivot_distance();
        camera.look_from(wanted.side);
        const CameraFrame frame = camera_frame(camera.camera());
        expect_near(frame.vz, wanted.to_eye, 1e-12);
        expect_near(frame.vy, wanted.up, 1e-12);
        EXPECT_NEAR(camera.pivot_distance(), distance, 1e-12);
        EXPECT_EQ(camera.camera().at, start.at);
        camera.orbit(0.3, 0.2);
        expect_level(camera.camera(), wanted.axis);
    }
}

TEST(ViewWordsTest, SayTheViewExactly) {
    Camera camera = some_camera();
    camera.eye.x = 1.0 / 3.0;
    EXPECT_EQ(view_words(camera, {100.0, 0.0, 0.0}, {90, 160}),
              "--eye=100.33333333333333,2.5,7 --look-at=100.5,1,-1 --up=0,1,0 --fovy=40 "
              "--resolution=160,90");
    camera.projection = Projection::orthographic;
    camera.height = 2.5;
    EXPECT_EQ(view_words(camera, glm::dvec3(0.0), {90, 160}),
              "--eye=0.3333333333333333,2.5,7 --look-at=0.5,1,-1 --up=0,1,0 --orthographic=2.5 "
              "--resolution=160,90");
}

}  // namespace
}  // namespace raypick
