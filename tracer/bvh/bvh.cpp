// Builds from the top: each range of boxes is split in two by the surface area heuristic.
#include "tracer/bvh/bvh.h"

#include "tracer/bvh/box_refs.h"
#include "tracer/bvh/bvh_build.h"
#include "tracer/bvh/parallel_split.h"
#include "tracer/bvh/sah_split.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>
#include <utility>

namespace raypick {

namespace {

// Ranges above this are split one after the other, each on all threads; those below are built each
// by one thread. By the number of boxes, so that the tree does not depend on that of the threads:
// enough subtrees for many threads, and no more ranges than need be that all wait for.
std::size_t subtree_size(std::size_t boxes) {
    constexpr std::size_t kLeast = 1u << 13;
    return std::clamp(boxes / 64, kLeast, kLeast * 8);
}

struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
    RefBounds bounds;
    std::uint32_t node = 0;
    int depth = 0;

    [[nodiscard]] std::size_t size() const { return end - begin; }
};

class Builder {
public:
    Builder(RefArray array, const BvhOptions& options, int max_split_depth)
        : array_(std::move(array)),
          refs_(array_.refs()),
          options_(options),
          max_split_depth_(max_split_depth) {
        assert(std::has_single_bit(options.costs.block_size));
        assert(options.costs.max_leaf >= 1 && options.costs.max_leaf <= subtree_size(0));
    }

    Bvh build() {
        Bvh bvh;
        if (refs_.empty()) return bvh;
        bvh.indices.resize(refs_.size());
        indices_ = bvh.indices;
        bvh.nodes.resize(1);
        const std::vector<Range> roots =
            split_top(bvh.nodes, {0, refs_.size(), array_.bounds, 0, 0});
        append_subtrees(bvh.nodes, roots);
        return bvh;
    }

private:
    std::vector<Range> split_top(std::vector<BvhNode>& nodes, const Range& all) {
        std::vector<Range> roots;
        std::vector<Range> todo{all};
        while (!todo.empty()) {
            const Range range = todo.back();
            todo.pop_back();
            if (range.size() <= subtree_size(refs_.size())) {
                roots.push_back(range);
                continue;
            }
            const std::span<BoxRef> refs = refs_.subspan(range.begin, range.size());
            const Division division = range.depth < max_split_depth_
                                          ? divide_parallel(refs, range.bounds, options_)
                                          : halve_range(refs, range.bounds);
            push_children(nodes, range, division, todo);
        }
        return roots;
    }

    // The largest first, so that no thread ends with one while the others wait.
    void append_subtrees(std::vector<BvhNode>& nodes, std::span<const Range> roots) {
        std::vector<std::size_t> order(roots.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return roots[a].size() > roots[b].size();
        });
        std::vector<std::vector<BvhNode>> subtrees(roots.size());
        parallel_for(order.size(), options_.threads, options_.stop,
                     [&](std::size_t i) { subtrees[order[i]] = build_subtree(roots[order[i]]); });
        if (options_.stop.stop_requested()) throw Cancelled();
        array_ = {};  // before there are two copies of nodes
        std::size_t total = nodes.size();
        for (const std::vector<BvhNode>& subtree : subtrees)
            total += subtree.size() - 1;
        nodes.reserve(total);
        for (std::size_t i = 0; i < roots.size(); ++i)
            append_subtree(nodes, roots[i].node, subtrees[i]);
    }

    // `root` stands in `nodes` already; the other nodes go to the end. Frees the subtree.
    static void append_subtree(std::vector<BvhNode>& nodes, std::uint32_t root,
                               std::vector<BvhNode>& subtree) {
        const auto offset = static_cast<std::uint32_t>(nodes.size()) - 1;
        for (BvhNode& node : subtree) {
            if (!node.is_leaf()) node.first += offset;
        }
        nodes[root] = subtree.front();
        nodes.insert(nodes.end(), subtree.begin() + 1, subtree.end());
        std::vector<BvhNode>().swap(subtree);
    }

