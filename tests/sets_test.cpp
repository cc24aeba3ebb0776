// The tree, surface points and cut-outs over all shapes and sets.
#include "tests/brute_force.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/surface.h"
#include "tracer/error.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

namespace raypick {
namespace {

constexpr std::array<double, 3> kScales{1e-4, 1.0, 1e4};

SphereSet random_spheres(std::uint64_t seed, std::size_t count, double size, double scale) {
    Random random(seed);
    std::vector<glm::vec4> spheres;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 centre(scale * random.point(glm::dvec3(-1.0), glm::dvec3(1.0)));
        spheres.emplace_back(centre, static_cast<float>(scale * size * random.between(0.1, 1.0)));
    }
    return make_sphere_set("balls", std::move(spheres));
}

ConeSet random_cones(std::uint64_t seed, std::size_t count, double size, double scale,
                     bool capped) {
    Random random(seed);
    std::vector<glm::vec4> ends;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 base = scale * random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        const glm::dvec3 apex = base + scale * random.between(0.05, 0.5) * random.direction();
        ends.emplace_back(glm::vec3(base), static_cast<float>(scale * size * random.unit()));
        ends.emplace_back(glm::vec3(apex),
                          static_cast<float>(scale * size * random.between(0.1, 1.0)));
    }
    return make_cone_set("twigs", std::move(ends), capped);
}

Transform random_affine(Random& random, double scale) {
    return translate(scale * 2.0 * random.direction()) *
           rotate(360.0 * random.unit(), random.direction()) *
           raypick::scale(
               {random.between(0.3, 2.0), random.between(0.3, 2.0), -random.between(0.3, 2.0)}) *
           rotate(360.0 * random.unit(), random.direction());
}

// One of each, as it is and as an instance.
Scene every_shape(std::uint64_t seed, double s) {
    Random random(seed);
    Scene scene;
    const SetId balls = add_sphere_set(scene, random_spheres(seed, 60, 0.2, s));
    const SetId open = add_cone_set(scene, random_cones(seed, 40, 0.1, s, false));
    const SetId capped = add_cone_set(scene, random_cones(seed + 1, 40, 0.1, s, true));
    const std::vector<Shape> shapes{
        Sphere{s * random.direction(), 0.5 * s},
        Disk{s * random.direction(), random.direction(), 0.8 * s, 0.2 * s},
        Rectangle{s * random.direction(), s * random.direction(), s * random.direction()},
        Cone{s * random.direction(), s * random.direction(), 0.4 * s, 0.1 * s},
        Cone{s * random.direction(), s * random.direction(), 0.2 * s, 0.3 * s, false},
        Torus{s * random.direction(), random.direction(), 0.6 * s, 0.2 * s},
        Box{{-s, 0.5 * s, -s}, {-0.5 * s, s, s}},
        SphereSetInstance{balls},
        ConeSetInstance{open},
        ConeSetInstance{capped},
    };
    for (const Shape& shape : shapes) {
        place(scene, shape);
        place(scene, shape, kNoMaterial, random_affine(random, s));
    }
    return scene;
}

TEST(EveryShape, EqualsBruteForce) {
    for (const double s : kScales) {
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
            const Scene scene = every_shape(seed, s);
            const BruteForce brute_force(scene);
            const Accel accel = accel_of(scene);
            int hits = 0;
            for (const Ray& ray : rays_through(accel.bounds(), seed, 1500)) {
                const auto candidates = brute_force.all(ray);
                const auto got = accel.intersect(ray);
                ASSERT_EQ(complaint(got, candidates), "")
                    << "scale " << s << " seed " << seed << ' ' << to_text(ray);
                ASSERT_EQ(accel.occluded(ray), !candidates.empty());
                ASSERT_EQ(accel.intersect_all(ray).size(), candidates.size());
                hits += got ? 1 : 0;
            }
            EXPECT_GT(hits, 300);
        }
    }
}

