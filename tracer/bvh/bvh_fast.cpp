// A first tree: boxes that are neighbours along a space-filling curve make leaves, neighbouring
// leaves make treelets, and only the treelets are split by where they are.
//
// Source: Pantaleoni and Luebke, "HLBVH: Hierarchical LBVH Construction for Real-Time Ray Tracing
// of Dynamic Geometry", 2010.
#include "tracer/bvh/bvh.h"
#include "tracer/bvh/bvh_build.h"
#include "tracer/bvh/morton.h"
#include "tracer/bvh/treelet.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <utility>

namespace raypick {

namespace {

constexpr std::size_t kChunk = 1u << 13;
constexpr std::size_t kTreeletLeaves = 32;

// How far neighbours stand apart: a radix tree, which splits the codes bit by bit, splits between
// those first whose highest different bit is highest. Before the first and after the last there is
// a border; equal codes are told apart by nothing but their order, so that any cut will do.
std::uint32_t step_before(std::span<const MortonKey> keys, std::size_t i) {
    constexpr std::uint32_t kBorder = ~0u;
    if (i == 0 || i == keys.size()) return kBorder;
    return keys[i - 1].code ^ keys[i].code;
}

// The end of the largest subtree of a radix tree that begins at `begin` and holds at most `most`
// things; step(i) is the step before thing i.
template <typename Step>
std::size_t subtree_end(std::size_t begin, std::size_t last, const Step& step) {
    const std::uint32_t before = step(begin) != 0 ? step(begin) : ~0u;
    std::uint32_t inside = 0;  // the widest step so far
    std::size_t best = begin + 1;
    for (std::size_t end = begin + 1; end <= last; ++end) {
        const std::uint32_t after = step(end);
        if (inside < std::min(before, after)) best = end;
        inside = std::max(inside, after);
    }
    return inside == 0 ? last : best;
}

// Treelets and their roots, whose index is the treelet's number.
struct Forest {
    std::vector<BvhNode> nodes;         // one treelet after the other, places counted from its root
    std::vector<std::uint32_t> begins;  // of each treelet's nodes, and the end
    std::vector<BoxRef> roots;
    RefBounds bounds;
};

// From one chunk of keys.
class ForestBuilder {
public:
    ForestBuilder(std::span<MortonKey> keys, std::uint32_t first_key, std::uint32_t leaf_size)
        : keys_(keys), first_key_(first_key), leaf_size_(leaf_size) {}

    // Turns places into the indices of the boxes, while they are at hand.
    Forest build(std::span<const BoxRef> refs) {
        find_leaves(refs);
        forest_.nodes.reserve(2 * leaves_.size());
        const auto step = [this](std::size_t i) {
            return step_before(keys_,
                               i < leaves_.size() ? leaves_[i].first - first_key_ : keys_.size());
        };
        for (std::size_t begin = 0; begin < leaves_.size();) {
            const std::size_t last = std::min(leaves_.size(), begin + kTreeletLeaves);
            const std::size_t end = subtree_end(begin, last, step);
            add_treelet(std::span(leaves_).subspan(begin, end - begin));
            begin = end;
        }
        forest_.begins.push_back(static_cast<std::uint32_t>(forest_.nodes.size()));
        return std::move(forest_);
    }

private:
    void find_leaves(std::span<const BoxRef> refs) {
        leaves_.reserve(keys_.size() / 2);
        const auto step = [this](std::size_t i) { return step_before(keys_, i); };
        for (std::size_t begin = 0; begin < keys_.size();) {
            const std::size_t last = std::min<std::size_t>(keys_.size(), begin + leaf_size_);
            const std::size_t end = subtree_end(begin, last, step);
            fetch(refs, end);
            TreeletLeaf leaf;
            leaf.first = first_key_ + static_cast<std::uint32_t>(begin);
            leaf.count = static_cast<std::uint32_t>(end - begin);
            for (MortonKey& key : keys_.subspan(begin, end - begin)) {
                const BoxRef& ref = refs[key.place];
                leaf.box.extend(ref.box());
                key.place = ref.index();
            }
            leaves_.push_back(leaf);
            begin = end;
        }
    }

    // Refs lie in no order, so the processor is told which ones come after the next few leaves.
    void fetch(std::span<const BoxRef> refs, std::size_t begin) const {
        begin += 2 * leaf_size_;
        const std::size_t end = std::min<std::size_t>(keys_.size(), begin + leaf_size_);
        for (; begin < end; ++begin)
            __builtin_prefetch(&refs[keys_[begin].place]);
    }

