// Our hits against those of Intel's Embree 3 (robust mode) on real models, a million seeded rays
// each. Every difference must be explained, or the test fails:
//   equal     both miss, or t within 1e-4 relative
//   rounding  the same triangle at a grazing angle: the two points lie within float rounding of
//             the coordinates of each other, measured across the surface
//   edge      the ray passes the rim of the nearer surface: among rays of ours shifted by at most
//             1e-5 of the scene's size, some see what we saw and some see what Embree saw. A ray
//             that slipped between two triangles would not pass this test: all of its neighbours
//             see the surface.
//   cap       the ray is parallel to the axis of a cone and meets a cap of it, which Embree now and
//             then does not see: our hit is on that cap by the formula, in double
#include "tests/needs.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/surface.h"
#include "tracer/io/load.h"
#include "tracer/parallel/parallel.h"

#include <gtest/gtest.h>

#ifdef RAYPICK_HAS_EMBREE
#include <embree3/rtcore.h>

#include <array>
#include <atomic>
#include <cmath>
#include <iostream>
#include <mutex>

namespace raypick {
namespace {

constexpr std::size_t kRays = 1'000'000;

struct EmbreeHit {
    float t = std::numeric_limits<float>::infinity();  // infinite: a miss
    std::uint32_t object = 0;                          // index into scene.objects
    std::uint32_t primitive = 0;
};

// Every object of a scene as one Embree geometry, flattened to world-space floats.
class EmbreeScene {
public:
    explicit EmbreeScene(const Scene& scene)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
            attach(scene, i);
        rtcCommitScene(scene_);
        EXPECT_EQ(rtcGetDeviceError(device_), RTC_ERROR_NONE);
    }
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    [[nodiscard]] EmbreeHit intersect(const Ray& ray) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query{};
        query.ray.org_x = ray.origin.x;
        query.ray.org_y = ray.origin.y;
        query.ray.org_z = ray.origin.z;
        query.ray.dir_x = ray.direction.x;
        query.ray.dir_y = ray.direction.y;
        query.ray.dir_z = ray.direction.z;
        query.ray.tnear = ray.t_min;
        query.ray.tfar = ray.t_max;
        query.ray.mask = 0xffffffffu;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
        return {query.ray.tfar, query.hit.geomID, query.hit.primID};
    }

private:
    void attach(const Scene& scene, std::uint32_t index) {
        const Object& object = scene.objects[index];
        if (const auto* sphere = std::get_if<Sphere>(&object.shape)) {
            attach_sphere(*sphere, index);
        } else if (const auto* instance = std::get_if<MeshInstance>(&object.shape)) {
            attach_mesh(scene.meshes[instance->mesh], object.world_from_object, index);
        } else if (const auto* spheres = std::get_if<SphereSetInstance>(&object.shape)) {
            expect_unscaled(object);
            attach_spheres(scene.sphere_sets[spheres->set].spheres, object.world_from_object,
                           index);
        } else if (const auto* cones = std::get_if<ConeSetInstance>(&object.shape)) {
            expect_unscaled(object);
            attach_cones(scene.cone_sets[cones->set], object.world_from_object, index);
        } else {
            ADD_FAILURE() << "object " << index << " is of a kind that this test can't compare";
        }
    }

    void attach_mesh(const Mesh& mesh, const Transform& world_from_object, std::uint32_t index) {
        if (mesh.triangles.empty()) return;
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* corner = static_cast<glm::vec3*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(glm::vec3), mesh.positions.size()));
        for (const glm::vec3& p : mesh.positions) {
            *corner++ = glm::vec3(world_from_object.point(glm::dvec3(p)));
        }
        auto* triangle = static_cast<glm::uvec3*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(glm::uvec3), mesh.triangles.size()));
        std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangle);
        finish(geometry, index);
    }

    // Radii stay what they are.
    static void expect_unscaled(const Object& object) {
        EXPECT_EQ(object.world_from_object.linear, glm::dmat3(1.0));
    }

    // Centres and radii in world space.
    static void set_balls(RTCGeometry geometry, std::span<const glm::vec4> balls,
                          const Transform& world_from_object) {
        auto* ball = static_cast<glm::vec4*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                    sizeof(glm::vec4), balls.size()));
        for (const glm::vec4& b : balls) {
            const glm::dvec3 centre = world_from_object.point(glm::dvec3(b));
            *ball++ = glm::vec4(glm::vec3(centre), b.w);
        }
    }

    void attach_sphere(const Sphere& sphere, std::uint32_t index) {
        const glm::vec4 ball(glm::dvec4(sphere.centre, sphere.radius));
        attach_spheres({&ball, 1}, {}, index);
    }

    void attach_spheres(std::span<const glm::vec4> spheres, const Transform& world_from_object,
                        std::uint32_t index) {
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        set_balls(geometry, spheres, world_from_object);
        finish(geometry, index);
    }

    // Each cone a curve of its own, which Embree closes at both ends.
    void attach_cones(const ConeSet& set, const Transform& world_from_object, std::uint32_t index) {
        EXPECT_TRUE(set.capped) << "Embree has no open cones";
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE);
        set_balls(geometry, set.ends, world_from_object);
        auto* first = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                                    sizeof(std::uint32_t), set.size()));
        for (std::uint32_t i = 0; i < set.size(); ++i)
            *first++ = 2 * i;
        finish(geometry, index);
    }

    void finish(RTCGeometry geometry, std::uint32_t index) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene_, geometry, index);
        rtcReleaseGeometry(geometry);
    }

    RTCDevice device_;
    RTCScene scene_;
};

