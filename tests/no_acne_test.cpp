// No ray that leaves a surface meets it again where it can't, and none slips out of a closed body.
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/surface.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace raypick {
namespace {

constexpr std::array<double, 3> kScales{1e-4, 1.0, 1e4};

struct Body {
    std::string name;
    Shape shape;
};

std::vector<Body> convex_bodies(double s, const glm::dvec3& at) {
    return {
        {"sphere", Sphere{at, s}},
        {"box", Box{at - s, at + s}},
        {"cylinder", Cone{at - s * glm::dvec3(0.2, 1, 0.1), at + s * glm::dvec3(0.2, 1, 0.1),
                          0.5 * s, 0.5 * s}},
        {"cone", Cone{at - s * glm::dvec3(0, 0.5, 0.3), at + s * glm::dvec3(0, 0.5, 0.3), s, 0.0}},
        {"truncated cone", Cone{at - 0.1 * s, at + 0.1 * s, 0.4 * s, s}}};
}

// A ray that leaves the body from a random point of its surface, towards the outside; nothing where
// it leaves along the surface.
std::optional<Ray> leaving(const SurfacePoint& point, Random& random) {
    Ray away;
    away.direction = glm::vec3(random.direction());
    const float slope = glm::dot(away.direction, point.geometric_normal);
    if (std::abs(slope) < 1e-4f) return std::nullopt;
    if (slope < 0.0f) away.direction = -away.direction;
    away.origin = offset_origin(point, away.direction);
    return away;
}

void expect_no_acne(const std::string& name, const Scene& scene, double s, const glm::dvec3& at) {
    SCOPED_TRACE(testing::Message() << name << " scale " << s << " at " << at.x);
    const Accel accel = accel_of(scene);
    Random random(31);
    int tested = 0;
    int shadowed = 0;
    int escaped = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::vec3 from(at + 6.0 * s * random.direction());
        const Ray ray = ray_towards(from, at + 0.5 * s * random.direction());
        const auto hit = accel.intersect(ray);
        if (!hit) continue;
        const SurfacePoint point = surface_point(accel.scene(), ray, *hit);
        const auto away = leaving(point, random);
        if (!away) continue;
        shadowed += accel.occluded(*away) ? 1 : 0;
        Ray inwards = *away;
        inwards.direction = -away->direction;
        inwards.origin = offset_origin(point, inwards.direction);
        escaped += accel.occluded(inwards) ? 0 : 1;
        ++tested;
    }
    EXPECT_GT(tested, 800);
    EXPECT_EQ(shadowed, 0);
    EXPECT_EQ(escaped, 0);
}

TEST(NoAcne, ConvexBodiesNeitherShadowThemselvesNorLeak) {
    for (const double s : kScales) {
        for (const double away : {0.0, 10.0, 1e3}) {
            const glm::dvec3 at = away * s * glm::dvec3(0.7, 0.2, -0.6);
            for (const Body& body : convex_bodies(s, at)) {
                Scene scene;
                place(scene, body.shape);
                expect_no_acne(body.name, scene, s, at);
            }
        }
    }
}

TEST(NoAcne, InstancesUnderAnyAffineMatrix) {
    for (const double s : kScales) {
        const Transform world_from_object =
            translate(s * glm::dvec3(20, -7, 3)) * rotate(70.0, {1, 2, 3}) *
            scale(s * glm::dvec3(1.0, 0.4, -0.7)) * rotate(20.0, {0, 1, 1});
        for (const Body& body : convex_bodies(1.0, glm::dvec3(0.0))) {
            Scene scene;
            place(scene, body.shape, kNoMaterial, world_from_object);
            expect_no_acne(body.name, scene, 0.7 * s, s * glm::dvec3(20, -7, 3));
        }
    }
}

// The outer half of a torus is convex: what leaves it outwards is gone, unless it leaves towards
// the ring's other side. Straight along the normal is always gone.
TEST(NoAcne, TorusOutsideItsHole) {
    for (const double s : kScales) {
        for (const double minor : {1e-3, 0.1, 0.5, 1.0}) {
            SCOPED_TRACE(testing::Message() << "scale " << s << " minor " << minor);
            const Torus torus{s * glm::dvec3(3, 1, 2), {1, 3, 2}, s, minor * s};
            Scene scene;
            place(scene, torus);
            const Accel accel = accel_of(scene);
            const glm::dvec3 axis = glm::normalize(torus.axis);
            Random random(33);
            int tested = 0;
            for (int i = 0; i < 4000; ++i) {
                const glm::dvec3 in_plane = glm::normalize(glm::cross(axis, random.direction()));
                const glm::dvec3 aim = torus.centre + torus.major_radius * in_plane +
                                       0.9 * torus.minor_radius * random.direction();
                const Ray ray =
                    ray_towards(glm::vec3(torus.centre + 6.0 * s * random.direction()), aim);
                const auto hit = accel.intersect(ray);
                if (!hit) continue;
                const SurfacePoint point = surface_point(accel.scene(), ray, *hit);
                const glm::dvec3 from_centre = glm::dvec3(point.position) - torus.centre;
                const glm::dvec3 outwards = from_centre - glm::dot(from_centre, axis) * axis;
                const glm::dvec3 n(point.geometric_normal);
                if (glm::dot(outwards, n) < 0.01 * glm::length(outwards)) continue;
                Ray away;
                away.direction = point.geometric_normal;
                away.origin = offset_origin(point, away.direction);
                EXPECT_FALSE(accel.occluded(away));
                away.direction = -point.geometric_normal;
                away.origin = offset_origin(point, away.direction);
                EXPECT_TRUE(accel.occluded(away));
                ++tested;
            }
            EXPECT_GT(tested, 1000);
        }
    }
}

TEST(NoAcne, AMillionRaysFromInsideAWatertightMeshMeetIt) {
    const Accel accel = [] {
        Scene scene;
        place_mesh(scene, ball_data(5));
        return accel_of(std::move(scene));
    }();
    Random random(35);
    int escaped = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        Ray ray;
        ray.origin = glm::vec3(0.9 * random.unit() * random.direction());
        ray.direction = glm::vec3(random.direction());
        escaped += accel.occluded(ray) ? 0 : 1;
    }
    EXPECT_EQ(escaped, 0);
}

}  // namespace
}  // namespace raypick
