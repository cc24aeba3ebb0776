// Depth of field against the formulas of a thin lens.
#include "tests/tracer_scenes.h"
#include "tracer/render/render_job.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace raypick {
namespace {

constexpr ImageSize kSize{100, 120};

Camera some_camera(Projection projection = Projection::perspective) {
    Camera camera;
    camera.eye = {1.0, 2.0, 6.0};
    camera.at = {0.5, 0.0, 0.0};
    camera.near = 0.05;
    camera.projection = projection;
    camera.height = 4.0;
    return camera;
}

glm::dvec3 at_depth(const Ray& ray, const Camera& camera, double depth) {
    const glm::dvec3 view = -camera_frame(camera).vz;
    const glm::dvec3 from_eye = glm::dvec3(ray.origin) - camera.eye;
    const double t = (depth - glm::dot(from_eye, view)) / glm::dot(glm::dvec3(ray.direction), view);
    return glm::dvec3(ray.origin) + t * glm::dvec3(ray.direction);
}

TEST(LensTest, RaysOfAPixelMeetInTheFocusPlaneAndNowhereElse) {
    constexpr double kFocus = 4.5;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const Camera camera = some_camera(projection);
        const RayGenerator rays(camera, kSize);
        const CameraFrame frame = camera_frame(camera);
        for (const ImagePoint point : {ImagePoint{0, 0}, {33.25, 80.5}, {100, 120}}) {
            const Ray pinhole = rays.ray(point);
            const glm::dvec3 focus = at_depth(pinhole, camera, kFocus);
            for (const glm::dvec2 lens : {glm::dvec2(0.3, 0.0), {-0.1, 0.2}, {0.0, 0.0}}) {
                const Ray ray = rays.lens_ray(point, lens, kFocus);
                EXPECT_NEAR(glm::length(ray.direction), 1.0f, 1e-6f);
                const glm::dvec3 start =
                    glm::dvec3(pinhole.origin) + lens.x * frame.vx + lens.y * frame.vy;
                EXPECT_LT(glm::distance(glm::dvec3(ray.origin), start), 1e-6);
                EXPECT_LT(glm::distance(at_depth(ray, camera, kFocus), focus), 1e-5);
                // The near plane cuts where it does without a lens.
                const glm::dvec3 cut(ray.at(ray.t_min));
                EXPECT_NEAR(glm::dot(cut - camera.eye, -frame.vz), camera.near, 1e-6);
            }
            const Ray centre = rays.lens_ray(point, {0.0, 0.0}, kFocus);
            EXPECT_LT(glm::distance(centre.direction, pinhole.direction), 1e-6f);
        }
    }
}

// Of a disk of even brightness: its diameter along rows and columns in pixels, from the variance of
// the light's places, which is diameter^2 / 16.
glm::dvec2 diameter_of(const Image& image) {
    double light = 0.0;
    glm::dvec2 sum{0.0};
    glm::dvec2 squares{0.0};
    for (int row = 0; row < image.size.rows; ++row) {
        for (int col = 0; col < image.size.cols; ++col) {
            const auto here = static_cast<double>(image.colour[image.size.index({row, col})].x);
            const glm::dvec2 at(row, col);
            light += here;
            sum += here * at;
            squares += here * at * at;
        }
    }
    const glm::dvec2 mean = sum / light;
    // A pixel spreads what falls on it over its own width.
    const glm::dvec2 variance = squares / light - mean * mean - 1.0 / 12.0;
    return 4.0 * glm::sqrt(glm::max(variance, glm::dvec2(0.0)));
}

// A small glowing ball at some depth, seen through the lens.
Image ball_at(double depth, double aperture, double focus, double radius, Projection projection) {
    Scene scene;
    scene.background = glm::vec3(0.0f);
    place(scene, Sphere{{0, 0, 10.0 - depth}, radius},
          add_material(scene, glowing_material(glm::vec3(1.0f))));
    const auto accel = std::make_shared<const Accel>(accel_of(std::move(scene)));
    Camera camera;
    camera.eye = {0, 0, 10};
    camera.at = {0, 0, 10.0 - focus};  // focus_distance 0 takes it from here
    camera.near = 1e-3;
    camera.projection = projection;
    camera.height = 4.0;
    RenderSettings settings;
    settings.sampling = Sampling::stratified;
    settings.samples = 8;
    settings.aperture = aperture;
    return render(accel, camera, kSize, settings).image;
}

// Thin lens: a point at depth d is spread in the focus plane at depth f over a disk of diameter
// A |d - f| / d (in a parallel projection A |d - f| / f, for the rays' origins are spread, too).
TEST(LensTest, TheBlurIsAsWideAsTheFormulaSays) {
    struct Case {
        double depth, aperture, focus;
    };
    constexpr double kRadius = 0.25;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const bool parallel = projection == Projection::orthographic;
        for (const Case& c :
             {Case{4.0, 1.5, 6.0}, {9.0, 2.5, 6.0}, {3.0, 1.0, 5.0}, {6.0, 2.0, 6.0}}) {
            SCOPED_TRACE(testing::Message() << parallel << ' ' << c.depth << ' ' << c.focus);
            const double h = parallel ? 4.0 : 2.0 * std::tan(glm::radians(45.0) / 2.0) * c.focus;
            const double depth = parallel ? c.focus : c.depth;
            const double blur = c.aperture * std::abs(c.depth - c.focus) / depth;
            const double ball = 2.0 * kRadius * c.focus / depth;
            // The light of a disk whose every point is spread over a disk: variances add up.
            const double wanted = std::hypot(blur, ball) * kSize.rows / h;
            const glm::dvec2 got =
                diameter_of(ball_at(c.depth, c.aperture, c.focus, kRadius, projection));
            EXPECT_NEAR(got.x, wanted, 0.03 * wanted + 0.1);
            EXPECT_NEAR(got.y, wanted, 0.03 * wanted + 0.1);
        }
    }
}

// The lens takes no light away: what a blurred ball sends to the image is what a sharp one sends.
TEST(LensTest, BlurKeepsTheLight) {
    const auto sum = [](const Image& image) {
        double total = 0.0;
        for (const glm::vec3& colour : image.colour)
            total += static_cast<double>(colour.x);
        return total;
    };
    const double sharp = sum(ball_at(5.0, 0.0, 6.0, 0.2, Projection::perspective));
    const double blurred = sum(ball_at(5.0, 0.6, 6.0, 0.2, Projection::perspective));
    EXPECT_NEAR(blurred / sharp, 1.0, 0.01);
}

// Where the sharp picture is flat the blurred one may not be.
TEST(LensTest, AdaptiveSamplingTakesEveryPixelThroughALens) {
    Scene scene;
    place(scene, Sphere{{0, 0, 0}, 1.0}, add_material(scene, glowing_material(glm::vec3(1.0f))));
    const auto accel = std::make_shared<const Accel>(accel_of(std::move(scene)));
    RenderSettings settings;
    settings.samples = 2;
    settings.aperture = 1.0;
    settings.focus_distance = 1.5;
    settings.sampling = Sampling::stratified;
    const Image all = render(accel, Camera{}, {40, 40}, settings).image;
    settings.sampling = Sampling::adaptive;
    EXPECT_EQ(render(accel, Camera{}, {40, 40}, settings).image.colour, all.colour);
}

}  // namespace
}  // namespace raypick
