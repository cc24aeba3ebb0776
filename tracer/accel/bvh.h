// A bounding volume hierarchy over boxes: it knows boxes and indices, nothing else.
//
// Source: binned surface area heuristic after Wald, "On fast Construction of SAH-based Bounding
// Volume Hierarchies", 2007.
#pragma once

#include "tracer/geometry/bounds.h"

#include <glm/ext/vector_bool3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stop_token>
#include <vector>

namespace raypick {

// An inner node has its children at `first` and `first` + 1; a leaf holds
// indices[first .. first + count).
struct BvhNode {
    Bounds bounds;
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0: inner node

    [[nodiscard]] bool is_leaf() const { return count > 0; }
};

struct Bvh {
    static constexpr int kMaxDepth = 64;

    std::vector<BvhNode> nodes;          // nodes[0] is the root; empty if there are no boxes
    std::vector<std::uint32_t> indices;  // of the boxes given to build_bvh

    [[nodiscard]] std::uint64_t bytes() const {
        return nodes.size() * sizeof(BvhNode) + indices.size() * sizeof(std::uint32_t);
    }
};

// Boxes that are empty or not finite are left out. The tree is the same for any number of threads
// and at most kMaxDepth deep. Throws Cancelled.
Bvh build_bvh(std::span<const Bounds> boxes, int threads, const std::stop_token& stop);

// A ray as the slab tests see it. `slop` widens every box by an absolute amount, for rays that were
// rounded on their way into object space.
class SlabRay {
public:
    SlabRay(const glm::vec3& origin, const glm::vec3& direction, float slop) {
        for (int axis = 0; axis < 3; ++axis) {
            const float inverse = 1.0f / direction[axis];
            inverse_[axis] = inverse;
            negative_[axis] = std::signbit(inverse);
            near_origin_[axis] = origin[axis] + (negative_[axis] ? -slop : slop);
            far_origin_[axis] = origin[axis] - (negative_[axis] ? -slop : slop);
        }
    }

    // Where the ray enters the box, at the earliest; infinity if it surely misses it before
    // `t_max`. Conservative under rounding (Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013);
    // 0 * infinity counts as inside the slab.
    [[nodiscard]] float enter(const Bounds& box, float t_min, float t_max) const {
        float near = t_min;
        float far = t_max;
        for (int axis = 0; axis < 3; ++axis) {
            const float low = negative_[axis] ? box.max[axis] : box.min[axis];
            const float high = negative_[axis] ? box.min[axis] : box.max[axis];
            const float t0 = (low - near_origin_[axis]) * inverse_[axis] * kShrink;
            const float t1 = (high - far_origin_[axis]) * inverse_[axis];
            near = t0 > near ? t0 : near;
            const float padded = t1 * kGrow;
            far = padded < far ? padded : far;
        }
        return near <= far ? near : std::numeric_limits<float>::infinity();
    }

private:
    static constexpr float kGrow = 1.0f + 6.0f * 5.9604645e-8f;
    static constexpr float kShrink = 1.0f - 6.0f * 5.9604645e-8f;

    glm::vec3 inverse_{0.0f};
    glm::vec3 near_origin_{0.0f};
    glm::vec3 far_origin_{0.0f};
    glm::bvec3 negative_{false};
};

// Calls leaf(index) for the boxes that the ray may meet before limit(), near ones first; limit()
// may shrink on the way. Stops and returns true as soon as leaf() does.
template <typename Limit, typename Leaf>
bool traverse(const Bvh& bvh, const SlabRay& ray, float t_min, const Limit& limit,
              const Leaf& leaf) {
    struct Entry {
        std::uint32_t node;
        float enter;
    };
    if (bvh.nodes.empty()) return false;
    std::array<Entry, Bvh::kMaxDepth + 1> stack;
    int depth = 0;
    stack[0] = {0, ray.enter(bvh.nodes[0].bounds, t_min, limit())};
    depth = std::isinf(stack[0].enter) ? 0 : 1;
    while (depth > 0) {
        const Entry entry = stack[static_cast<std::size_t>(--depth)];
        if (!(entry.enter <= limit())) continue;
        const BvhNode* node = &bvh.nodes[entry.node];
        while (!node->is_leaf()) {
            const float t_max = limit();
            std::uint32_t near = node->first;
            std::uint32_t far = near + 1;
            float t_near = ray.enter(bvh.nodes[near].bounds, t_min, t_max);
            float t_far = ray.enter(bvh.nodes[far].bounds, t_min, t_max);
            if (t_far < t_near) {
                std::swap(near, far);
                std::swap(t_near, t_far);
            }
            if (std::isinf(t_near)) break;
            if (!std::isinf(t_far)) stack[static_cast<std::size_t>(depth++)] = {far, t_far};
            node = &bvh.nodes[near];
        }
        if (!node->is_leaf()) continue;
        for (std::uint32_t i = 0; i < node->count; ++i) {
            if (leaf(bvh.indices[node->first + i])) return true;
        }
    }
    return false;
}

}  // namespace raypick
