#include "tracer/accel/surface.h"

#include "tests/tracer_scenes.h"
#include "tracer/shade/textured.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>

#include <array>
#include <cmath>

namespace raypick {
namespace {

constexpr std::array<double, 6> kScales{1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6};

void expect_near(const glm::vec3& got, const glm::dvec3& wanted, double tolerance) {
    EXPECT_NEAR(static_cast<double>(got.x), wanted.x, tolerance);
    EXPECT_NEAR(static_cast<double>(got.y), wanted.y, tolerance);
    EXPECT_NEAR(static_cast<double>(got.z), wanted.z, tolerance);
}

SurfacePoint first_surface(const Accel& accel, const Ray& ray) {
    const std::optional<Hit> hit = accel.intersect(ray);
    EXPECT_TRUE(hit.has_value());
    return hit ? surface_point(accel.scene(), ray, *hit) : SurfacePoint{};
}

TEST(SurfacePoint, SphereByHand) {
    Scene scene;
    const MaterialId red = add_material(scene, Material{});
    place(scene, Sphere{{1, 2, 3}, 2.0}, red);
    const SurfacePoint point = first_surface(accel_of(scene), ray_towards({1, 2, 10}, {1, 2, 3}));
    expect_near(point.position, {1, 2, 5}, 1e-6);
    expect_near(point.geometric_normal, {0, 0, 1}, 1e-6);
    expect_near(point.shading_normal, {0, 0, 1}, 1e-6);
    EXPECT_TRUE(point.front_face);
    EXPECT_EQ(point.material, red);
}

TEST(SurfacePoint, NormalsPointOutwardsFromInsideToo) {
    Scene scene;
    place(scene, Sphere{});
    const SurfacePoint point = first_surface(accel_of(scene), ray_towards({0, 0, 0}, {3, 0, 0}));
    expect_near(point.geometric_normal, {1, 0, 0}, 1e-6);
    EXPECT_FALSE(point.front_face);
}

TEST(SurfacePoint, NormalsUnderNonUniformAndMirroredScale) {
    // The ellipsoid (x/2)^2 + y^2 + z^2 = 1 has the normal (x/4, y, z).
    for (const double side : {2.0, -2.0}) {
        Scene scene;
        place(scene, Sphere{}, kNoMaterial, scale({side, 1.0, 1.0}));
        const Ray ray = ray_towards({1, 0.5f, 9}, {1, 0.5, 0});
        const SurfacePoint point = first_surface(accel_of(scene), ray);
        const double z = std::sqrt(1.0 - 0.25 - 0.25);
        expect_near(point.position, {1.0, 0.5, z}, 1e-6);
        const glm::dvec3 wanted = glm::normalize(glm::dvec3(0.25, 0.5, z));
        expect_near(point.geometric_normal, wanted, 1e-6);
        expect_near(point.shading_normal, wanted, 1e-6);
        EXPECT_TRUE(point.front_face);
    }
}

TEST(SurfacePoint, NormalsUnderStretchAndTurnArePerpendicular) {
    const Transform world_from_object = rotate(35.0, {1, 2, 3}) * scale({2.0, 0.5, -1.0});
    for (const bool mesh : {false, true}) {
        Scene scene;
        if (mesh) {
            place_mesh(scene, ball_data(3), kNoMaterial, world_from_object);
        } else {
            place(scene, Sphere{}, kNoMaterial, world_from_object);
        }
        const Accel accel = accel_of(scene);
        Random random(2);
        for (int i = 0; i < 200; ++i) {
            const Ray ray = ray_towards(glm::vec3(6.0 * random.direction()), {0, 0, 0});
            const SurfacePoint point = first_surface(accel, ray);
            const glm::dvec3 normal(point.geometric_normal);
            EXPECT_GT(glm::dot(normal, glm::dvec3(point.position)), 0.0) << "outwards";
            if (mesh) continue;
            // Two tangents of the unit ball, carried into the world.
            const glm::dvec3 p =
                inverse(world_from_object).value().point(glm::dvec3(point.position));
            const glm::dvec3 u = glm::normalize(glm::cross(p, glm::dvec3(0.3, 0.5, 0.7)));
            EXPECT_NEAR(glm::dot(normal, world_from_object.vector(u)), 0.0, 2e-6);
            EXPECT_NEAR(glm::dot(normal, world_from_object.vector(glm::cross(p, u))), 0.0, 2e-6);
        }
    }
}

TEST(SurfacePoint, ShadingNormalsAreInterpolated) {
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0.6f, 0.8f}};
    data.triangles = {{0, 1, 2}};
    Scene scene;
    place_mesh(scene, data);
    const Accel accel = accel_of(scene);
    Ray ray;
    ray.origin = {0.25f, 0.5f, 2.0f};
    const SurfacePoint point = first_surface(accel, ray);
    const glm::dvec3 wanted =
        glm::normalize(0.25 * glm::dvec3(0, 0, 1) + 0.25 * glm::dvec3(0.6, 0, 0.8) +
                       0.5 * glm::dvec3(0, 0.6, 0.8));
    expect_near(point.shading_normal, wanted, 1e-6);
    expect_near(point.geometric_normal, {0, 0, 1}, 1e-6);
    EXPECT_NEAR(point.uv.x, 0.25f, 1e-7f);
    EXPECT_NEAR(point.uv.y, 0.5f, 1e-7f);
    // From behind they stay outward.
    ray.origin.z = -2.0f;
    ray.direction.z = 1.0f;
    const SurfacePoint behind = first_surface(accel, ray);
    expect_near(behind.shading_normal, wanted, 1e-6);
    EXPECT_FALSE(behind.front_face);
}

