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
    ForestBuilder(std::span<const MortonKey> keys, std::uint32_t first_key, std::uint32_t leaf_size)
        : keys_(keys), first_key_(first_key), leaf_size_(leaf_size) {}

    // Sets the indices of the boxes in the keys' order, while they are at hand.
    Forest build(std::span<const BoxRef> refs, std::span<std::uint32_t> indices) {
        find_leaves(refs, indices);
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
    void find_leaves(std::span<const BoxRef> refs, std::span<std::uint32_t> indices) {
        leaves_.reserve(keys_.size() / 2);
        const auto step = [this](std::size_t i) { return step_before(keys_, i); };
        for (std::size_t begin = 0; begin < keys_.size();) {
            const std::size_t last = std::min<std::size_t>(keys_.size(), begin + leaf_size_);
            const std::size_t end = subtree_end(begin, last, step);
            fetch(refs, end);
            TreeletLeaf leaf;
            leaf.first = first_key_ + static_cast<std::uint32_t>(begin);
            leaf.count = static_cast<std::uint32_t>(end - begin);
            for (std::size_t i = begin; i < end; ++i) {
                const BoxRef& ref = refs[keys_[i].place];
                leaf.box.extend(ref.box());
                indices[i] = ref.index();
            }
            leaves_.push_back(leaf);
            begin = end;
        }
    }

    // Refs lie in no order, so the processor is told which ones come after the next few leaves.
    void fetch(std::span<const BoxRef> refs, std::size_t begin) const {
        begin += std::size_t{2} * leaf_size_;
        const std::size_t end = std::min<std::size_t>(keys_.size(), begin + leaf_size_);
        for (; begin < end; ++begin)
            __builtin_prefetch(&refs[keys_[begin].place]);
    }

    void add_treelet(std::span<const TreeletLeaf> leaves) {
        const std::size_t begin = forest_.nodes.size();
        forest_.begins.push_back(static_cast<std::uint32_t>(begin));
        append_treelet(forest_.nodes, leaves);
        forest_.roots.push_back(make_ref(box4(forest_.nodes[begin].bounds), 0));
        forest_.bounds.extend(forest_.roots.back());
    }

    std::span<const MortonKey> keys_;
    std::uint32_t first_key_;
    std::uint32_t leaf_size_;
    std::vector<TreeletLeaf> leaves_;
    Forest forest_;
};

// Sets the indices, too.
std::vector<Forest> plant(std::span<const BoxRef> refs, std::span<const MortonKey> keys,
                          std::span<std::uint32_t> indices, const BvhOptions& options) {
    std::vector<Forest> forests((keys.size() + kChunk - 1) / kChunk);
    parallel_for(forests.size(), options.threads, options.stop, [&](std::size_t i) {
        const std::size_t begin = i * kChunk;
        const std::size_t size = std::min(kChunk, keys.size() - begin);
        ForestBuilder builder(keys.subspan(begin, size), static_cast<std::uint32_t>(begin),
                              std::min(options.costs.max_leaf, options.costs.block_size));
        forests[i] = builder.build(refs, indices.subspan(begin, size));
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
    }
    BvhOptions one_each = options;
    one_each.costs = {.node = 1.0f, .block = 1.0f, .block_size = 1, .min_leaf = 1, .max_leaf = 1};
    upper.bvh = build_over_refs(std::move(roots), one_each, kMaxSplitDepth - kMostTreeletDepth);
    return upper;
}

BvhNode moved(BvhNode node, std::size_t offset) {
    if (!node.is_leaf()) node.first += static_cast<std::uint32_t>(offset);
    return node;
}

// Puts each treelet's root in place of the leaf that stands for it, and the rest behind them all.
std::vector<BvhNode> open_treelets(UpperTree&& upper, std::span<const Forest> forests,
                                   const BvhOptions& options) {
    std::vector<BvhNode> nodes = std::move(upper.bvh.nodes);
    const std::size_t upper_nodes = nodes.size();
    std::vector<std::size_t> begins;
    std::size_t end = upper_nodes;
    for (const Forest& forest : forests) {
        begins.push_back(end);
        end += forest.nodes.size() - forest.roots.size();
    }
    nodes.resize(end);
    // What is added to places counted from a treelet's root.
    const auto offset = [&](std::size_t forest, std::size_t treelet) {
        return begins[forest] + forests[forest].begins[treelet] - treelet - 1;
    };
    parallel_for(forests.size(), options.threads, options.stop, [&](std::size_t i) {
        std::size_t next = begins[i];
        for (std::size_t treelet = 0; treelet < forests[i].roots.size(); ++treelet) {
            const std::uint32_t root = forests[i].begins[treelet];
            for (std::uint32_t k = root + 1; k < forests[i].begins[treelet + 1]; ++k)
                nodes[next++] = moved(forests[i].nodes[k], offset(i, treelet));
        }
    });
    if (options.stop.stop_requested()) throw Cancelled();
    for (std::size_t i = 0; i < upper_nodes; ++i) {
        if (!nodes[i].is_leaf()) continue;
        const TreeletPlace at = upper.places[upper.bvh.indices[nodes[i].first]];
        const Forest& forest = forests[at.forest];
        nodes[i] = moved(forest.nodes[forest.begins[at.treelet]], offset(at.forest, at.treelet));
    }
    return nodes;
}

}  // namespace

Bvh build_bvh_fast(std::size_t count, const BoxSource& boxes, const BvhOptions& options) {
    RefArray array = make_refs(count, boxes, options);
    LargeArray<MortonKey> keys = morton_order(array, options);
    Bvh bvh;
    bvh.indices.resize(keys.size());
    const std::vector<Forest> forests = plant(array.refs(), keys, bvh.indices, options);
    array = {};
    keys = {};
    if (!forests.empty()) {
        bvh.nodes = open_treelets(join_roots(forests, options), forests, options);
    }
    return bvh;
}

}  // namespace raypick
