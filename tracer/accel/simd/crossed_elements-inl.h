// Where rays cross clear triangles, and spheres and cones of sets, several at once: the same hits
// as by trace_primitive, to the bit. Included once for each instruction set.
#if defined(RAYPICK_CROSSED_ELEMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_CROSSED_ELEMENTS_INL_H
#undef RAYPICK_CROSSED_ELEMENTS_INL_H
#else
#define RAYPICK_CROSSED_ELEMENTS_INL_H
#endif

#include "tracer/accel/passage.h"
#include "tracer/accel/simd/decide_cones-inl.h"
#include "tracer/accel/simd/decide_spheres-inl.h"
#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/group_crossings-inl.h"
#include "tracer/accel/simd/sole_elements-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// What all of it is about.
struct CrossingWork {
    const AccelState& state;
    std::span<const Ray> rays;
    const RayQuery& query;
    CrossingsOfGroup& search;

    // A hit at t, if it is on the ray's way and on a side that counts.
    HWY_INLINE void offer(std::size_t ray, const Object& object, const Hit& hit) const {
        if (!(hit.t > rays[ray].t_min && hit.t < rays[ray].t_max)) return;
        if (!shows(object.sides, hit.front_face) || !shows(query.sides, hit.front_face)) return;
        search.hits.push_back({static_cast<std::uint32_t>(ray), hit});
    }

    void by_scalar(std::size_t ray, std::uint32_t object, std::uint32_t primitive) const {
        CrossingsOfOne one{search, ray};
        trace_primitive(state, object, primitive, rays[ray], query, one);
    }
};

// Rays with an element each. `Set` is the objects' shape; see SoleElements for the others.
template <typename Set, typename Pairs, typename Decided>
class CrossedElements {
public:
    explicit CrossedElements(const CrossingWork& work) : work_(work) {}

    // False if this isn't for it.
    bool take(const PerhapsCrossed& perhaps) {
        const Instance& instance = work_.state.instances[perhaps.object];
        const Scene& scene = *work_.state.scene;
        const auto* set = std::get_if<Set>(&scene.objects[perhaps.object].shape);
        if (set == nullptr || instance.holes) return false;
        const auto element = element_of(scene, *set, perhaps.primitive);
        each_ray(perhaps.rays, [&](std::size_t ray) HWY_ATTR {
            pairs_.set(count_, object_ray(instance, work_.rays[ray]), element);
            lanes_[count_++] = {static_cast<std::uint32_t>(ray), perhaps.object, perhaps.primitive};
            if (count_ == kDoublesAtOnce) decide();
        });
        return true;
    }

    void decide() {
        if (count_ == 0) return;
        pairs_.fill_from(count_);
        const Decided decided(pairs_);
        typename Decided::Hits enters;
        typename Decided::Hits leaves;
        decided.sides_at(0, decided.ordinary, enters);
        decided.sides_at(~0u, decided.ordinary, leaves);
        if (work_.query.uv) {
            decided.uv_at(0, enters);
            decided.uv_at(~0u, leaves);
        }
        const std::uint32_t known = decided.ordinary & decided.enters_by_side &
                                    decided.leaves_by_side & enters.ordinary & leaves.ordinary;
        for (std::size_t lane = 0; lane < count_; ++lane) {
            if (((decided.misses >> lane) & 1) != 0) continue;
            if (((known >> lane) & 1) == 0) {
                work_.by_scalar(lanes_[lane].ray, lanes_[lane].object, lanes_[lane].primitive);
                continue;
            }
            offer(lane, decided.enters_at[lane], enters);
            offer(lane, decided.leaves_at[lane], leaves);
        }
        count_ = 0;
    }

private:
    HWY_INLINE void offer(std::size_t lane, double t, const typename Decided::Hits& hits) const {
        const Object& object = work_.state.scene->objects[lanes_[lane].object];
        work_.offer(lanes_[lane].ray, object,
                    {object.id, lanes_[lane].primitive, static_cast<float>(t),
                     work_.query.uv ? glm::vec2(hits.uv(lane)) : glm::vec2(0.0f),
                     ((hits.front >> lane) & 1) != 0});
    }

    const CrossingWork& work_;
    Pairs pairs_;
    std::array<RayAndPrimitive, kDoublesAtOnce> lanes_;
    std::size_t count_ = 0;
};

using CrossedSpheres = CrossedElements<SphereSetInstance, SpherePairs, SpheresDecided>;
using CrossedCones = CrossedElements<ConeSetInstance, ConePairs, ConesDecided>;

// The same of triangles.
class CrossedTriangles {
public:
    explicit CrossedTriangles(const CrossingWork& work) : work_(work) {}

    bool take(const PerhapsCrossed& perhaps) {
        const Scene& scene = *work_.state.scene;
        const Instance& instance = work_.state.instances[perhaps.object];
        const auto* placed = std::get_if<MeshInstance>(&scene.objects[perhaps.object].shape);
        if (placed == nullptr || instance.holes) return false;
        const Mesh& mesh = scene.meshes[placed->mesh];
        const glm::uvec3 corner = mesh.triangles[perhaps.primitive];
        const glm::vec3& a = mesh.positions[corner.x];
        const glm::vec3& b = mesh.positions[corner.y];
        const glm::vec3& c = mesh.positions[corner.z];
        if (!has_area(a, b, c)) return true;
        each_ray(perhaps.rays, [&](std::size_t ray) HWY_ATTR {
            set_ray(instance, work_.rays[ray], count_, pairs_);
            pairs_.set_corners(count_, a, b, c);
            lanes_[count_++] = {static_cast<std::uint32_t>(ray), perhaps.object, perhaps.primitive};
            if (count_ == kDoublesAtOnce) decide();
        });
        return true;
    }

    void decide() {
        if (count_ == 0) return;
        pairs_.fill_from(count_);
        HWY_NAMESPACE::decide(TriangleColumns(pairs_), answers_);
        for (std::size_t lane = 0; lane < count_; ++lane) {
            if (((answers_.hit >> lane) & 1) == 0) continue;
            const Object& object = work_.state.scene->objects[lanes_[lane].object];
            work_.offer(lanes_[lane].ray, object,
                        {object.id, lanes_[lane].primitive, answers_.t[lane],
                         glm::vec2(answers_.u[lane], answers_.v[lane]), answers_.hits_front(lane)});
        }
        count_ = 0;
    }

private:
    const CrossingWork& work_;
    TrianglePairs pairs_;
    TriangleAnswers answers_;
    std::array<RayAndPrimitive, kDoublesAtOnce> lanes_;
    std::size_t count_ = 0;
};

// Decides what perhaps is crossed by rays that aren't blocked, and forgets it.
inline void decide_crossed(const CrossingWork& work) {
    CrossedSpheres spheres(work);
    CrossedCones cones(work);
    CrossedTriangles triangles(work);
    for (PerhapsCrossed& perhaps : work.search.perhaps) {
        perhaps.rays &= ~work.search.blocked;
        if (spheres.take(perhaps) || cones.take(perhaps) || triangles.take(perhaps)) continue;
        each_ray(perhaps.rays, [&](std::size_t ray) HWY_ATTR {
            work.by_scalar(ray, perhaps.object, perhaps.primitive);
        });
    }
    spheres.decide();
    cones.decide();
    triangles.decide();
    work.search.perhaps.clear();
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
