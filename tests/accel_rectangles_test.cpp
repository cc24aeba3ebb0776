// Rectangles, which groups of rays meet several at once, on every instruction set.
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace raypick {
namespace {

class AccelRectangles : public OnInstructionSet {};

// A box of six that share their edges, and none of whose faces lies along the axes.
std::vector<Rectangle> room() {
    const glm::dvec3 low{-1.0, -0.8, -1.1};
    const glm::dvec3 x{2.0, 0.3, 0.0};
    const glm::dvec3 y{-0.2, 1.7, 0.1};
    const glm::dvec3 z{0.1, 0.0, 2.1};
    const glm::dvec3 high = low + x + y + z;
    return {{low, x, y}, {low, y, z}, {low, z, x}, {high, -x, -y}, {high, -y, -z}, {high, -z, -x}};
}

TEST_P(AccelRectangles, ShareTheirEdges) {
    Scene scene;
    for (const Rectangle& wall : room())
        place(scene, wall);
    expect_all_ways(scene, 2);
    const Accel accel = accel_of(scene);
    std::vector<Ray> rays;
    for (const Rectangle& wall : room()) {
        for (int i = 0; i < 64; ++i) {
            const glm::dvec3 on_edge = wall.corner + wall.edge_u * (i / 63.0);
            rays.push_back(ray_towards({0.1f, 0.05f, -0.03f}, glm::vec3(on_edge)));
        }
    }
    std::vector<Hit> hits(rays.size());
    accel.intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(hits[i].valid()) << to_text(rays[i]);
    expect_as_one_by_one(accel, rays);
}

// Rays exactly through an edge, where the last bit of a quotient says on which side they pass.
TEST_P(AccelRectangles, AreHitOrMissedOnTheirEdges) {
    for (const float z : {0.75f, 1.25f, 1.5f, 1.75f}) {
        for (int i = 1; i <= 32; ++i) {
            const float x = static_cast<float>(i) / 512.0f;
            const glm::dvec3 on_edge(2.0 * static_cast<double>(x), -1.0,
                                     2.0 * static_cast<double>(z));
            Scene scene;
            place(scene, Rectangle{on_edge, {1.0, 0.0, 0.0}, {0.0, 2.0, 0.0}});
            place(scene,
                  Rectangle{on_edge + glm::dvec3(0.0, 0.0, 1.0), {3.0, 0.0, 0.0}, {0.0, 2.0, 0.0}});
            Ray ray;
            ray.direction = {x, 0.0f, z};
            expect_as_one_by_one(accel_of(scene), std::vector<Ray>(64, ray), {}, Hits::perhaps);
            if (HasFatalFailure()) return;
        }
    }
}

TEST_P(AccelRectangles, AreSeenFromEitherSideOrOne) {
    Scene scene;
    for (const Rectangle& wall : room()) {
        place(scene, wall, kNoMaterial, translate({0.3, 0.0, -0.1}));
        scene.objects.back().sides = Sides::front_only;
        place(scene, wall, kNoMaterial, rotate(25.0, {1, 2, 3}) * scale({0.6, -0.7, 0.5}));
        scene.objects.back().sides = Sides::back_only;
    }
    expect_all_ways(scene, 3);
    const Accel accel = accel_of(scene);
    const std::vector<Ray> rays =
        coherent_rays(accel.bounds(), {24, 24}, Projection::perspective, 5);
    for (const Sides sides : {Sides::front_only, Sides::back_only}) {
        RayQuery query;
        query.sides = sides;
        expect_as_one_by_one(accel, rays, query);
        expect_shadows_as_one_by_one(accel, rays, query);
    }
}

// Where several lie in one plane, the first of them counts.
TEST_P(AccelRectangles, LieAmongTriangles) {
    Scene scene;
    place_mesh(scene, soup_data(6, 400, 0.4));
    for (int i = 0; i < 3; ++i)
        place(scene, Rectangle{{-1.5, -0.2, 1.5}, {3.0, 0.0, 0.0}, {0.0, 0.0, -3.0}});
    place(scene, MeshInstance{0}, kNoMaterial, translate({0.0, -0.2, 0.0}));
    expect_all_ways(scene, 4);
    EXPECT_EQ(accel_of(scene).intersect({{1.4f, 1.0f, 1.4f}, {0, -1, 0}})->object,
              scene.objects[1].id);
}

RAYPICK_ON_EACH_INSTRUCTION_SET(AccelRectangles);

}  // namespace
}  // namespace raypick
