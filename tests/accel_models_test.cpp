// The tree against brute force on real meshes: 100,000 seeded rays; and batches against rays one by
// one.
#include "tests/brute_force.h"
#include "tests/needs.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/io/load.h"
#include "tracer/parallel/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>

namespace raypick {
namespace {

// Rays of rays_through, and as many aimed exactly at vertices and at middles of edges.
std::vector<Ray> model_rays(const Scene& scene, const Bounds& bounds, std::size_t count) {
    std::vector<Ray> rays = rays_through(bounds, 1, count / 2);
    Random random(2);
    const double radius = 0.5 * static_cast<double>(glm::length(bounds.extent()));
    while (rays.size() < count) {
        const Object& object = scene.objects[random.below(scene.objects.size())];
        const Mesh& mesh = scene.meshes[std::get<MeshInstance>(object.shape).mesh];
        if (mesh.triangles.empty()) continue;
        const glm::uvec3 t = mesh.triangles[random.below(mesh.triangles.size())];
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 target = rays.size() % 2 == 0 ? a : 0.5 * (a + b);
        const glm::dvec3 from =
            glm::dvec3(bounds.centre()) + random.between(0.1, 2.0) * radius * random.direction();
        rays.push_back(ray_towards(glm::vec3(from), object.world_from_object.point(target)));
    }
    return rays;
}

struct Tally {
    std::atomic<int> hits{0};
    std::atomic<int> ties{0};
    std::atomic<int> wrong{0};
};

void compare(const std::string& file, std::size_t count) {
    Scene scene = load_scene(model(file)).scene;
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const std::vector<Ray> rays = model_rays(scene, accel.bounds(), count);
    Tally tally;
    std::mutex one_at_a_time;
    parallel_for(rays.size(), 0, {}, [&](std::size_t i) {
        const std::vector<Candidate> candidates = brute.all(rays[i]);
        const std::optional<Hit> hit = accel.intersect(rays[i]);
        std::string wrong = complaint(hit, candidates);
        if (accel.occluded(rays[i]) != hit.has_value()) wrong += " occluded says otherwise";
        tally.hits += hit ? 1 : 0;
        const auto alone = winner(candidates, 0.0);
        if (alone && hit && alone->rounded() != *hit) ++tally.ties;
        if (!wrong.empty() && ++tally.wrong < 5) {
            const std::lock_guard lock(one_at_a_time);
            ADD_FAILURE() << wrong << '\n' << to_text(rays[i]);
        }
    });
    EXPECT_EQ(tally.wrong, 0);
    EXPECT_GT(tally.hits, static_cast<int>(count / 4)) << "the rays don't test much";
    std::cout << file << ": " << count << " rays, " << tally.hits << " hits, " << tally.ties
              << " decided by the tie rule\n";
}

// Batches of eye rays and of shadow rays, which one by one are held against brute force below.
void compare_batches(const std::string& file) {
    const Accel accel = accel_of(load_scene(model(file)).scene);
    const std::vector<Ray> rays =
        coherent_rays(accel.bounds(), {128, 192}, Projection::perspective, 3);
    expect_as_one_by_one(accel, rays);
    expect_shadows_as_one_by_one(accel, rays);
}

TEST(AccelModels, BatchesInTheBunny) {
    RAYPICK_REQUIRE_MODEL("stanford/bunny_binary.ply");
    compare_batches("stanford/bunny_binary.ply");
}

TEST(AccelModels, BatchesInSponza) {
    RAYPICK_REQUIRE_MODEL("sponza/sponza.obj");
    compare_batches("sponza/sponza.obj");
}

TEST(AccelModels, BatchesInTheKitchen) {
    RAYPICK_REQUIRE_MODEL("bitterli/kitchen.glb");
    compare_batches("bitterli/kitchen.glb");
}

TEST(AccelModels, Bunny) {
    RAYPICK_REQUIRE_MODEL("stanford/bunny_binary.ply");
    compare("stanford/bunny_binary.ply", 50000);
}

TEST(AccelModels, MotorBike) {
    RAYPICK_REQUIRE_MODEL("openfoam/motorBike.obj");
    compare("openfoam/motorBike.obj", 20000);
}

TEST(AccelModels, PartOfTheKitchen) {
    RAYPICK_REQUIRE_MODEL("bitterli/kitchen_Mesh090.ply");
    compare("bitterli/kitchen_Mesh090.ply", 30000);
}

}  // namespace
}  // namespace raypick
