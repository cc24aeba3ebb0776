// Many points in the light at once against one by one: the same to the bit, for every instruction
// set.
#include "tracer/shade/lit_points.h"

#include "tests/each_instruction_set.h"
#include "tests/same_surfaces.h"
#include "tests/tracer_scenes.h"
#include "tracer/shade/branches.h"
#include "tracer/shade/lit_point.h"

#include <gtest/gtest.h>

#include <limits>

namespace raypick {
namespace {

// Everything that a ShadingPoint refers to.
struct End {
    SurfacePoint surface;
    Material kind;
    SurfaceMaterial material;
    glm::vec3 normal{0.0f};
    glm::vec3 incoming{0.0f};
    glm::vec3 own{0.0f};

    [[nodiscard]] ShadingPoint point() const {
        const float side = surface.front_face ? 1.0f : -1.0f;
        return {surface, kind, material, normal, side * surface.geometric_normal, incoming};
    }
};

glm::vec3 colour_of(Random& random) {
    return glm::abs(glm::vec3(random.direction()));
}

End random_end(std::uint64_t seed) {
    Random random(seed);
    End end;
    end.surface.position = glm::vec3(2.0 * random.direction());
    end.surface.position_error = 1e-6f * colour_of(random);
    end.surface.geometric_normal = glm::vec3(random.direction());
    end.surface.front_face = seed % 2 == 0;
    end.normal =
        glm::normalize(end.surface.geometric_normal + 0.5f * glm::vec3(random.direction()));
    end.incoming = glm::vec3(random.direction());
    end.own = colour_of(random);
    end.material.diffuse = colour_of(random);
    if (seed % 3 != 0) end.material.specular = colour_of(random);
    end.material.shininess = static_cast<float>(seed % 7) * 5.0f;
    end.material.opacity = seed % 5 == 0 ? 0.5f : 1.0f;
    end.material.model = seed % 4 < 2 ? LocalModel::phong : LocalModel::blinn_phong;
    return end;
}

std::vector<End> random_ends(std::size_t count) {
    std::vector<End> ends;
    for (std::size_t i = 0; i < count; ++i)
        ends.push_back(random_end(i));
    if (count > 4) ends[4].surface.position = {1.0f, 2.0f, 3.0f};  // where the lights are
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (count > 15) {  // where floats have no next ones
        ends[9].surface.position = {0.0f, -0.0f, kInfinity};
        ends[10].surface.position = {-kInfinity, std::numeric_limits<float>::quiet_NaN(), 0.0f};
        ends[11].surface.geometric_normal = {0.0f, -1.0f, 0.0f};
        ends[12].surface.geometric_normal = {1.0f, 0.0f, -0.0f};
        ends[12].surface.position = {-1e-45f, 0.0f, 0.0f};
        ends[13].surface.geometric_normal = -ends[9].surface.geometric_normal;
        ends[13].surface.position = ends[9].surface.position;
        ends[14].surface.geometric_normal = -ends[10].surface.geometric_normal;
        ends[14].surface.position = ends[10].surface.position;
        for (std::size_t i : {9u, 10u, 11u, 12u, 13u, 14u})
            ends[i].surface.position_error = glm::vec3(0.0f);
    }
    return ends;
}

std::vector<Light> lights() {
    const glm::dvec3 at(1.0, 2.0, 3.0);
    const glm::vec3 colour(0.9f, 0.8f, 0.7f);
    std::vector<Light> all;
    all.emplace_back(PointLight{"plain", at, colour});
    all.emplace_back(PointLight{"falls off", at, colour, {1.0, 0.2, 0.1}});
    all.emplace_back(PointLight{"is weak", at, colour, {3.0, 0.0, 0.0}});
    all.emplace_back(PointLight{"is black", at, glm::vec3(0.0f)});
    all.emplace_back(DirectionalLight{"sun", {0.3, -0.9, 0.2}, colour});
    all.emplace_back(SpotLight{"spot", at, {-0.3, -0.6, -0.8}, colour, {}, 20.0, 40.0});
    return all;
}

// All of them, so that end i is point i. Every seventh gets its normal afterwards.
void add(const std::vector<End>& ends, LitPoints& points) {
    points.clear();
    SurfaceRows rows;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        SurfacePoint surface = ends[i].surface;
        surface.shading_normal = (surface.front_face ? 1.0f : -1.0f) * ends[i].normal;
        if (i % 7 == 0) surface.shading_normal = {0.6f, 0.0f, 0.8f};
        Hit hit;
        hit.front_face = surface.front_face;
        rows.put(rows.add({glm::vec3(0.0f), ends[i].incoming}, hit), surface);
        if (!rows.full() && i + 1 != ends.size()) continue;
        const std::size_t first = points.add(rows);
        for (std::size_t k = first; k < first + rows.count; ++k) {
            points.set_ray(k, static_cast<std::uint32_t>(3 * k));
            points.set_material(k, ends[k].material, ends[k].own);
            if (k % 7 == 0) points.set_normal(k, ends[k].normal);
        }
        rows.clear();
    }
}

void shine(const PreparedLight& light, LitPoints& points) {
    if (LitPoints::at_once(light)) return points.shine(light);
    for (std::size_t i = 0; i < points.size(); ++i)
        points.shine(i, light_sample(light, glm::dvec3(points.position(i)), 0, 0));
}

// What one light adds to one point; every third shadow ray is blocked, every fourth tinted.
class OneByOne {
public:
    explicit OneByOne(bool shadows) : shadows_(shadows) {}