TEST(SurfacePoint, ShadingNormalsGoThroughTheInverseTranspose) {
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.normals = {{0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}};
    data.triangles = {{0, 1, 2}};
    Scene scene;
    place_mesh(scene, data, kNoMaterial, scale({2.0, 1.0, 1.0}));
    Ray ray;
    ray.origin = {0.5f, 0.25f, 2.0f};
    const SurfacePoint point = first_surface(accel_of(scene), ray);
    expect_near(point.shading_normal, glm::normalize(glm::dvec3(0.3, 0, 0.8)), 1e-6);
}

TEST(SurfacePoint, MaterialOfObjectPartOrNone) {
    Scene scene;
    const MaterialId first = add_material(scene, Material{});
    const MaterialId second = add_material(scene, Material{});
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    data.triangles = {{0, 1, 2}, {1, 3, 2}};
    const MeshId mesh = add_mesh(scene, make_mesh("two", data, {{0, 1, first}, {1, 1, second}}));
    place(scene, MeshInstance{mesh});
    const auto material_at = [&](float x, float y) {
        Ray ray;
        ray.origin = {x, y, 3.0f};
        return first_surface(accel_of(scene), ray).material;
    };
    EXPECT_EQ(material_at(0.1f, 0.1f), first);
    EXPECT_EQ(material_at(0.9f, 0.9f), second);
    scene.objects[0].material = first;
    EXPECT_EQ(material_at(0.9f, 0.9f), first) << "the object's own overrides the parts'";
    place(scene, Box{{4, 0, 0}, {5, 1, 1}});
    EXPECT_EQ(material_at(4.5f, 0.5f), kNoMaterial);
}

// How far a point lies from the tangent plane of the true surface, along the normal.
double off_sphere(const SurfacePoint& point, const Sphere& sphere) {
    return std::abs(glm::distance(glm::dvec3(point.position), sphere.centre) - sphere.radius);
}

TEST(SurfacePoint, ErrorBoundHoldsAndIsTight) {
    for (const double s : kScales) {
        for (const double away : {0.0, 1e3}) {
            SCOPED_TRACE(s);
            SCOPED_TRACE(away);
            Random random(3);
            const Sphere sphere{away * s * glm::dvec3(0.3, -0.8, 0.5), s};
            Scene scene;
            place(scene, sphere);
            const Accel accel = accel_of(scene);
            for (int i = 0; i < 2000; ++i) {
                const glm::vec3 from(sphere.centre + 20.0 * s * random.direction());
                const Ray ray =
                    ray_towards(from, sphere.centre + 0.9 * s * random.unit() * random.direction());
                const std::optional<Hit> hit = accel.intersect(ray);
                if (!hit) continue;  // far away, float rays may pass by
                const SurfacePoint point = surface_point(accel.scene(), ray, *hit);
                const glm::dvec3 error(point.position_error);
                const glm::dvec3 n(glm::abs(point.geometric_normal));
                ASSERT_LE(off_sphere(point, sphere), glm::dot(error, n) * (1.0 + 1e-6));
                // A few units in the last place of the coordinates, no more.
                const glm::dvec3 reach = glm::abs(glm::dvec3(point.position)) + 1e-30;
                ASSERT_LE(error.x, 1e-6 * (reach.x + s));
                ASSERT_LE(error.y, 1e-6 * (reach.y + s));
                ASSERT_LE(error.z, 1e-6 * (reach.z + s));
            }
        }
    }
}

// The three convex bodies, each on the unit ball or cube times s, moved away.
Scene body(int kind, double s, const glm::dvec3& at) {
    Scene scene;
    if (kind == 0) {
        place(scene, Sphere{at, s});
    } else if (kind == 1) {
        place(scene, Box{at - s, at + s});
    } else if (kind == 2) {
        MeshData data = ball_data(3);
        for (glm::vec3& p : data.positions)
            p = glm::vec3(at + s * glm::dvec3(p));
        place_mesh(scene, data);
    } else {
        place_mesh(scene, ball_data(3), kNoMaterial, translate(at) * scale({s, 0.5 * s, -s}));
    }
    return scene;
}

struct Leaks {
    int outside = 0;  // rays that left and met the body again
    int inside = 0;   // rays from the inside that got out
    int tested = 0;
};