    void add_treelet(std::span<const TreeletLeaf> leaves) {
        const std::size_t begin = forest_.nodes.size();
        forest_.begins.push_back(static_cast<std::uint32_t>(begin));
        append_treelet(forest_.nodes, leaves);
        forest_.roots.push_back(make_ref(forest_.nodes[begin].bounds, 0));
        forest_.bounds.extend(forest_.roots.back());
    }

    std::span<MortonKey> keys_;
    std::uint32_t first_key_;
    std::uint32_t leaf_size_;
    std::vector<TreeletLeaf> leaves_;
    Forest forest_;
};

std::vector<Forest> plant(std::span<const BoxRef> refs, std::span<MortonKey> keys,
                          const BvhOptions& options) {
    std::vector<Forest> forests((keys.size() + kChunk - 1) / kChunk);
    parallel_for(forests.size(), options.threads, options.stop, [&](std::size_t i) {
        const std::size_t begin = i * kChunk;
        ForestBuilder builder(keys.subspan(begin, std::min(kChunk, keys.size() - begin)),
                              static_cast<std::uint32_t>(begin),
                              std::min(options.costs.max_leaf, options.costs.block_size));
        forests[i] = builder.build(refs);
    });
    if (options.stop.stop_requested()) throw Cancelled();
    return forests;
}

// Where a treelet stands.
struct TreeletPlace {
    std::uint32_t forest = 0;
    std::uint32_t treelet = 0;
};

// The tree whose leaves are the treelets.
struct UpperTree {
    Bvh bvh;
    std::vector<TreeletPlace> places;  // by the indices of the tree's leaves
    std::size_t treelet_nodes = 0;
};

UpperTree join_roots(std::span<const Forest> forests, const BvhOptions& options) {
    UpperTree upper;
    std::size_t count = 0;
    for (const Forest& forest : forests)
        count += forest.roots.size();
    RefArray roots = allocate_refs(count);
    for (std::size_t i = 0; i < forests.size(); ++i) {
        for (std::size_t k = 0; k < forests[i].roots.size(); ++k) {
            const auto number = static_cast<std::uint32_t>(roots.count);
            roots.storage[roots.count++] = with_index(forests[i].roots[k], number);
            upper.places.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k)});
        }
        roots.bounds.extend(forests[i].bounds);
        upper.treelet_nodes += forests[i].nodes.size();
    }
    BvhOptions one_each = options;
    one_each.costs = {.node = 1.0f, .block = 1.0f, .block_size = 1, .min_leaf = 1, .max_leaf = 1};
    upper.bvh = build_over_refs(std::move(roots), one_each, kMaxSplitDepth - kMostTreeletDepth);
    return upper;
}

// Puts each treelet in place of the leaf that stands for it.
std::vector<BvhNode> open_treelets(const UpperTree& upper, std::span<const Forest> forests) {
    std::vector<BvhNode> nodes;
    nodes.reserve(upper.bvh.nodes.size() + upper.treelet_nodes - upper.places.size());
    nodes = upper.bvh.nodes;
    for (std::size_t i = 0; i < upper.bvh.nodes.size(); ++i) {
        if (!nodes[i].is_leaf()) continue;
        const TreeletPlace place = upper.places[upper.bvh.indices[nodes[i].first]];
        const Forest& forest = forests[place.forest];
        const std::uint32_t begin = forest.begins[place.treelet];
        const std::uint32_t end = forest.begins[place.treelet + 1];
        const auto offset = static_cast<std::uint32_t>(nodes.size()) - 1;
        const auto moved = [offset](BvhNode node) {
            if (!node.is_leaf()) node.first += offset;
            return node;
        };
        nodes[i] = moved(forest.nodes[begin]);
        for (std::uint32_t k = begin + 1; k < end; ++k)
            nodes.push_back(moved(forest.nodes[k]));
    }
    return nodes;
}

}  // namespace

Bvh build_bvh_fast(std::size_t count, const BoxSource& boxes, const BvhOptions& options) {
    RefArray array = make_refs(count, boxes, options);
    std::vector<MortonKey> keys = morton_order(array, options);
    const std::vector<Forest> forests = plant(array.refs(), keys, options);
    array = {};
    Bvh bvh;
    if (keys.empty()) return bvh;
    bvh.nodes = open_treelets(join_roots(forests, options), forests);
    bvh.indices.reserve(keys.size());
    for (const MortonKey& key : keys)
        bvh.indices.push_back(key.place);
    return bvh;
}

}  // namespace raypick
