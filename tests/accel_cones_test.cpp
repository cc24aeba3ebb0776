// Cones of all forms against batches of rays that only just hit or miss them, on every instruction
// set that this machine has: bit for bit the answers of the same rays one by one, and those of
// brute force.
#include "tests/brute_force.h"
#include "tests/each_instruction_set.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/trace_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace raypick {
namespace {

class AccelCones : public OnInstructionSet {};

struct Twig {
    glm::vec4 base{0.0f};
    glm::vec4 apex{0.0f};
};

// Cylinders, cones with a tip at either end, truncated ones; long, flat and thin.
std::vector<Twig> twigs(float size) {
    Random random(31);
    std::vector<Twig> result;
    for (int i = 0; i < 24; ++i) {
        const glm::dvec3 base = 0.8 * random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        glm::dvec3 axis = random.direction();
        if (i % 5 == 0) axis = {0.0, i % 2 == 0 ? 1.0 : -1.0, 0.0};
        const double length = i % 7 == 0 ? 1e-4 : (i % 7 == 1 ? 2.0 : 0.3);
        const auto wide = static_cast<float>(i % 11 == 0 ? 1e-4 : random.between(0.05, 0.2));
        const float radii[5][2] = {
            {wide, wide}, {wide, 0.0f}, {0.0f, wide}, {wide, 0.6f * wide}, {0.99f * wide, wide}};
        const float* radius = radii[i % 5];
        result.push_back({size * glm::vec4(glm::vec3(base), radius[0]),
                          size * glm::vec4(glm::vec3(base + length * axis), radius[1])});
    }
    return result;
}

std::vector<glm::vec4> ends_of(const std::vector<Twig>& all) {
    std::vector<glm::vec4> ends;
    for (const Twig& twig : all)
        ends.insert(ends.end(), {twig.base, twig.apex});
    return ends;
}

// The axis and two directions across it.
struct Frame {
    glm::dvec3 along, u, v;
    explicit Frame(const Twig& twig)
        : along(glm::normalize(glm::dvec3(twig.apex) - glm::dvec3(twig.base))) {
        const glm::dvec3 other =
            std::abs(along.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        u = glm::normalize(glm::cross(along, other));
        v = glm::cross(along, u);
    }
};

// From afar to points on the rim of the side as the eye sees it, and of both ends, off by as much
// as float can just tell.
void add_grazing(const Twig& twig, const glm::dvec3& eye, std::vector<Ray>& rays) {
    const Frame frame(twig);
    const glm::dvec3 base(twig.base);
    const glm::dvec3 apex(twig.apex);
    const glm::dvec3 sideways = glm::normalize(glm::cross(frame.along, base - eye));
    for (int i = 0; i < 256; ++i) {
        const double share = i % 64 / 63.0;
        const double off = 1.0 + (i % 16 - 8) * (i % 32 < 16 ? 2e-7 : 2e-3);
        const double radius =
            glm::mix(static_cast<double>(twig.base.w), static_cast<double>(twig.apex.w), share);
        const glm::dvec3 middle = glm::mix(base, apex, share);
        glm::dvec3 target = middle + (i % 2 == 0 ? off : -off) * radius * sideways;
        if (i >= 128) {
            const glm::vec4& end = i < 192 ? twig.base : twig.apex;
            target =
                glm::dvec3(end) + off * static_cast<double>(end.w) *
                                      (std::cos(0.1 * i) * frame.u + std::sin(0.1 * i) * frame.v);
        }
        rays.push_back(ray_towards(glm::vec3(eye), target));
    }
}

// Along the axis and the side, on them and beside, from outside of the ends and from between.
void add_parallel(const Twig& twig, std::vector<Ray>& rays) {
    const Frame frame(twig);
    const glm::dvec3 base(twig.base);
    const glm::dvec3 apex(twig.apex);
    for (int i = 0; i < 128; ++i) {
        const double radius = static_cast<double>(std::max(twig.base.w, twig.apex.w));
        const double off = radius * (i % 8 == 0 ? 0.0 : 1.0 + (i % 8 - 4) * 1e-7);
        const glm::dvec3 across = off * (std::cos(0.2 * i) * frame.u + std::sin(0.2 * i) * frame.v);
        const double start = i % 16 < 8 ? -0.7 : 0.4;
        const glm::dvec3 from = glm::mix(base, apex, i % 2 == 0 ? start : 1.0 - start) + across;
        glm::dvec3 to = from + (i % 2 == 0 ? apex - base : base - apex);
        if (i % 4 >= 2) to += (twig.apex.w > twig.base.w ? 1.0 : -1.0) * 0.5 * across;
        if (glm::vec3(from) == glm::vec3(to)) continue;
        rays.push_back(ray_towards(glm::vec3(from), to));
    }
}

// From within, and from points on the side outwards, inwards and along it.
void add_from_the_cone(const Twig& twig, Random& random, std::vector<Ray>& rays) {
    const Frame frame(twig);
    for (int i = 0; i < 128; ++i) {
        const double share = random.unit();
        const double radius =
            glm::mix(static_cast<double>(twig.base.w), static_cast<double>(twig.apex.w), share);
        const double angle = 6.3 * random.unit();
        const glm::dvec3 out = std::cos(angle) * frame.u + std::sin(angle) * frame.v;
        const glm::dvec3 from = glm::mix(glm::dvec3(twig.base), glm::dvec3(twig.apex), share) +
                                (i % 2 == 0 ? 0.5 : 1.0) * radius * out;
        const glm::dvec3 aim = i % 8 == 7 ? glm::cross(out, frame.along) : random.direction();
        Ray ray;
        ray.origin = glm::vec3(from);
        ray.direction = glm::vec3(glm::normalize(aim));
        rays.push_back(ray);
    }
}

std::vector<Ray> rays_at(const std::vector<Twig>& all, double size) {
    Random random(32);
    std::vector<Ray> rays;
    for (const Twig& twig : all) {
        add_grazing(twig, size * glm::dvec3(0.5, 0.6, 4.0), rays);
        add_grazing(twig, size * 300.0 * random.direction(), rays);
        add_parallel(twig, rays);
        add_from_the_cone(twig, random, rays);
    }
    return rays;
}

void expect_the_same(const Scene& scene, const std::vector<Ray>& rays) {
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size(), 7);
    accel.intersect(rays, hits);
    accel.occluded(rays, blocked);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto every = brute.all(rays[i]);
        const auto got = hits[i].valid() ? std::optional(hits[i]) : std::nullopt;
        ASSERT_EQ(complaint(got, every), "") << i << ": " << to_text(rays[i]);
        ASSERT_EQ(hits[i], accel.intersect(rays[i]).value_or(Hit{})) << i << to_text(rays[i]);
        ASSERT_EQ(blocked[i], every.empty() ? 0 : 1) << i << ": " << to_text(rays[i]);
        ASSERT_EQ(accel.occluded(rays[i]), !every.empty()) << i << ": " << to_text(rays[i]);
        found += every.empty() ? 0 : 1;
    }
    EXPECT_GT(found, rays.size() / 10);
    EXPECT_LT(found, rays.size());
}

