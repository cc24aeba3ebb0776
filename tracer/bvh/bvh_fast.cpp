// A first tree: boxes that are neighbours along a space-filling curve make leaves, neighbouring
// leaves make treelets, and only the treelets are split by where they are.
//
// Source: Pantaleoni and Luebke, "HLBVH: Hierarchical LBVH Construction for Real-Time Ray Tracing
// of Dynamic Geometry", 2010.
#include "tracer/bvh/bvh_fast.h"

#include "tracer/bvh/best_children.h"
#include "tracer/bvh/bvh_build.h"
#include "tracer/bvh/wide_nodes.h"
#include "tracer/error.h"
#include "tracer/parallel/in_order.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace raypick {

namespace {

constexpr std::size_t kTreeletLeaves = 32;
// See BestChildren.
constexpr float kPerTreeletNode = 0.02f;
constexpr float kPerUpperNode = 1e-5f;

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

struct Treelet {
    WideRef root;
    Box4 box;
};

// A chunk's treelets, one after the other.
struct Forest {
    LargeArray<WideNode> nodes;     // inner places are counted from the chunk's first node,
    std::vector<Treelet> treelets;  // leaves from its first place
    std::size_t places = 0;
};

// From one chunk of keys.
class ForestBuilder {
public:
    ForestBuilder(std::span<const MortonKey> keys, std::uint32_t leaf_size)
        : keys_(keys), leaf_size_(leaf_size) {}

    Forest build(std::size_t chunk, const LeafStore& store) {
        find_leaves();
        forest_.places = store.store(chunk, keys_, leaves_);
        forest_.nodes.reserve(leaves_.size() / 2);
        const auto step = [this](std::size_t i) { return step_before(keys_, begins_[i]); };
        for (std::size_t begin = 0; begin < leaves_.size();) {
            const std::size_t last = std::min(leaves_.size(), begin + kTreeletLeaves);
            const std::size_t end = subtree_end(begin, last, step);
            add_treelet(std::span(leaves_).subspan(begin, end - begin));
            begin = end;
        }
        return std::move(forest_);
    }

private:
    void find_leaves() {
        leaves_.reserve(keys_.size() / 2);
        begins_.reserve(keys_.size() / 2);
        const auto step = [this](std::size_t i) { return step_before(keys_, i); };
        for (std::size_t begin = 0; begin < keys_.size();) {
            const std::size_t last = std::min<std::size_t>(keys_.size(), begin + leaf_size_);
            const std::size_t end = subtree_end(begin, last, step);
            begins_.push_back(static_cast<std::uint32_t>(begin));
            leaves_.push_back({{}, begins_.back(), static_cast<std::uint32_t>(end - begin)});
            begin = end;
        }
        begins_.push_back(static_cast<std::uint32_t>(keys_.size()));
    }

    void add_treelet(std::span<const TreeletLeaf> leaves) {
        treelet_.clear();
        append_treelet(treelet_, leaves);
        children_.find(treelet_, kPerTreeletNode);
        const WideRef root = append_wide_nodes(
            forest_.nodes, treelet_, 0, [this](std::uint32_t node) { return children_.of(node); },
            [](const BvhNode& leaf) { return WideRef::leaf(leaf.first).bits; });
        forest_.treelets.push_back({root, box4(treelet_.front().bounds)});
    }

    std::span<const MortonKey> keys_;
    std::uint32_t leaf_size_;
    std::vector<TreeletLeaf> leaves_;
    std::vector<std::uint32_t> begins_;  // first keys of the leaves, and the end
    std::vector<BvhNode> treelet_;
    BestChildren children_;
    Forest forest_;
};

// All treelets, and then the tree over them.
class Planter {
public:
    Planter(std::span<const MortonKey> keys, const LeafStore& store, const BvhOptions& options)
        : keys_(keys),
          store_(store),
          options_(options),
          forests_((keys.size() + kKeysInChunk - 1) / kKeysInChunk) {}

    void plant() {
        const std::uint32_t leaf_size =
            std::min(options_.costs.max_leaf, options_.costs.block_size);
        tree_.nodes.reserve(keys_.size() / leaf_size / 2);  // enough for surfaces
        InOrder in_order(forests_.size(), [this](std::size_t i) { append(i); });
        parallel_for(forests_.size(), options_.threads, options_.stop, [&](std::size_t i) {
            const std::size_t begin = i * kKeysInChunk;
            const std::size_t size = std::min(kKeysInChunk, keys_.size() - begin);
            forests_[i] = ForestBuilder(keys_.subspan(begin, size), leaf_size).build(i, store_);
            in_order.ready(i);
        });
        if (options_.stop.stop_requested()) throw Cancelled();
    }

