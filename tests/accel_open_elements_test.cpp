// Rays that begin on spheres and cones of sets, of which groups can't tell in float whether they
// hit these, on every instruction set.
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/surface.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cstddef>
#include <vector>

namespace raypick {
namespace {

class AccelOpenElements : public OnInstructionSet {};

// Some lie in others.
std::vector<glm::vec4> spheres() {
    Random random(71);
    std::vector<glm::vec4> result;
    for (int i = 0; i < 120; ++i) {
        result.emplace_back(glm::vec3(random.point(glm::dvec3(-1.0), glm::dvec3(1.0))),
                            static_cast<float>(0.1 + 0.3 * random.unit()));
    }
    return result;
}

// Base and apex in turns.
std::vector<glm::vec4> cones() {
    Random random(72);
    std::vector<glm::vec4> result;
    for (int i = 0; i < 120; ++i) {
        const glm::dvec3 base = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        const glm::dvec3 apex = base + 0.6 * random.direction();
        result.emplace_back(glm::vec3(base), 0.15f);
        result.emplace_back(glm::vec3(apex), i % 2 == 0 ? 0.15f : 0.02f);
    }
    return result;
}

void place_twice(Scene& scene, const Shape& shape, Sides sides) {
    place(scene, shape);
    place(scene, shape, kNoMaterial,
          translate({2.5, 0, 1}) * rotate(70.0, {1, 2, 3}) * scale({1.5, -0.5, 1.0}));
    for (Object& object : scene.objects)
        object.sides = sides;
}

// From where eye rays hit: mirrored and straight on, on the surface as it is in float and beside
// it.
std::vector<Ray> leaving_rays(const Accel& accel, const std::vector<Ray>& eyes) {
    std::vector<Ray> rays;
    for (const bool beside : {false, true}) {
        for (const bool mirrored : {true, false}) {
            for (const Ray& eye : eyes) {
                const auto hit = accel.intersect(eye);
                if (!hit) continue;
                const SurfacePoint point = surface_point(accel.scene(), eye, *hit);
                Ray ray;
                ray.direction =
                    mirrored ? glm::normalize(glm::reflect(eye.direction, point.geometric_normal))
                             : eye.direction;
                ray.origin = beside ? offset_origin(point, ray.direction) : point.position;
                rays.push_back(ray);
            }
        }
    }
    return rays;
}

void expect_leaving_as_one_by_one(const Scene& scene) {
    const Accel accel = accel_of(scene);
    const std::vector<Ray> eyes =
        coherent_rays(accel.bounds(), {24, 32}, Projection::perspective, 11);
    const std::vector<Ray> rays = leaving_rays(accel, eyes);
    ASSERT_GT(rays.size(), 1000u);
    for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
        RayQuery query;
        query.sides = sides;
        expect_as_one_by_one(accel, rays, query, Hits::perhaps);
        query.uv = false;
        std::vector<Hit> hits(rays.size());
        accel.intersect(rays, hits, query);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit alone = accel.intersect(rays[i], query).value_or(Hit{});
            ASSERT_EQ(hits[i].t, alone.t) << i << ": " << to_text(rays[i]);
        }
    }
    const glm::vec3 light = accel.bounds().max * 1.5f;
    std::vector<Ray> shadows = rays;
    for (Ray& ray : shadows) {
        ray.direction = glm::normalize(light - ray.origin);
        ray.t_max = glm::distance(light, ray.origin);
    }
    expect_as_one_by_one_towards(accel, light, shadows);
    // An interval's ends are outside of it.
    std::vector<Ray> short_rays = rays;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto hit = accel.intersect(rays[i]);
        if (hit) (i % 2 == 0 ? short_rays[i].t_max : short_rays[i].t_min) = hit->t;
    }
    expect_as_one_by_one(accel, short_rays, {}, Hits::perhaps);
}

TEST_P(AccelOpenElements, Spheres) {
    for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
        Scene scene;
        place_twice(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("", spheres()))},
                    sides);
        expect_leaving_as_one_by_one(scene);
        if (HasFatalFailure()) return;
    }
}

TEST_P(AccelOpenElements, Cones) {
    for (const bool capped : {false, true}) {
        for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
            Scene scene;
            place_twice(scene,
                        ConeSetInstance{add_cone_set(scene, make_cone_set("", cones(), capped))},
                        sides);
            expect_leaving_as_one_by_one(scene);
            if (HasFatalFailure()) return;
        }
    }
}

// Those of one set are waited for while the other's come.
TEST_P(AccelOpenElements, SpheresAmongConesAndTriangles) {
    Scene scene;
    place_mesh(scene, soup_data(16, 400, 0.4));
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("", spheres()))});
    place(scene, ConeSetInstance{add_cone_set(scene, make_cone_set("", cones(), true))});
    place(scene, SphereSetInstance{0});  // each of them twice: the first one counts
    expect_leaving_as_one_by_one(scene);
    expect_all_ways(scene, 12);
}

RAYPICK_ON_EACH_INSTRUCTION_SET(AccelOpenElements);

}  // namespace
}  // namespace raypick