// Hits whose uv nobody wants are the same in all else, one by one and in groups.
TEST(EveryShape, HitsWithoutUvAreTheSame) {
    const Accel accel = accel_of(every_shape(5, 1.0));
    const std::vector<Ray> rays = rays_through(accel.bounds(), 5, 1500);
    RayQuery without;
    without.uv = false;
    std::vector<Hit> wanted(rays.size());
    std::vector<Hit> got(rays.size());
    accel.intersect(rays, wanted);
    accel.intersect(rays, got, without);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit one = accel.intersect(rays[i], without).value_or(Hit{});
        one.uv = got[i].uv = wanted[i].uv;
        ASSERT_EQ(got[i], wanted[i]) << to_text(rays[i]);
        ASSERT_EQ(one, wanted[i]) << to_text(rays[i]);
    }
}

TEST(EveryShape, SidesOfObjectsEqualBruteForce) {
    for (const Sides sides : {Sides::front_only, Sides::back_only}) {
        Scene scene = every_shape(7, 1.0);
        for (Object& object : scene.objects)
            object.sides = sides;
        const BruteForce brute_force(scene);
        const Accel accel = accel_of(scene);
        RayQuery fronts;
        fronts.sides = Sides::front_only;
        for (const Ray& ray : rays_through(accel.bounds(), 7, 1000)) {
            const auto got = accel.intersect(ray);
            ASSERT_EQ(complaint(got, brute_force.all(ray)), "") << to_text(ray);
            if (got) {
                ASSERT_EQ(got->front_face, sides == Sides::front_only);
            }
            if (sides == Sides::back_only) {
                ASSERT_FALSE(accel.occluded(ray, fronts));
            }
        }
    }
}

// Moves a point of the surface by its derivatives: a hit there must have the uv that they say.
TEST(EveryShape, DerivativesAgreeWithNeighbouringHits) {
    const Scene scene = every_shape(3, 1.0);
    const Accel accel = accel_of(scene);
    int compared = 0;
    for (const Ray& ray : rays_through(accel.bounds(), 5, 4000)) {
        const auto hit = accel.intersect(ray);
        if (!hit) continue;
        const SurfacePoint point = surface_point(scene, ray, *hit);
        const float slope = glm::dot(point.geometric_normal, ray.direction);
        if (std::abs(slope) < 0.2f) continue;
        EXPECT_NEAR(glm::dot(point.dpdu, point.geometric_normal), 0.0f,
                    1e-5f * glm::length(point.dpdu) + 1e-6f);
        EXPECT_NEAR(glm::dot(point.dpdv, point.geometric_normal), 0.0f,
                    1e-5f * glm::length(point.dpdv) + 1e-6f);
        for (const glm::vec2& step : {glm::vec2(1e-3f, 0.0f), glm::vec2(0.0f, 1e-3f)}) {
            const glm::vec3 moved = point.position + step.x * point.dpdu + step.y * point.dpdv;
            const Ray near = ray_towards(ray.origin, glm::dvec3(moved));
            const auto other = accel.intersect(near);
            if (!other || other->object != hit->object || other->primitive != hit->primitive ||
                other->front_face != hit->front_face) {
                continue;
            }
            const SurfacePoint there = surface_point(scene, near, *other);
            if (glm::dot(there.geometric_normal, point.geometric_normal) < 0.98f) continue;
            const glm::vec2 change = there.texture_uv - point.texture_uv;
            if (std::abs(change.x) > 0.5f || std::abs(change.y) > 0.5f) continue;  // the seam
            // Second order: the surface bends away from its tangent, the more so at a slant.
            const float tolerance = 1.2e-4f / std::abs(slope);
            EXPECT_NEAR(change.x, step.x, tolerance) << "object " << hit->object;
            EXPECT_NEAR(change.y, step.y, tolerance) << "object " << hit->object;
            ++compared;
        }
    }
    EXPECT_GT(compared, 1500);
}