    // The upper nodes come last.
    WideBvh join() {
        if (roots_.empty()) return {};
        BvhOptions one_each = options_;
        one_each.costs = {
            .node = 1.0f, .block = 1.0f, .block_size = 1, .min_leaf = 1, .max_leaf = 1};
        boxes_.count = boxes_.storage.size();
        const Bvh upper =
            build_over_refs(std::move(boxes_), one_each, kMaxSplitDepth - kMostTreeletDepth);
        tree_.bounds = upper.nodes.front().bounds;
        BestChildren children;
        children.find(upper.nodes, kPerUpperNode);
        tree_.root = append_wide_nodes(
            tree_.nodes, upper.nodes, 0, [&](std::uint32_t node) { return children.of(node); },
            [&](const BvhNode& leaf) { return roots_[upper.indices[leaf.first]].bits; });
        return std::move(tree_);
    }

private:
    void append(std::size_t chunk) {
        const Forest forest = std::move(forests_[chunk]);
        const auto nodes = static_cast<std::uint32_t>(tree_.nodes.size());
        const auto places = static_cast<std::uint32_t>(places_);
        places_ += forest.places;
        if (places_ >= WideRef::kLeaf) {
            throw std::length_error("a tree has place for 2147483647 primitives");
        }
        for (const WideNode& node : forest.nodes) {
            tree_.nodes.push_back(node);
            move_children(tree_.nodes.back(), nodes, places);
        }
        for (const Treelet& treelet : forest.treelets) {
            boxes_.storage.push_back(
                make_ref(treelet.box, static_cast<std::uint32_t>(roots_.size())));
            boxes_.bounds.extend(boxes_.storage.back());
            roots_.push_back({treelet.root.bits + (treelet.root.is_leaf() ? places : nodes)});
        }
        if (store_.append) store_.append(chunk);
    }

    std::span<const MortonKey> keys_;
    const LeafStore& store_;
    const BvhOptions& options_;
    std::vector<Forest> forests_;
    WideBvh tree_;
    std::vector<WideRef> roots_;  // of the treelets,
    RefArray boxes_;              // and their boxes
    std::size_t places_ = 0;
};

// All boxes, each asked for once, and a box around those that are usable.
struct Boxes {
    LargeArray<Box4> all;
    Box4 around;
};

Boxes find_boxes(std::size_t count, const BoxSource& source, const BvhOptions& options) {
    constexpr std::size_t kChunk = 1u << 12;
    Boxes boxes;
    boxes.all.resize(count);
    std::vector<Box4> around((count + kChunk - 1) / kChunk);
    parallel_for(around.size(), options.threads, options.stop, [&](std::size_t i) {
        std::vector<Bounds> some(std::min(kChunk, count - i * kChunk));
        source(i * kChunk, some);
        for (std::size_t k = 0; k < some.size(); ++k) {
            const Box4 box = box4(some[k]);
            if (is_usable(box)) around[i].extend(box);
            boxes.all[i * kChunk + k] = box;
        }
    });
    if (options.stop.stop_requested()) throw Cancelled();
    for (const Box4& box : around)
        boxes.around.extend(box);
    return boxes;
}

// Leaves hold the boxes' indices.
class IndexStore {
public:
    IndexStore(std::span<const Box4> boxes, std::span<std::uint32_t> indices)
        : boxes_(boxes), indices_(indices) {}

    std::size_t operator()(std::size_t chunk, std::span<const MortonKey> keys,
                           std::span<TreeletLeaf> leaves) const {
        const std::span<std::uint32_t> indices =
            indices_.subspan(chunk * kKeysInChunk, keys.size());
        for (TreeletLeaf& leaf : leaves) {
            const std::uint32_t last = leaf.first + leaf.count - 1;
            for (std::uint32_t i = leaf.first; i <= last; ++i) {
                indices[i] = keys[i].index;
                leaf.box.extend(boxes_[keys[i].index]);
            }
            indices[last] |= WideBvh::kLast;
        }
        return keys.size();
    }

private:
    std::span<const Box4> boxes_;
    std::span<std::uint32_t> indices_;
};

}  // namespace

WideBvh build_over_keys(LargeArray<MortonKey> keys, const LeafStore& store,
                        const BvhOptions& options) {
    Planter planter(keys, store, options);
    planter.plant();
    free_array(keys);
    return planter.join();
}

WideBvh build_bvh_fast(std::size_t count, const BoxSource& boxes, const BvhOptions& options) {
    const Boxes known = find_boxes(count, boxes, options);
    const Box4Source source = [&known](std::size_t first, std::span<Box4> wanted) {
        std::copy_n(known.all.begin() + static_cast<std::ptrdiff_t>(first), wanted.size(),
                    wanted.begin());
    };
    LargeArray<MortonKey> keys = morton_order(count, source, known.around, options);
    LargeArray<std::uint32_t> indices;
    indices.resize(keys.size());
    WideBvh bvh =
        build_over_keys(std::move(keys), {IndexStore(known.all, indices), nullptr}, options);
    bvh.indices = std::move(indices);
    return bvh;
}

}  // namespace raypick
