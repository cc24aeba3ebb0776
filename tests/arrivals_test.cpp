// Hits in blocks against hits one by one: the same to the bit, for every instruction set.
#include "tracer/shade/arrivals.h"

#include "tests/each_instruction_set.h"
#include "tests/looks.h"
#include "tests/same_surfaces.h"
#include "tests/tracer_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace raypick {
namespace {

MaterialId add_textured(Scene& scene) {
    Material material = matt(glm::vec3(0.5f));
    Texture checker;
    checker.source = Checker{glm::vec4(1.0f), glm::vec4(0.2f)};
    material.map(MapSlot::diffuse).texture = add_texture(scene, checker);
    return add_material(scene, material);
}

void move(MeshData& data, const glm::vec3& by) {
    for (glm::vec3& p : data.positions)
        p += by;
}

// Something of every kind, with maps and without, moved and not; a soup all of which lies near its
// edges if `away` is far.
Scene all_kinds(const glm::vec3& away) {
    Scene scene;
    const MaterialId textured = add_textured(scene);
    const MaterialId mirrors = add_material(scene, mirror({1, 1, 1}, Reflectance::constant));
    MeshData soup = soup_data(3, 200, 0.8);
    for (std::size_t i = 0; i < soup.positions.size(); ++i)
        soup.uvs.emplace_back(i % 7 < 2 ? glm::vec2(0.5f) : glm::vec2(soup.positions[i]));
    move(soup, away);
    place_mesh(scene, soup, textured);
    MeshData ball = ball_data(2);
    ball.normals = ball.positions;
    move(ball, away + glm::vec3(2, 0, 0));
    place_mesh(scene, ball, mirrors);
    place_mesh(scene, ball, mirrors, translate({-4, 0, 0}));
    const glm::dvec3 at(away);
    place(scene, Sphere{at + glm::dvec3(0, 2, 0), 0.7}, mirrors);
    place(scene, Sphere{at + glm::dvec3(0, -2, 0), 0.7}, textured);
    std::vector<glm::vec4> set{{glm::vec3(at + glm::dvec3(0, 0, 2)), 0.6f},
                               {glm::vec3(at + glm::dvec3(1, 0, 2)), 0.4f}};
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("set", std::move(set)))});
    place(scene, Rectangle{at + glm::dvec3(-2, -3, -2), {4, 0, 0}, {0, 0, 4}});
    return scene;
}

// Holds the lanes of a block against find_surface().
class Checked {
public:
    Checked(const Accel& accel, std::size_t count)
        : scene_(shade_scene(accel, {}, {})),
          rays_(rays_through(accel.bounds(), 5, count)),
          hits_(count) {
        accel.intersect(rays_, hits_);
    }

    void run(Arrivals& arrivals) {
        arrivals.begin(scene_, rays_, hits_);
        for (std::size_t i = 0; i < hits_.size();) {
            const std::size_t first = i;
            const Arrivals::Block* full = arrivals.add(i);
            for (std::size_t added = first; added < i; ++added)
                wanted_.insert(added);
            if (full != nullptr) {
                EXPECT_TRUE(full->rows.full());
                compare(arrivals, *full);
            } else {
                EXPECT_TRUE(i == hits_.size() || !hits_[i].valid());
                ++i;
            }
        }
        while (const Arrivals::Block* rest = arrivals.rest())
            compare(arrivals, *rest);
        EXPECT_TRUE(wanted_.empty());
    }

    // Hits by their SurfaceKind.
    std::array<std::size_t, 4> seen{};

private:
    void compare(Arrivals& arrivals, const Arrivals::Block& block) {
        EXPECT_GT(block.rows.count, 0u);
        for (std::size_t lane = 0; lane < block.rows.count; ++lane) {
            const std::size_t i = block.hit[lane];
            SCOPED_TRACE(i);
            EXPECT_EQ(wanted_.erase(i), 1u);
            const KnownPart& part = arrivals.part(block, lane);
            EXPECT_EQ(part.kind, arrivals.part(block, 0).kind);
            ++seen[static_cast<std::size_t>(part.kind)];
            const FoundHit wanted = find_surface(scene_, rays_[i], hits_[i]);
            SurfacePoint place;
            block.rows.take(lane, place);
            expect_same_place(place, wanted.surface);
            EXPECT_EQ((block.rows.front >> lane & 1u) != 0, hits_[i].front_face);
            FoundHit found;
            arrivals.set_found(block, lane, found);
            EXPECT_EQ(found.object, wanted.object);
            EXPECT_EQ(found.material, wanted.material);
            expect_same(found.surface, wanted.surface);
        }
    }

    ShadeScene scene_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::set<std::size_t> wanted_;  // not handed on yet
};

class ArrivalsBy : public OnInstructionSet {};

TEST_P(ArrivalsBy, AreThoseOfFindSurfaceToTheBit) {
    Arrivals arrivals;
    for (const glm::vec3& away : {glm::vec3(0.0f), glm::vec3(2e4f, -3e4f, 1e4f)}) {
        const Accel accel = accel_of(all_kinds(away));
        for (const std::size_t count : {3000u, 0u, 1u, 17u, 40u}) {
            Checked checked(accel, count);
            checked.run(arrivals);
            if (count != 3000) continue;
            for (const std::size_t seen : checked.seen)
                EXPECT_GT(seen, 50u);
        }
    }
}

RAYPICK_ON_EACH_INSTRUCTION_SET(ArrivalsBy);

TEST(Arrivals, KnowWhatIsSimple) {
    Scene scene;
    Material seen_through = matt(glm::vec3(0.5f));
    seen_through.alpha_mode = AlphaMode::blend;
    seen_through.opacity = 0.5f;
    const auto x = [](std::size_t i) { return 3.0 * static_cast<double>(i); };
    const std::vector<MaterialId> materials{
        add_material(scene, matt(glm::vec3(0.5f))),
        add_material(scene, mirror(glm::vec3(1.0f), Reflectance::constant)),
        add_material(scene, mirror(glm::vec3(1.0f), Reflectance::conductor)),
        add_material(scene, glass(1.5f, Reflectance::constant)),
        add_material(scene, seen_through),
        add_textured(scene),
    };
    for (std::size_t i = 0; i < materials.size(); ++i)
        place(scene, Sphere{{x(i), 0.0, 0.0}, 1.0}, materials[i]);
    const Accel accel = accel_of(scene);
    const ShadeScene shaded = shade_scene(accel, {}, {});
    std::vector<bool> simple;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const auto hit =
            accel.intersect(Ray{{static_cast<float>(x(i)), 0.0f, 5.0f}, {0.0f, 0.0f, -1.0f}});
        ASSERT_TRUE(hit);
        simple.push_back(part_at(shaded, *hit).simple);
    }
    EXPECT_EQ(simple, (std::vector<bool>{true, true, false, false, false, false}));
}

}  // namespace
}  // namespace raypick