TEST(EveryShape, PointsLieOnTheSurfaceWithinTheirBound) {
    for (const double s : kScales) {
        const Scene scene = every_shape(4, s);
        const Accel accel = accel_of(scene);
        for (const Ray& ray : rays_through(accel.bounds(), 6, 2000)) {
            const auto hit = accel.intersect(ray);
            if (!hit) continue;
            const SurfacePoint point = surface_point(scene, ray, *hit);
            // From just off the point, straight back: the surface is where the bound says.
            Ray probe;
            probe.direction = -point.geometric_normal;
            const auto reach = static_cast<float>(1e-3 * s);
            probe.origin = point.position + reach * point.geometric_normal;
            bool found = false;
            float nearest = std::numeric_limits<float>::infinity();
            for (const Hit& back : accel.intersect_all(probe)) {
                if (back.object != hit->object || back.primitive != hit->primitive) continue;
                nearest = std::min(nearest, std::abs(back.t - reach));
                found = true;
            }
            if (!found) continue;  // at a rim the probe may pass by
            const float bound =
                glm::length(point.position_error) + 2e-7f * glm::length(probe.origin);
            EXPECT_LE(nearest, bound + 4e-7f * reach) << "scale " << s << ' ' << to_text(*hit);
        }
    }
}

TEST(EveryShape, BoundsAreTight) {
    // The bounds hold every hit, and hits come near each of their six sides.
    const std::vector<Shape> shapes{Disk{{1, 2, 3}, {1, 2, -1}, 0.7},
                                    Cone{{0, 0, 0}, {1, 2, 0.5}, 0.8, 0.3},
                                    Torus{{1, 0, 0}, {1, 1, 3}, 1.0, 0.3}};
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        SCOPED_TRACE(i);
        Scene scene;
        place(scene, shapes[i]);
        const Accel accel = accel_of(scene);
        Bounds met;
        for (const Ray& ray : rays_through(accel.bounds(), 9, 60000)) {
            for (const Hit& hit : accel.intersect_all(ray))
                met.extend(surface_point(scene, ray, hit).position);
        }
        const float slack = 0.03f * glm::length(accel.bounds().extent());
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(met.min[axis], accel.bounds().min[axis] - 1e-6f);
            EXPECT_LE(met.max[axis], accel.bounds().max[axis] + 1e-6f);
            EXPECT_LE(met.min[axis] - accel.bounds().min[axis], slack);
            EXPECT_LE(accel.bounds().max[axis] - met.max[axis], slack);
        }
    }
}

TEST(Sets, AMillionSpheres) {
    constexpr std::uint32_t kCount = 1'000'000;
    Scene scene;
    const SetId set = add_sphere_set(scene, random_spheres(1, kCount, 0.004, 1.0));
    place(scene, SphereSetInstance{set});
    const auto start = std::chrono::steady_clock::now();
    const Accel accel = accel_of(scene);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const AccelStats stats = accel.stats();
    std::cout << "a million spheres: tree in " << took.count() << " s, " << stats.bytes / 1000000
              << " MB\n";
    EXPECT_EQ(stats.spheres, kCount);
    EXPECT_LT(stats.bytes, 100u * kCount);
    EXPECT_EQ(primitive_count(scene, scene.objects[0]), kCount);
    // Each is pickable: the sphere that a ray from just above it meets is itself, or one nearer.
    Random random(2);
    int itself = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::uint32_t wanted = random.below(kCount);
        const Sphere sphere = sphere_of(scene.sphere_sets[set], wanted);
        Ray ray;
        ray.origin = glm::vec3(sphere.centre + glm::dvec3(0, 0, 1.01 * sphere.radius));
        const auto hit = accel.intersect(ray);
        ASSERT_TRUE(hit.has_value());
        itself += hit->primitive == wanted ? 1 : 0;
    }
    EXPECT_GT(itself, 1500);
}