    glm::vec3 added(const End& end, const PreparedLight& light) {
        const ShadingPoint point = end.point();
        LitPoint lit;
        set_lit_point(point, lit);
        const LightSample sample = light_sample(light, glm::dvec3(lit.position), 0, 0);
        if (!faces(lit, sample)) return glm::vec3(0.0f);
        if (!shadows_) return lit_by(lit, sample, glm::vec3(1.0f));
        if (shades_itself(lit, sample)) return glm::vec3(0.0f);
        set_shadow_ray(lit, sample, rays.emplace_back());
        const std::size_t number = rays.size() - 1;
        if (number % 3 == 0) return glm::vec3(0.0f);
        return lit_by(lit, sample, number % 4 == 0 ? kTint : glm::vec3(1.0f));
    }

    static constexpr glm::vec3 kTint{0.3f, 0.6f, 0.9f};
    std::vector<Ray> rays;

private:
    bool shadows_;
};

void expect_same_rays(std::span<const Ray> got, std::span<const Ray> wanted) {
    ASSERT_EQ(got.size(), wanted.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_TRUE(same_bits(got[i].origin, wanted[i].origin));
        EXPECT_TRUE(same_bits(got[i].direction, wanted[i].direction));
        EXPECT_EQ(got[i].t_min, wanted[i].t_min);
        EXPECT_EQ(got[i].t_max, wanted[i].t_max);
    }
}

void compare(LitPoints& points, const std::vector<End>& ends, bool shadows) {
    std::vector<glm::vec3> wanted;
    add(ends, points);
    const auto is_left_out = [](std::size_t i) { return i % 11 == 3; };
    for (std::size_t i = 0; i < ends.size(); ++i) {
        wanted.push_back(ends[i].own);
        if (is_left_out(i)) points.leave_out(i);
    }
    points.leave_surfaces();
    std::vector<Ray> rays(points.size());
    std::vector<std::uint32_t> of(points.size());
    for (const Light& light : lights()) {
        const PreparedLight source = prepared(light);
        OneByOne one_by_one(shadows);
        for (std::size_t i = 0; i < ends.size(); ++i) {
            if (!is_left_out(i)) wanted[i] += one_by_one.added(ends[i], source);
        }
        shine(source, points);
        points.face_light(shadows);
        const std::size_t taken = points.take_shadow_rays(rays, of);
        if (shadows) expect_same_rays(std::span(rays).first(taken), one_by_one.rays);
        for (std::size_t i = 0; shadows && i < taken; ++i) {
            if (i % 3 == 0) points.block(of[i]);
            if (i % 4 == 0) points.tint(of[i], OneByOne::kTint);
        }
        points.gather();
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(points.holds(i), i < ends.size() && !is_left_out(i)) << i;
        if (!points.holds(i)) continue;
        EXPECT_EQ(points.ray(i), 3 * i);
        EXPECT_TRUE(same_bits(points.colour(i), wanted[i] * ends[i].material.opacity)) << i;
    }
}

class LitPointsBy : public OnInstructionSet {};

TEST_P(LitPointsBy, AreThoseOfLitPointToTheBit) {
    LitPoints points;
    for (const std::size_t count : {1000u, 0u, 1u, 7u, 16u, 17u}) {
        SCOPED_TRACE(count);
        for (const bool shadows : {false, true})
            compare(points, random_ends(count), shadows);
    }
}

// Normals lean, so that some mirrored rays would lead into the surface, and incoming rays come from
// everywhere; some along the surface, which they leave on its outside.
TEST_P(LitPointsBy, MirrorAsBranchesDo) {
    ShadeScene scene;
    std::vector<End> ends = random_ends(500);
    LitPoints points;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        ends[i].kind.reflect = ends[i].material.reflect = glm::vec3(0.5f);
        if (i % 5 == 0) ends[i].normal = glm::vec3(Random(i).direction());
        if (i % 9 == 0) ends[i].incoming = ends[i].normal;
        if (i % 13 < 2) {
            ends[i].surface.geometric_normal = ends[i].normal = {0.0f, 1.0f, 0.0f};
            ends[i].incoming = {1.0f, 0.0f, 0.0f};
        }
    }
    add(ends, points);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (i / 16 % 3 != 0) points.want_mirrored(i);
    }
    points.mirror();
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (i / 16 % 3 == 0) continue;
        SCOPED_TRACE(i);
        const ShadingPoint point = ends[i].point();
        Branches branches;
        find_branches(scene, point, {}, 1.0f, branches);
        Ray ray;
        points.take_mirrored(i, ray);
        const Ray wanted = leaving(point, branches.branch[0].direction);
        expect_same_rays(std::span(&ray, 1), std::span(&wanted, 1));
    }
}

RAYPICK_ON_EACH_INSTRUCTION_SET(LitPointsBy);

// One material for a whole block, after blocks of others.
TEST(LitPoints, TakeOneMaterialForAll) {
    const PreparedLight light = prepared(lights().front());
    const std::vector<End> others = random_ends(16);
    for (const std::size_t of : {1u, 2u, 3u, 5u}) {  // shiny by either model, not, see-through
        std::vector<End> ends = random_ends(13);
        for (End& end : ends) {
            end.material = others[of].material;
            end.own = others[of].own;
        }
        LitPoints one_by_one;
        LitPoints all;
        for (LitPoints* points : {&one_by_one, &all}) {
            add(ends, *points);
            if (points == &all) {
                for (std::size_t i = 0; i < ends.size(); ++i)
                    points->set_material(i, others[i].material, others[i].own);
                points->set_materials(0, ends[0].material, ends[0].own);
            }
            shine(light, *points);
            points->face_light(false);
            points->gather();
        }
        for (std::size_t i = 0; i < ends.size(); ++i)
            EXPECT_TRUE(same_bits(all.colour(i), one_by_one.colour(i))) << of << " " << i;
    }
}

}  // namespace
}  // namespace raypick