Leaks count_leaks(int kind, double s, const glm::dvec3& at) {
    const Accel accel = accel_of(body(kind, s, at));
    Random random(17);
    Leaks leaks;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 from(at + 5.0 * s * random.direction());
        const Ray ray = ray_towards(from, at + 0.7 * s * random.direction());
        const std::optional<Hit> hit = accel.intersect(ray);
        if (!hit) continue;
        const SurfacePoint point = surface_point(accel.scene(), ray, *hit);
        Ray away;
        away.direction = glm::vec3(random.direction());
        const float slope = glm::dot(away.direction, point.geometric_normal);
        if (std::abs(slope) < 1e-4f) continue;
        if (slope < 0.0f) away.direction = -away.direction;
        away.origin = offset_origin(point, away.direction);
        leaks.outside += accel.occluded(away) ? 1 : 0;
        Ray inwards = away;
        inwards.direction = -away.direction;
        inwards.origin = offset_origin(point, inwards.direction);
        leaks.inside += accel.occluded(inwards) ? 0 : 1;
        ++leaks.tested;
    }
    return leaks;
}

TEST(OffsetOrigin, LeavingRaysNeverMeetTheirBodyAgain) {
    for (int kind = 0; kind < 4; ++kind) {
        for (const double s : kScales) {
            for (const double away : {0.0, 10.0, 1e3}) {
                SCOPED_TRACE(kind);
                SCOPED_TRACE(s);
                SCOPED_TRACE(away);
                const Leaks leaks = count_leaks(kind, s, away * s * glm::dvec3(0.7, 0.2, -0.6));
                EXPECT_EQ(leaks.outside, 0);
                EXPECT_EQ(leaks.inside, 0);
                EXPECT_GT(leaks.tested, 3000);
            }
        }
    }
}

TEST(OffsetOrigin, MovesNoFartherThanTheErrorBoundAsksFor) {
    for (const double s : kScales) {
        for (const double away : {0.0, 1e3}) {
            SCOPED_TRACE(s);
            SCOPED_TRACE(away);
            const glm::dvec3 at = away * s * glm::dvec3(0.7, 0.2, -0.6);
            const Accel accel = accel_of(body(2, s, at));
            Random random(19);
            for (int i = 0; i < 500; ++i) {
                const glm::vec3 from(at + 5.0 * s * random.direction());
                const Ray ray = ray_towards(from, at + 0.7 * s * random.direction());
                const std::optional<Hit> hit = accel.intersect(ray);
                if (!hit) continue;
                const SurfacePoint point = surface_point(accel.scene(), ray, *hit);
                const glm::vec3 origin = offset_origin(point, point.geometric_normal);
                const double moved = glm::distance(glm::dvec3(origin), glm::dvec3(point.position));
                EXPECT_LE(moved, 1e-6 * (glm::length(at) + s));
                EXPECT_GT(glm::dot(glm::dvec3(origin) - glm::dvec3(point.position),
                                   glm::dvec3(point.geometric_normal)),
                          0.0);
            }
        }
    }
}

TEST(OffsetOrigin, TwoSheetsCloseTogetherStayApart) {
    // A floor and a thin layer 1e-5 above it: the ray that leaves the floor must meet the layer.
    Scene scene;
    place(scene, Plane{{0, 1, 0}, -1.0});
    place(scene, Plane{{0, 1, 0}, -1.00001});
    scene.objects[1].mask = 2u;
    const Accel accel = accel_of(scene);
    RayQuery only_floor;
    scene.objects[0].mask = 1u;
    only_floor.mask = 1u;
    const Accel masked = accel_of(scene);
    const Ray ray = ray_towards({0.3f, 7.0f, 0.2f}, {1.3, 1.0, -0.8});
    const std::optional<Hit> hit = masked.intersect(ray, only_floor);
    ASSERT_TRUE(hit.has_value());
    const SurfacePoint point = surface_point(masked.scene(), ray, *hit);
    Ray up;
    up.direction = {0, 1, 0};
    up.origin = offset_origin(point, up.direction);
    const std::optional<Hit> layer = accel.intersect(up);
    ASSERT_TRUE(layer.has_value());
    EXPECT_EQ(layer->object, 1u);
}

// Shining all over is what an exponent of 0 would do.
TEST(Textured, MapsLeaveNoExponentBelowOneAndAmbientToItsOwnMap) {
    Scene scene;
    const TextureId squares = add_texture(scene, {"squares", Checker{}});
    Material m;
    m.shininess = 50.0f;
    m.ambient = m.diffuse = glm::vec3(0.5f);
    m.map(MapSlot::shininess).texture = m.map(MapSlot::diffuse).texture = squares;
    SurfacePoint black;
    black.texture_uv = {1.5f, 0.5f};
    black.shading_normal = black.geometric_normal = {0, 0, 1};
    const auto at = [&] { return textured(scene, m, black, {0, 0, -1}, 0.0f); };
    EXPECT_EQ(at().shininess, 1.0f);
    EXPECT_EQ(at().ambient, glm::vec3(0.0f));
    m.shininess = 0.5f;
    EXPECT_EQ(at().shininess, 0.5f) << "which the scene itself asks for";
    m.map(MapSlot::ambient).texture = squares;
    m.map(MapSlot::ambient).base = 0.25f;
    EXPECT_EQ(at().ambient, glm::vec3(0.125f));
    EXPECT_EQ(at().diffuse, glm::vec3(0.0f));
}

}  // namespace
}  // namespace raypick