TEST(Sets, TreesAreSharedWithLaterAccels) {
    // More than one leaf of each, as the box of a tree of one leaf is not looked at.
    std::vector<glm::vec4> spheres{{0, 0, 0, 1}, {0, 0, 3, 1}};
    std::vector<glm::vec4> ends{{0, 0, 0, 1}, {0, 0, 1, 1}};
    for (int i = 0; i < 20; ++i) {
        const auto x = static_cast<float>(20 + 3 * i);
        spheres.emplace_back(x, 0, 0, 1);
        ends.insert(ends.end(), {{x, 0, 0, 1}, {x, 0, 1, 1}});
    }
    Scene scene;
    place(scene, SphereSetInstance{add_sphere_set(scene, {"balls", spheres, {}, {}})});
    place(scene, ConeSetInstance{add_cone_set(scene, {"twigs", ends, true, {}, {}})});
    const Accel first = accel_of(scene);
    // Whoever changes the arrays against the rules sees by it which tree is used.
    spheres[0].y = 50.0f;
    ends[0].y = 70.0f;
    ends[1].y = 70.0f;
    scene.objects[0].world_from_object = translate({5, 0, 0});
    const auto snapshot = std::make_shared<const Scene>(scene);
    const Accel second(snapshot, {}, &first);
    const Accel fresh(snapshot);
    const Ray at_sphere = ray_towards({5, 50, -9}, {5, 50, 0});
    const Ray at_cone = ray_towards({0, 70, -9}, {0, 70, 0});
    EXPECT_FALSE(second.occluded(at_sphere));
    EXPECT_FALSE(second.occluded(at_cone));
    EXPECT_TRUE(fresh.occluded(at_sphere));
    EXPECT_TRUE(fresh.occluded(at_cone));
    EXPECT_TRUE(second.occluded(ray_towards({5, 0, -9}, {5, 0, 3}))) << "the unchanged sphere";
    EXPECT_EQ(second.stats().spheres, spheres.size());
    EXPECT_EQ(second.stats().cones, ends.size() / 2);
}

TEST(CutOut, HolesAreNotThere) {
    Scene scene;
    const TextureId checker = add_texture(scene, {"holes", Checker{glm::vec4(1), glm::vec4(0)}});
    Material fence;
    fence.map(MapSlot::opacity).texture = checker;
    const MaterialId material = add_material(scene, fence);
    // One unit of uv a unit of length: whole squares.
    const ObjectId plane = place(scene, Plane{{0, 0, 1}, 0.0}, material);
    const ObjectId behind = place(scene, Rectangle{{-9, -9, -1}, {18, 0, 0}, {0, 18, 0}});
    const Accel accel = accel_of(scene);
    Random random(4);
    for (int i = 0; i < 500; ++i) {
        Ray ray;
        ray.origin = glm::vec3(random.point(glm::dvec3(-8, -8, 3), glm::dvec3(8, 8, 3)));
        const auto square = static_cast<int>(std::floor(ray.origin.x) + std::floor(ray.origin.y));
        const bool solid = square % 2 == 0;
        const auto hit = accel.intersect(ray);
        ASSERT_TRUE(hit.has_value());
        EXPECT_EQ(hit->object, solid ? plane : behind);
        EXPECT_EQ(accel.intersect_all(ray).size(), solid ? 2u : 1u);
        ray.t_max = 3.5f;
        EXPECT_EQ(accel.occluded(ray), solid);
    }
}

TEST(CutOut, OpacityAgainstTheCutoff) {
    const auto is_hit = [](float opacity, AlphaMode mode, float cutoff) {
        Scene scene;
        Material material;
        material.opacity = opacity;
        material.alpha_mode = mode;
        material.alpha_cutoff = cutoff;
        place(scene, Sphere{}, add_material(scene, material));
        return accel_of(scene).occluded(ray_towards({0, 0, 5}, {0, 0, 0}));
    };
    EXPECT_TRUE(is_hit(0.5f, AlphaMode::cut_out, 0.5f));
    EXPECT_FALSE(is_hit(0.49f, AlphaMode::cut_out, 0.5f));
    EXPECT_TRUE(is_hit(0.0f, AlphaMode::cut_out, 0.0f));
    EXPECT_TRUE(is_hit(0.1f, AlphaMode::blend, 0.5f));
    EXPECT_FALSE(is_hit(0.003f, AlphaMode::blend, 0.5f));
}

