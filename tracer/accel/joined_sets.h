// Several sets of spheres and cones as if they were one: their elements are numbered through, the
// spheres first. A tree over all of them has what is near each other in one leaf, whosever it is.
#pragma once

#include "tracer/bvh/wide_bvh.h"
#include "tracer/geometry/bounds.h"
#include "tracer/parallel/large_array.h"
#include "tracer/scene/scene.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

namespace raypick {

// One of the sets, of either kind.
struct JoinableSet {
    const SphereSet* spheres = nullptr;
    const ConeSet* cones = nullptr;
    Bounds bounds;

    [[nodiscard]] std::size_t size() const {
        return spheres != nullptr ? spheres->spheres.size() : cones->size();
    }
    [[nodiscard]] Bounds element_bounds(std::size_t index) const;
};

class JoinedSets {
public:
    // Most elements there can be (WideBvh::kLast).
    static constexpr std::size_t kMostElements = (std::size_t{1} << 31) - 1;

    // Those of spheres first; they must outlive this. All cones are capped, or none.
    explicit JoinedSets(std::vector<JoinableSet> sets);

    [[nodiscard]] std::size_t elements() const { return first_.back(); }
    [[nodiscard]] std::size_t first_cone() const { return first_cone_; }
    [[nodiscard]] const JoinableSet& set(std::size_t member) const { return sets_[member]; }
    // The numbers of a member's elements are [first(member), first(member + 1)).
    [[nodiscard]] std::size_t first(std::size_t member) const { return first_[member]; }
    [[nodiscard]] std::size_t member_of(std::size_t element) const;

private:
    std::vector<JoinableSet> sets_;
    std::vector<std::size_t> first_;
    std::size_t first_cone_ = 0;
};

struct JoinedElement {
    std::uint32_t member;
    std::uint32_t primitive;  // of the member
};

// The elements in the order of the tree's indices, in each leaf spheres first, with copies of their
// numbers: what a ray needs of a leaf lies in one piece.
struct JoinedElements {
    LargeArray<JoinedElement> elements;
    LargeArray<glm::vec4> rows;    // `stride` for each: see leaf_elements.h
    std::size_t stride = 0;        // 0: there are none
    std::uint32_t first_cone = 0;  // of the tree's indices, these and those above
    bool capped = false;           // the cones

    [[nodiscard]] std::uint64_t bytes() const {
        return elements.size() * sizeof(JoinedElement) + rows.size() * sizeof(glm::vec4);
    }
};

// Sorts each leaf's indices, which are numbers of the sets' elements. The same for any number of
// threads. Throws Cancelled.
JoinedElements take_elements(WideBvh& bvh, const JoinedSets& sets, int threads,
                             const std::stop_token& stop);

// A leaf of such a tree.
struct JoinedLeaf {
    const JoinedElement* elements;
    const glm::vec4* rows;
    std::size_t spheres = 0;  // so many, then
    std::size_t cones = 0;    // so many
};

inline JoinedLeaf joined_leaf(const WideBvh& bvh, const JoinedElements& joined,
                              const WideRef& leaf) {
    const std::size_t first = leaf.index();
    JoinedLeaf found{joined.elements.data() + first, joined.rows.data() + joined.stride * first};
    for (std::size_t i = first;; ++i) {
        const std::uint32_t index = bvh.indices[i];
        const bool is_cone = (index & ~WideBvh::kLast) >= joined.first_cone;
        found.spheres += is_cone ? 0 : 1;
        found.cones += is_cone ? 1 : 0;
        if ((index & WideBvh::kLast) != 0) return found;
    }
}

}  // namespace raypick
