// Ray counts of the Standard Procedural Databases against two published tables:
//   Eric Haines, SPD Readme.txt, "Database Analysis";
//   Havran, Sixta, statistics on grids (SPD docs/havran_stats_grids.txt), 1999.
// Rules behind them: 513 x 513 eye rays through the corners of a 512 x 512 image, depth 5, no
// cut-off by contribution, every hit on a reflective or transmitting surface reflects.
//
// The two differ in which normal may not point away from the light where a ray meets a surface from
// within: of glass, or of the teapot. Haines's numbers and ours are those of the normal on the
// ray's side: such a point is lit from within, and the glass around it, which blocks light like
// anything else, is in the way. Havran's are those of the outward normal: the point is lit as if
// seen from outside. Both are counted here.
#include "tests/model_files.h"
#include "tests/needs.h"
#include "tests/spd_scenes.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/surface.h"
#include "tracer/io/load.h"
#include "tracer/parallel/parallel.h"
#include "tracer/render/render_job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace raypick {
namespace {

constexpr ImageSize kSize{512, 512};
constexpr int kDepth = 5;

struct Published {
    const char* scene;
    bool glass;
    // Of each kind the number of Haines and that of Havran.
    std::array<double, 2> eye_hits, secondary, shadow;
    double shadow_blocked;       // Havran's only
    double blocked_gate = 0.02;  // of ours, in opaque scenes
    double outward_gate = 0.0;   // of those by the outward normal, where that is another
};

constexpr std::array<Published, 8> kPublished{{
    {"balls", false, {263169, 263169}, {175095, 179884}, {954368, 959244}, 285178},
    // Havran has a quarter more blocked than his rule gives here: about as many as if each face
    // blocked what leaves it from within.
    {"gears", true, {245086, 245332}, {512207, 494338}, {2246955, 2088012}, 1057557, 0.0, 0.25},
    {"lattice", false, {261170, 261170}, {243210, 243210}, {1180774, 1180774}, 943159},
    {"mount", true, {173125, 173685}, {709538, 710436}, {412922, 361037}, 74555, 0.0, 0.05},
    {"rings", false, {263169, 263169}, {315236, 312879}, {1085002, 1077336}, 510719},
    {"teapot", false, {161120, 161546}, {225248, 226235}, {407656, 406340}, 34757, 0.12, 0.03},
    {"tetra", false, {49788, 49950}, {0, 0}, {46112, 46262}, 5538},
    // Havran has 1.2 % more shadow rays than Haines and we, and a tenth more blocked ones.
    {"tree", false, {169836, 169907}, {0, 0}, {1097419, 1110323}, 47506, 0.1},
}};

const std::map<std::string, std::string (*)()> kMadeHere{
    {"gears", spd_gears}, {"lattice", spd_lattice}, {"teapot", spd_teapot}, {"tree", spd_tree}};

// A model, or a scene that is made here.
class SpdOracle : public ModelFiles {
protected:
    static bool has_scene(const std::string& name) {
        return is_made_here(name) || std::filesystem::exists(model("spd/" + name + ".nff"));
    }
    std::shared_ptr<const Accel> accel_of_scene(const std::string& name) {
        const auto made = kMadeHere.find(name);
        LoadedScene loaded = made == kMadeHere.end() ? load_scene(model("spd/" + name + ".nff"))
                                                     : load(name + ".nff", made->second());
        return std::make_shared<const Accel>(
            std::make_shared<const Scene>(std::move(loaded.scene)));
    }

    static bool is_made_here(const std::string& name) { return kMadeHere.contains(name); }

    RayCounts traced(const std::string& name) {
        const auto accel = accel_of_scene(name);
        RenderSettings settings;
        settings.sampling = Sampling::corners;
        settings.depth = kDepth;
        settings.cutoff = 0.0f;
        const RenderedFrame frame =
            render(accel, choose_camera(accel->scene(), kSize, {}), kSize, settings);
        EXPECT_EQ(frame.nan_pixels, 0u);
        return frame.rays;
    }
};

class SpdTable : public SpdOracle, public testing::WithParamInterface<Published> {};
class SpdRules : public SpdTable {};

// How far a count is from the nearer of two published ones, as a fraction.
double deviation(double count, const std::array<double, 2>& published) {
    double least = 1e9;
    for (const double value : published) {
        if (count == value) return 0.0;
        least = std::min(least, std::abs(count - value) / value);
    }
    return least;
}

// Shadow rays by Havran's rule.
struct OutwardCounts {
    std::atomic<std::uint64_t> shadow{0};
    std::atomic<std::uint64_t> blocked{0};
};

// The rays of a whole tree, counted apart from the tracer's shading.
class OutwardCounter {
public:
    OutwardCounter(const Accel& accel, OutwardCounts& counts) : accel_(accel), counts_(counts) {}