enum Verdict { equal, rounding, edge, cap, unexplained };
constexpr std::size_t kVerdicts = 5;

class Comparison {
public:
    explicit Comparison(const Accel& accel)
        : accel_(accel),
          embree_(accel.scene()),
          size_(static_cast<double>(glm::length(accel.bounds().extent()))) {}

    Verdict judge(const Ray& ray) const {
        const std::optional<Hit> ours = accel_.intersect(ray);
        const EmbreeHit theirs = embree_.intersect(ray);
        const double a = ours ? static_cast<double>(ours->t) : kMiss;
        const auto b = static_cast<double>(theirs.t);
        if (a == b || std::abs(a - b) <= 1e-4 * std::min(a, b)) return equal;
        if (ours && std::isfinite(b) && only_rounding(ray, *ours, theirs)) return rounding;
        if (ours && a < b && on_a_cap_along(ray, *ours)) return cap;
        if (on_an_edge(ray, std::min(a, b), std::max(a, b))) return edge;
        const std::lock_guard lock(one_at_a_time_);
        std::cout << "unexplained: " << to_text(ray) << "\n  ours " << to_text(ours)
                  << "\n  Embree t " << theirs.t << " object " << theirs.object << " primitive "
                  << theirs.primitive << '\n';
        return unexplained;
    }

    [[nodiscard]] bool hits(const Ray& ray) const { return accel_.occluded(ray); }

private:
    static constexpr double kMiss = std::numeric_limits<double>::infinity();

    bool only_rounding(const Ray& ray, const Hit& ours, const EmbreeHit& theirs) const {
        const Scene& scene = accel_.scene();
        if (object_index(scene, ours.object) != theirs.object) return false;
        if (ours.primitive != theirs.primitive) return false;
        const glm::vec3 normal = surface_point(scene, ray, ours).geometric_normal;
        const double across = std::abs(static_cast<double>(glm::dot(normal, ray.direction)));
        const double reach = size_ + static_cast<double>(glm::length(ray.origin));
        return std::abs(static_cast<double>(ours.t - theirs.t)) * across <= 4.0 * 0x1p-24 * reach;
    }

    bool on_a_cap_along(const Ray& ray, const Hit& hit) const {
        const Scene& scene = accel_.scene();
        const Object& object = scene.objects[object_index(scene, hit.object)];
        const auto* instance = std::get_if<ConeSetInstance>(&object.shape);
        if (instance == nullptr) return false;
        const Cone cone = cone_of(scene.cone_sets[instance->set], hit.primitive);
        const glm::dvec3 axis = glm::normalize(cone.apex - cone.base);
        const glm::dvec3 d(ray.direction);
        if (glm::length(glm::cross(axis, d)) > 1e-6) return false;
        const glm::dvec3 at = glm::dvec3(ray.origin) + static_cast<double>(hit.t) * d;
        const auto is_on = [&](const glm::dvec3& centre, double radius) {
            const glm::dvec3 from_centre = at - object.world_from_object.point(centre);
            const double height = glm::dot(from_centre, axis);
            return std::abs(height) <= 1e-6 * size_ &&
                   glm::length(from_centre - height * axis) <= radius;
        };
        return is_on(cone.base, cone.base_radius) || is_on(cone.apex, cone.apex_radius);
    }

    bool on_an_edge(const Ray& ray, double near_t, double far_t) const {
        const double parting = std::isinf(far_t) ? 1.5 * near_t : 0.5 * (near_t + far_t);
        for (const double shift : {1e-7, 1e-6, 1e-5}) {
            Random random(1);
            int near_ones = 0;
            int far_ones = 0;
            for (int i = 0; i < 64; ++i) {
                Ray shifted = ray;
                shifted.origin += glm::vec3(shift * size_ * random.direction());
                const glm::dvec3 aim = glm::dvec3(ray.at(static_cast<float>(near_t))) +
                                       shift * size_ * random.direction();
                shifted.direction = ray_towards(shifted.origin, aim).direction;
                const std::optional<Hit> hit = accel_.intersect(shifted);
                const bool near_one = hit && static_cast<double>(hit->t) < parting;
                ++(near_one ? near_ones : far_ones);
            }
            if (near_ones > 0 && far_ones > 0) return true;
        }
        return false;
    }

    static std::string to_text(const Ray& ray) {
        std::ostringstream text;
        text << std::hexfloat << "origin " << ray.origin.x << ' ' << ray.origin.y << ' '
             << ray.origin.z << " direction " << ray.direction.x << ' ' << ray.direction.y << ' '
             << ray.direction.z;
        return text.str();
    }
    static std::string to_text(const std::optional<Hit>& hit) {
        if (!hit) return "miss";
        return "t " + std::to_string(hit->t) + " object " + std::to_string(hit->object) +
               " primitive " + std::to_string(hit->primitive);
    }