    // On one thread; its root is the first node.
    std::vector<BvhNode> build_subtree(Range range) {
        std::vector<BvhNode> nodes;
        nodes.reserve(range.size());
        nodes.resize(1);
        range.node = 0;
        std::vector<Range> todo{range};
        while (!todo.empty()) {
            range = todo.back();
            todo.pop_back();
            const Division division = divide_or_stop(range);
            if (division.middle > 0) {
                push_children(nodes, range, division, todo);
            } else {
                make_leaf(nodes[range.node], range);
            }
        }
        return {nodes.begin(), nodes.end()};
    }

    // No middle for a leaf.
    Division divide_or_stop(const Range& range) {
        const LeafCosts& costs = options_.costs;
        const std::size_t count = range.size();
        if (count <= costs.min_leaf) return {};
        const std::span<BoxRef> refs = refs_.subspan(range.begin, count);
        if (range.depth < max_split_depth_ && can_bin(range.bounds)) {
            const Binning binning(range.bounds.centres, count);
            Bins bins(binning);
            bins.add(refs, binning);
            const Split split = best_split(bins, binning, costs);
            if (count <= costs.max_leaf && !pays(split, range)) return {};
            if (split.axis >= 0) return divided(bins, split, partition(refs, binning, split));
        }
        if (count <= costs.max_leaf) return {};
        return halve_range(refs, range.bounds);
    }

    [[nodiscard]] bool pays(const Split& split, const Range& range) const {
        const LeafCosts& costs = options_.costs;
        const float area = range.bounds.boxes.half_area();
        const float blocks = blocks_of(static_cast<std::uint32_t>(range.size()), costs);
        return costs.node * area + costs.block * split.cost < costs.block * blocks * area;
    }

    static void push_children(std::vector<BvhNode>& nodes, const Range& range,
                              const Division& division, std::vector<Range>& todo) {
        const auto child = static_cast<std::uint32_t>(nodes.size());
        BvhNode& node = nodes[range.node];
        node.bounds = range.bounds.boxes.bounds();
        node.first = child;
        nodes.resize(nodes.size() + 2);
        const std::size_t middle = range.begin + division.middle;
        todo.push_back({middle, range.end, division.right, child + 1, range.depth + 1});
        todo.push_back({range.begin, middle, division.left, child, range.depth + 1});
    }

    void make_leaf(BvhNode& node, const Range& range) {
        node.bounds = range.bounds.boxes.bounds();
        node.first = static_cast<std::uint32_t>(range.begin);
        node.count = static_cast<std::uint32_t>(range.size());
        for (std::size_t i = range.begin; i < range.end; ++i)
            indices_[i] = refs_[i].index();
    }

    RefArray array_;
    std::span<BoxRef> refs_;
    std::span<std::uint32_t> indices_;
    const BvhOptions& options_;
    int max_split_depth_;
};

}  // namespace

Bvh build_over_refs(RefArray array, const BvhOptions& options, int max_split_depth) {
    return Builder(std::move(array), options, max_split_depth).build();
}

Bvh build_bvh(std::size_t count, const BoxSource& boxes, const BvhOptions& options) {
    return build_over_refs(make_refs(count, boxes, options), options);
}

Bvh build_bvh(std::span<const Bounds> boxes, int threads, const std::stop_token& stop) {
    const auto copy = [boxes](std::size_t first, std::span<Bounds> wanted) {
        std::copy_n(boxes.begin() + static_cast<std::ptrdiff_t>(first), wanted.size(),
                    wanted.begin());
    };
    return build_bvh(boxes.size(), copy, {.costs = {}, .threads = threads, .stop = stop});
}

double sah_cost(const Bvh& bvh, const LeafCosts& costs) {
    double sum = 0.0;
    for (const BvhNode& node : bvh.nodes) {
        const float price =
            node.is_leaf() ? costs.block * blocks_of(node.count, costs) : costs.node;
        sum += static_cast<double>(price) * static_cast<double>(node.bounds.half_area());
    }
    const double root =
        bvh.nodes.empty() ? 0.0 : static_cast<double>(bvh.nodes[0].bounds.half_area());
    return root > 0.0 ? sum / root : 0.0;
}

}  // namespace raypick
