#include "tracer/accel/joined_sets.h"

#include "tracer/accel/element_box.h"
#include "tracer/accel/leaf_elements.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <span>

namespace raypick {

Bounds JoinableSet::element_bounds(std::size_t index) const {
    return spheres != nullptr ? element_box(*spheres, index) : element_box(*cones, index);
}

JoinedSets::JoinedSets(std::vector<JoinableSet> sets) : sets_(std::move(sets)) {
    std::size_t count = 0;
    for (const JoinableSet& set : sets_) {
        first_.push_back(count);
        count += set.size();
        if (set.spheres != nullptr) first_cone_ = count;
    }
    first_.push_back(count);
}

std::size_t JoinedSets::member_of(std::size_t element) const {
    const auto behind = std::upper_bound(first_.begin(), first_.end(), element);
    return static_cast<std::size_t>(behind - first_.begin()) - 1;
}

namespace {

// Of the leaf that index i is of, the index behind the last one.
std::size_t end_of_leaf(const WideBvh& bvh, std::size_t i) {
    while ((bvh.indices[i] & WideBvh::kLast) == 0)
        ++i;
    return i + 1;
}

// From a leaf's first index on those up to `end`, which is behind the last one of a leaf.
void sort_leaves(WideBvh& bvh, std::size_t first, std::size_t end) {
    while (first < end) {
        const std::size_t next = end_of_leaf(bvh, first);
        bvh.indices[next - 1] &= ~WideBvh::kLast;
        std::sort(&bvh.indices[first], &bvh.indices[next - 1] + 1);
        bvh.indices[next - 1] |= WideBvh::kLast;
        first = next;
    }
}

void take_element(const WideBvh& bvh, const JoinedSets& sets, std::size_t i,
                  JoinedElements& joined) {
    const std::size_t number = bvh.indices[i] & ~WideBvh::kLast;
    const std::size_t member = sets.member_of(number);
    const std::size_t primitive = number - sets.first(member);
    joined.elements[i] = {static_cast<std::uint32_t>(member),
                          static_cast<std::uint32_t>(primitive)};
    const JoinableSet& set = sets.set(member);
    const std::span<const glm::vec4> from =
        set.spheres != nullptr ? set.spheres->spheres.subspan(primitive, kSphereRows)
                               : set.cones->ends.subspan(kConeRows * primitive, kConeRows);
    glm::vec4* const rows = &joined.rows[joined.stride * i];
    std::fill_n(rows, joined.stride, glm::vec4(0.0f));
    std::copy(from.begin(), from.end(), rows);
}

}  // namespace

JoinedElements take_elements(WideBvh& bvh, const JoinedSets& sets, int threads,
                             const std::stop_token& stop) {
    const std::size_t count = bvh.indices.size();
    JoinedElements joined;
    const bool has_cones = sets.first_cone() < sets.elements();
    joined.stride = has_cones ? kConeRows : kSphereRows;
    joined.first_cone = static_cast<std::uint32_t>(sets.first_cone());
    joined.capped = has_cones && sets.set(sets.member_of(sets.first_cone())).cones->capped;
    joined.elements.resize(count);
    joined.rows.resize(joined.stride * count);
    constexpr std::size_t kChunk = 1u << 14;
    const auto begin_of = [&](std::size_t i) {  // the leaf that begins at i or next
        if (i == 0) return i;
        return i < count ? end_of_leaf(bvh, i - 1) : count;
    };
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < count; i += kChunk)
        begins.push_back(begin_of(i));
    begins.push_back(count);
    parallel_for(begins.size() - 1, threads, stop, [&](std::size_t chunk) {
        sort_leaves(bvh, begins[chunk], begins[chunk + 1]);
        for (std::size_t i = begins[chunk]; i < begins[chunk + 1]; ++i)
            take_element(bvh, sets, i, joined);
    });
    if (stop.stop_requested()) throw Cancelled();
    return joined;
}

}  // namespace raypick