    void follow(const Ray& ray, int depth) {
        const std::optional<Hit> hit = accel_.intersect(ray);
        if (!hit) return;
        const SurfacePoint point = surface_point(accel_.scene(), ray, *hit);
        for (const Light& light : accel_.scene().lights)
            look_at(std::get<PointLight>(light), point);
        const Material& kind = material(accel_.scene(), point.material);
        if (depth == kDepth || !(kind.reflects() || kind.transmits())) return;
        const glm::dvec3 d(ray.direction);
        const glm::dvec3 n = (point.front_face ? 1.0 : -1.0) * glm::dvec3(point.shading_normal);
        leave(point, d - 2.0 * glm::dot(d, n) * n, depth);
        if (!kind.transmits()) return;
        const auto ior = static_cast<double>(kind.ior);
        const double eta = point.front_face ? 1.0 / ior : ior;
        const double cosine = -glm::dot(d, n);
        const double squared = 1.0 - eta * eta * (1.0 - cosine * cosine);
        if (squared >= 0.0) leave(point, eta * d + (eta * cosine - std::sqrt(squared)) * n, depth);
    }

private:
    void leave(const SurfacePoint& point, const glm::dvec3& direction, int depth) {
        Ray ray;
        ray.direction = glm::vec3(glm::normalize(direction));
        ray.origin = offset_origin(point, ray.direction);
        follow(ray, depth + 1);
    }

    void look_at(const PointLight& light, const SurfacePoint& point) {
        Ray ray = ray_towards(point.position, light.position);
        if (!(glm::dot(point.geometric_normal, ray.direction) > 0.0f)) return;
        ++counts_.shadow;
        ray.origin = offset_origin(point, ray.direction);
        ray.t_max = glm::distance(ray.origin, glm::vec3(light.position)) * 0.9999f;
        if (accel_.occluded(ray)) ++counts_.blocked;
    }

    const Accel& accel_;
    OutwardCounts& counts_;
};

// The gates are how far the two tables are apart.
TEST_P(SpdTable, CountsAgreeWithThePublishedOnes) {
    const Published& published = GetParam();
    RAYPICK_REQUIRE(has_scene(published.scene), "SPD scenes are not there");
    const RayCounts rays = traced(published.scene);
    const auto eye_hits = static_cast<double>(rays.eye_hits);
    const auto secondary = static_cast<double>(rays.reflection + rays.refraction);
    const auto shadow = static_cast<double>(rays.shadow);
    EXPECT_EQ(rays.eye, 263169u);
    EXPECT_LE(deviation(eye_hits, published.eye_hits), 0.005) << eye_hits;
    EXPECT_LE(deviation(secondary, published.secondary), 0.04) << secondary;
    EXPECT_LE(deviation(shadow, published.shadow), published.glass ? 0.13 : 0.02) << shadow;
    if (!published.glass) {
        const auto blocked = static_cast<double>(rays.shadow_blocked);
        EXPECT_LE(std::abs(blocked / published.shadow_blocked - 1.0), published.blocked_gate)
            << blocked;
    }
    RecordProperty("eye_hits", std::to_string(rays.eye_hits));
    RecordProperty("reflection", std::to_string(rays.reflection));
    RecordProperty("refraction", std::to_string(rays.refraction));
    RecordProperty("shadow", std::to_string(rays.shadow));
    RecordProperty("shadow_blocked", std::to_string(rays.shadow_blocked));
}

// By its own rule each table is met closer than by the gates above.
TEST_P(SpdRules, EachTableIsMetByItsOwnRule) {
    const Published& published = GetParam();
    RAYPICK_REQUIRE(has_scene(published.scene), "SPD scenes are not there");
    const auto shadow = static_cast<double>(traced(published.scene).shadow);
    EXPECT_NEAR(shadow / published.shadow[0], 1.0, 0.01) << "Haines";
    const auto accel = accel_of_scene(published.scene);
    const RayGenerator rays(choose_camera(accel->scene(), kSize, {}), kSize);
    OutwardCounts counts;
    parallel_for(static_cast<std::size_t>(kSize.rows) + 1, 0, {}, [&](std::size_t row) {
        OutwardCounter counter(*accel, counts);
        for (int col = 0; col <= kSize.cols; ++col) {
            const ImagePoint corner{static_cast<double>(row), static_cast<double>(col)};
            counter.follow(rays.ray(corner), 1);
        }
    });
    EXPECT_NEAR(static_cast<double>(counts.shadow) / published.shadow[1], 1.0, 0.02)
        << counts.shadow;
    EXPECT_NEAR(static_cast<double>(counts.blocked) / published.shadow_blocked, 1.0,
                published.outward_gate)
        << counts.blocked;
}

std::string name_of(const testing::TestParamInfo<Published>& test) {
    return test.param.scene;
}
INSTANTIATE_TEST_SUITE_P(, SpdTable, testing::ValuesIn(kPublished), name_of);
INSTANTIATE_TEST_SUITE_P(, SpdRules, testing::Values(kPublished[1], kPublished[3], kPublished[5]),
                         name_of);

TEST_F(SpdOracle, EveryEyeRayHitsInClosedScenes) {
    for (const std::string name : {"balls", "rings"}) {
        RAYPICK_REQUIRE_MODEL("spd/" + name + ".nff");
        EXPECT_EQ(traced(name).eye_hits, 263169u) << name;
    }
}

TEST_F(SpdOracle, GlassReflectsAsOftenAsItRefracts) {
    RAYPICK_REQUIRE_MODEL("spd/mount.nff");
    const RayCounts rays = traced("mount");
    EXPECT_EQ(rays.reflection, rays.refraction);
}

TEST_F(SpdOracle, NothingReflectsInTetra) {
    RAYPICK_REQUIRE_MODEL("spd/tetra.nff");
    const RayCounts rays = traced("tetra");
    EXPECT_EQ(rays.reflection, 0u);
    EXPECT_EQ(rays.refraction, 0u);
}

}  // namespace
}  // namespace raypick