std::string complaint_about(const Shape& shape) {
    Scene scene;
    Object object;
    object.name = "thing";
    object.shape = shape;
    add_object(scene, object);
    try {
        check_scene(scene);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(CheckScene, NamesObjectKeyAndValueOfTheNewShapes) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto says = [](const Shape& shape, const std::string& rule) {
        EXPECT_EQ(complaint_about(shape), "object \"thing\": " + rule);
    };
    says(Disk{{nan, 0, 0}}, "centre must be a finite number, not nan");
    says(Disk{{0, 0, 0}, {0, 0, 0}}, "normal must not be zero: it gives a direction");
    says(Disk{{0, 0, 0}, {0, 1, 0}, 0.0}, "radius must be positive, not 0");
    says(Disk{{0, 0, 0}, {0, 1, 0}, 1.0, 1.0},
         "inner_radius must be less than the radius 1, not 1");
    says(Disk{{0, 0, 0}, {0, 1, 0}, 1.0, -1.0}, "inner_radius must be 0 or more, not -1");
    says(Rectangle{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}},
         "edge_u must not be zero: it gives a direction");
    says(Rectangle{{0, 0, 0}, {1, 0, 0}, {-2, 0, 0}},
         "edge_v must not be parallel to edge_u, but -2 0 0 is");
    says(Cone{{1, 2, 3}, {1, 2, 3}}, "base and apex must not be the same point, 1 2 3");
    says(Cone{{0, 0, 0}, {0, 1, 0}, 0.0, 0.0}, "base_radius and apex_radius must not both be 0");
    says(Cone{{0, 0, 0}, {0, 1, 0}, -1.0, 1.0}, "base_radius must be 0 or more, not -1");
    says(Torus{{0, 0, 0}, {0, 1, 0}, 0.0, 0.0}, "major_radius must be positive, not 0");
    says(Torus{{0, 0, 0}, {0, 1, 0}, 1.0, 0.0}, "minor_radius must be positive, not 0");
    says(Torus{{0, 0, 0}, {0, 1, 0}, 1.0, 2.0},
         "minor_radius must be no more than the major_radius 1, not 2");
    says(SphereSetInstance{3}, "sphere set 3 does not exist: the scene has 0");
    says(ConeSetInstance{2}, "cone set 2 does not exist: the scene has 0");
    EXPECT_EQ(complaint_about(Torus{}), "");
    EXPECT_EQ(complaint_about(Cone{}), "");
}

template <typename Set>
std::string complaint_about_set(const Set& set) {
    try {
        check_set(set);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(CheckSet, NamesTheFirstBadElement) {
    EXPECT_EQ(complaint_about_set(make_sphere_set("s", {{0, 0, 0, 1}, {0, 0, 0, 0}})),
              "sphere set \"s\": sphere 1: radius must be positive, not 0");
    EXPECT_EQ(complaint_about_set(make_sphere_set("s", {{0, 0, 0, 1}}, {{0, 2, 0}})),
              "sphere set \"s\": the parts hold 2 spheres, the sphere set has 1");
    EXPECT_EQ(complaint_about_set(make_cone_set("c", {{0, 0, 0, 1}}, false)),
              "cone set \"c\": 1 ends are no whole number of cones: give two a cone");
    EXPECT_EQ(complaint_about_set(make_cone_set("c", {{0, 0, 0, 1}, {0, 0, 0, 1}}, false)),
              "cone set \"c\": cone 0: base and apex are the same point, 0 0 0");
    EXPECT_EQ(complaint_about_set(make_cone_set("c", {{0, 0, 0, 0}, {1, 0, 0, 0}}, false)),
              "cone set \"c\": cone 0: base_radius and apex_radius must not both be 0");
    EXPECT_EQ(complaint_about_set(make_cone_set("c", {{0, 0, 0, -1}, {1, 0, 0, 0}}, false)),
              "cone set \"c\": cone 0: base_radius must be 0 or more, not -1");
}

}  // namespace
}  // namespace raypick
