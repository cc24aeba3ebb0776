// What a group's rays cross of things that let light through. Included once for each instruction
// set.
#if defined(RAYPICK_GROUP_CROSSINGS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_CROSSINGS_INL_H
#undef RAYPICK_GROUP_CROSSINGS_INL_H
#else
#define RAYPICK_GROUP_CROSSINGS_INL_H
#endif

#include "tracer/accel/crossings.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"

#include <cstddef>
#include <cstdint>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// A clear primitive, and the rays that may hit it.
struct PerhapsCrossed {
    std::uint32_t object;  // index
    std::uint32_t primitive;
    RayMask rays;
};

struct CrossedHit {
    std::uint32_t ray;
    Hit hit;
};

// Rays that are blocked by what is not clear, and go on through what is. That never makes a ray
// shorter, so that a primitive turns up once for each ray.
struct CrossingsOfGroup : AnyOfGroup {
    const Scene& scene;
    const Clearness& clear;
    std::vector<PerhapsCrossed>& perhaps;
    std::vector<CrossedHit>& hits;  // those that the scalar code found, of blocked rays as well

    CrossingsOfGroup(const Scene& of, const Clearness& what, std::vector<PerhapsCrossed>& some,
                     std::vector<CrossedHit>& found)
        : scene(of), clear(what), perhaps(some), hits(found) {}
};

HWY_INLINE bool crossed(CrossingsOfGroup& group, std::uint32_t object, std::uint32_t primitive,
                        RayMask rays) {
    if (!is_clear(group.scene, group.clear, object, primitive)) return false;
    group.perhaps.push_back({object, primitive, rays});
    return true;
}

// One ray of a group as the single-ray code searches for it.
struct CrossingsOfOne {
    CrossingsOfGroup& group;
    std::size_t ray;

    [[nodiscard]] float limit() const { return group.limits.t_far[ray]; }
    bool offer(const Hit& hit) {
        const std::size_t object = object_index(group.scene, hit.object);
        if (is_clear(group.scene, group.clear, object, hit.primitive)) {
            group.hits.push_back({static_cast<std::uint32_t>(ray), hit});
            return false;
        }
        group.block(RayMask{1} << ray);
        return true;
    }
};

inline CrossingsOfOne one_of(CrossingsOfGroup& group, std::size_t ray, std::uint32_t /*object*/) {
    return {group, ray};
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