TEST_P(AccelCones, GrazedFromWithinAndAlong) {
    for (const float size : {1.0f, 1e-12f, 1e-5f, 1e7f}) {
        for (const bool capped : {false, true}) {
            for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
                if (size != 1.0f && sides != Sides::both) continue;
                SCOPED_TRACE(size);
                const std::vector<Twig> all = twigs(size);
                Scene scene;
                const SetId set = add_cone_set(scene, make_cone_set("twigs", ends_of(all), capped));
                place(scene, ConeSetInstance{set});
                scene.objects[0].sides = sides;
                expect_the_same(scene, rays_at(all, static_cast<double>(size)));
                if (HasFatalFailure()) return;
            }
        }
    }
}

// The same cones, stretched and in a space of their own: rays are rounded on their way there.
TEST_P(AccelCones, OfInstances) {
    for (const double k : {1e-14, 1e-6, 1.0, 1e5}) {
        SCOPED_TRACE(k);
        const auto size = static_cast<float>(1.0 / k);
        Scene scene;
        const SetId set =
            add_cone_set(scene, make_cone_set("twigs", ends_of(twigs(size)), k == 1.0));
        place(scene, ConeSetInstance{set}, kNoMaterial, scale(glm::dvec3(k)));
        place(scene, ConeSetInstance{set}, kNoMaterial,
              translate({2, 0, 0}) * rotate(40.0, {1, 2, 3}) *
                  scale(glm::dvec3(k) * glm::dvec3(1.0, -0.5, 1.5)));
        expect_the_same(scene, rays_at(twigs(1.0f), 1.0));
        if (HasFatalFailure()) return;
    }
}

RAYPICK_ON_EACH_INSTRUCTION_SET(AccelCones);

}  // namespace
}  // namespace raypick