    const Accel& accel_;
    EmbreeScene embree_;
    double size_;
    mutable std::mutex one_at_a_time_;
};

// `rare`: at most one ray in so many may differ.
void compare(const Scene& scene, const std::string& name, std::size_t count,
             std::size_t rare = 2000) {
    constexpr std::size_t kBatch = 1000;
    const Accel accel = accel_of(scene);
    const Comparison comparison(accel);
    const std::vector<Ray> rays = rays_through(accel.bounds(), 7, count);
    std::array<std::atomic<int>, kVerdicts> verdicts{};
    std::atomic<int> hits{0};
    parallel_for(count / kBatch, 0, {}, [&](std::size_t batch) {
        for (std::size_t i = batch * kBatch; i < (batch + 1) * kBatch; ++i) {
            ++verdicts[comparison.judge(rays[i])];
            hits += comparison.hits(rays[i]) ? 1 : 0;
        }
    });
    std::cout << name << ": " << count << " rays, " << hits << " hits; equal " << verdicts[equal]
              << ", rounding " << verdicts[rounding] << ", edge " << verdicts[edge] << ", cap "
              << verdicts[cap] << ", unexplained " << verdicts[unexplained] << '\n';
    EXPECT_EQ(verdicts[unexplained], 0);
    EXPECT_LE(verdicts[rounding] + verdicts[edge] + verdicts[cap], static_cast<int>(count / rare))
        << "differences should be rare";
    EXPECT_GT(hits, static_cast<int>(count / 4)) << "the rays don't test much";
}

TEST(EmbreeOracle, Bunny) {
    RAYPICK_REQUIRE_MODEL("stanford/bunny_binary.ply");
    compare(load_scene(model("stanford/bunny_binary.ply")).scene, "bunny", kRays);
}

TEST(EmbreeOracle, Sponza) {
    RAYPICK_REQUIRE_MODEL("sponza/sponza.obj");
    compare(load_scene(model("sponza/sponza.obj")).scene, "sponza", kRays);
}

TEST(EmbreeOracle, Kitchen) {
    RAYPICK_REQUIRE_MODEL("bitterli/kitchen.glb");
    // Embree gets no textures: leaves are whole in both.
    Scene scene = load_scene(model("bitterli/kitchen.glb")).scene;
    for (Material& m : scene.materials) {
        m.opacity = 1.0f;
        m.map(MapSlot::opacity) = {};
    }
    compare(scene, "kitchen", kRays);
}

TEST(EmbreeOracle, Spheres) {
    Random random(11);
    Scene scene;
    for (int i = 0; i < 500; ++i) {
        // Floats, so that both see the same spheres.
        const glm::vec3 centre(10.0 * random.direction() * random.unit());
        const auto radius = static_cast<float>(random.between(0.05, 1.0));
        place(scene, Sphere{glm::dvec3(centre), static_cast<double>(radius)});
    }
    compare(scene, "spheres", 200'000);
}

// The sets of an NFF file as Embree sees them: both sides, and cones closed.
Scene sets_of(const std::filesystem::path& file) {
    Scene scene = load_scene(file).scene;
    std::erase_if(scene.objects, [](const Object& object) {
        return std::holds_alternative<MeshInstance>(object.shape);
    });
    for (Object& object : scene.objects)
        object.sides = Sides::both;
    for (ConeSet& set : scene.cone_sets)
        set.capped = true;
    return scene;
}

TEST(EmbreeOracle, Balls) {
    RAYPICK_REQUIRE_MODEL("spd/balls.nff");
    compare(sets_of(model("spd/balls.nff")), "balls", kRays);
}

// Rays from inside of thin cylinders far from zero, where Embree's floats round most.
TEST(EmbreeOracle, Rings) {
    RAYPICK_REQUIRE_MODEL("spd/rings.nff");
    compare(sets_of(model("spd/rings.nff")), "rings", kRays, 1000);
}

// Of all shapes, some with a tip. Open cones, tori, disks: see curved_shapes_test.
TEST(EmbreeOracle, ConeSet) {
    Random random(12);
    std::vector<glm::vec4> ends;
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 base = 10.0 * random.direction() * random.unit();
        const glm::dvec3 apex = base + random.between(0.2, 2.0) * random.direction();
        ends.emplace_back(glm::vec3(base), random.between(0.1, 0.6));
        ends.emplace_back(glm::vec3(apex), i % 5 == 0 ? 0.0 : random.between(0.1, 0.6));
    }
    Scene scene;
    place(scene, ConeSetInstance{add_cone_set(scene, make_cone_set("", std::move(ends), true))});
    compare(scene, "cones", 200'000);
}

}  // namespace
}  // namespace raypick

#else

TEST(EmbreeOracle, IsNotBuilt) {
    RAYPICK_REQUIRE(false, "Embree 3 is not installed: .ci/bootstrap --oracle");
}

#endif
