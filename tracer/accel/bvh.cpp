#include "tracer/accel/bvh.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace raypick {

namespace {

constexpr int kBins = 16;
constexpr std::uint32_t kMaxLeaf = 4;
// Ranges above this are split one after the other, each on all threads; those below are built each
// by one thread. Constants, so that the tree does not depend on the number of threads.
constexpr std::size_t kSubtreeSize = 1u << 15;
constexpr std::size_t kChunk = 1u << 15;
// From here on ranges are halved, so that no tree gets deeper than Bvh::kMaxDepth.
constexpr int kMaxSplitDepth = 30;

struct BoxRef {
    Bounds bounds;
    std::uint32_t index = 0;
};

struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::uint32_t node = 0;
    int depth = 0;

    [[nodiscard]] std::size_t size() const { return end - begin; }
};

struct RangeBounds {
    Bounds all;
    Bounds centres;  // of the boxes' centres

    void extend(const RangeBounds& other) {
        all.extend(other.all);
        centres.extend(other.centres);
    }
};

struct Bin {
    Bounds bounds;
    std::uint32_t count = 0;
};
using Bins = std::array<std::array<Bin, kBins>, 3>;

struct Split {
    int axis = -1;  // -1: no split pays
    int bin = 0;    // first bin of the right side
    float cost = std::numeric_limits<float>::infinity();
};

// Which bin a centre falls into, per axis.
class Binning {
public:
    explicit Binning(const Bounds& centres) : min_(centres.min) {
        for (int axis = 0; axis < 3; ++axis) {
            const float extent = centres.max[axis] - centres.min[axis];
            const float scale = static_cast<float>(kBins) / extent;
            scale_[axis] = extent > 0.0f && std::isfinite(scale) ? scale : 0.0f;
        }
    }

    [[nodiscard]] bool flat(int axis) const { return scale_[axis] == 0.0f; }
    [[nodiscard]] std::size_t bin(const BoxRef& ref, int axis) const {
        const float place = (ref.bounds.centre()[axis] - min_[axis]) * scale_[axis];
        // Written so that a NaN goes to the first bin.
        constexpr float kLast = kBins - 1;
        return static_cast<std::size_t>(place > 0.0f ? std::min(place, kLast) : 0.0f);
    }

private:
    glm::vec3 min_;
    glm::vec3 scale_{0.0f};
};

void add_to_bins(std::span<const BoxRef> refs, const Binning& binning, Bins& bins) {
    for (const BoxRef& ref : refs) {
        for (int axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[static_cast<std::size_t>(axis)][binning.bin(ref, axis)];
            bin.bounds.extend(ref.bounds);
            ++bin.count;
        }
    }
}

// The cheapest boundary between bins by the surface area heuristic, not counting the constant part.
Split best_split(const Bins& bins, const Binning& binning) {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        if (binning.flat(axis)) continue;
        const auto& row = bins[static_cast<std::size_t>(axis)];
        std::array<float, kBins> right_cost{};
        Bounds right;
        std::uint32_t right_count = 0;
        for (int i = kBins - 1; i > 0; --i) {
            const Bin& bin = row[static_cast<std::size_t>(i)];
            if (bin.count > 0) right.extend(bin.bounds);
            right_count += bin.count;
            right_cost[static_cast<std::size_t>(i)] =
                right_count > 0 ? right.half_area() * static_cast<float>(right_count) : 0.0f;
        }
        Bounds left;
        std::uint32_t left_count = 0;
        for (int i = 1; i < kBins; ++i) {
            const Bin& bin = row[static_cast<std::size_t>(i - 1)];
            if (bin.count > 0) left.extend(bin.bounds);
            left_count += bin.count;
            if (left_count == 0) continue;
            const float cost = left.half_area() * static_cast<float>(left_count) +
                               right_cost[static_cast<std::size_t>(i)];
            if (cost < best.cost) best = {axis, i, cost};
        }
    }
    return best;
}

class Builder {
public:
    Builder(std::span<const Bounds> boxes, int threads, std::stop_token stop)
        : threads_(threads), stop_(std::move(stop)) {
        refs_.reserve(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const glm::vec3 sum = boxes[i].min + boxes[i].max;
            const bool finite =
                std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z);
            if (finite && !boxes[i].empty()) {
                refs_.push_back({boxes[i], static_cast<std::uint32_t>(i)});
            }
        }
    }

    Bvh build() {
        Bvh bvh;
        if (refs_.empty()) return bvh;
        bvh.nodes.resize(1);
        std::vector<Range> subtrees = split_top(bvh.nodes);
        build_subtrees(bvh.nodes, subtrees);
        bvh.indices.resize(refs_.size());
        for (std::size_t i = 0; i < refs_.size(); ++i)
            bvh.indices[i] = refs_[i].index;
        return bvh;
    }

private:
    // Splits large ranges breadth first; returns the ranges that are left to build.
    std::vector<Range> split_top(std::vector<BvhNode>& nodes) {
        std::vector<Range> subtrees;
        std::vector<Range> queue{{0, refs_.size(), 0, 0}};
        for (std::size_t i = 0; i < queue.size(); ++i) {
            if (stop_.stop_requested()) throw Cancelled();
            const Range range = queue[i];
            if (range.size() <= kSubtreeSize) {
                subtrees.push_back(range);
                continue;
            }
            split_node(nodes, range, queue, threads_);
        }
        return subtrees;
    }

    void build_subtrees(std::vector<BvhNode>& nodes, const std::vector<Range>& subtrees) {
        std::vector<std::vector<BvhNode>> built(subtrees.size());
        parallel_for(subtrees.size(), threads_, stop_,
                     [&](std::size_t i) { built[i] = build_subtree(subtrees[i]); });
        if (stop_.stop_requested()) throw Cancelled();
        for (std::size_t i = 0; i < subtrees.size(); ++i) {
            append_subtree(nodes, subtrees[i].node, built[i]);
        }
    }

    // A subtree in an array of its own, its root at 0.
    std::vector<BvhNode> build_subtree(const Range& whole) {
        std::vector<BvhNode> nodes(1);
        std::vector<Range> stack{{whole.begin, whole.end, 0, whole.depth}};
        while (!stack.empty()) {
            const Range range = stack.back();
            stack.pop_back();
            split_node(nodes, range, stack, 1);
        }
        return nodes;
    }

    // The subtree's root takes the place of nodes[root]; the others go to the end.
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

    // Makes nodes[range.node] a leaf, or an inner node whose two halves are pushed to `todo`.
    void split_node(std::vector<BvhNode>& nodes, const Range& range, std::vector<Range>& todo,
                    int threads) {
        const RangeBounds bounds = measure(range, threads);
        nodes[range.node].bounds = bounds.all;
        const std::size_t middle = partition(range, bounds, threads);
        if (middle == range.begin) {
            nodes[range.node].first = static_cast<std::uint32_t>(range.begin);
            nodes[range.node].count = static_cast<std::uint32_t>(range.size());
            return;
        }
        const auto child = static_cast<std::uint32_t>(nodes.size());
        nodes[range.node].first = child;
        nodes.resize(nodes.size() + 2);
        todo.push_back({range.begin, middle, child, range.depth + 1});
        todo.push_back({middle, range.end, child + 1, range.depth + 1});
    }

    // Reorders the range into two halves and returns where the second begins; range.begin for a
    // leaf.
    std::size_t partition(const Range& range, const RangeBounds& bounds, int threads) {
        const std::size_t count = range.size();
        if (count <= kMaxLeaf) return range.begin;
        const Binning binning(bounds.centres);
        Split split;
        if (range.depth < kMaxSplitDepth)
            split = best_split(fill_bins(range, binning, threads), binning);
        const auto begin = refs_.begin() + static_cast<std::ptrdiff_t>(range.begin);
        const auto end = refs_.begin() + static_cast<std::ptrdiff_t>(range.end);
        if (split.axis >= 0) {
            const auto middle = std::partition(begin, end, [&](const BoxRef& ref) {
                return binning.bin(ref, split.axis) < static_cast<std::size_t>(split.bin);
            });
            if (middle != begin && middle != end) {
                return static_cast<std::size_t>(middle - refs_.begin());
            }
        }
        return halve(range, bounds);
    }

    // Equal halves by centre along the longest axis: for boxes that no bin tells apart.
    std::size_t halve(const Range& range, const RangeBounds& bounds) {
        const glm::vec3 extent = bounds.centres.extent();
        const int axis =
            extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
        const std::size_t middle = range.begin + range.size() / 2;
        const auto at = [&](std::size_t i) {
            return refs_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(range.begin), at(middle), at(range.end),
                         [axis](const BoxRef& a, const BoxRef& b) {
                             const float ca = a.bounds.centre()[axis];
                             const float cb = b.bounds.centre()[axis];
                             return ca != cb ? ca < cb : a.index < b.index;
                         });
        return middle;
    }

    RangeBounds measure(const Range& range, int threads) {
        return reduce<RangeBounds>(range, threads,
                                   [](std::span<const BoxRef> refs, RangeBounds& sum) {
                                       for (const BoxRef& ref : refs) {
                                           sum.all.extend(ref.bounds);
                                           sum.centres.extend(ref.bounds.centre());
                                       }
                                   });
    }

    Bins fill_bins(const Range& range, const Binning& binning, int threads) {
        struct BinSum {
            Bins bins;
            void extend(const BinSum& other) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    for (std::size_t i = 0; i < kBins; ++i) {
                        bins[axis][i].bounds.extend(other.bins[axis][i].bounds);
                        bins[axis][i].count += other.bins[axis][i].count;
                    }
                }
            }
        };
        return reduce<BinSum>(range, threads,
                              [&](std::span<const BoxRef> refs, BinSum& sum) {
                                  add_to_bins(refs, binning, sum.bins);
                              })
            .bins;
    }

    // Sums over fixed chunks, so that the result is the same for any number of threads.
    template <typename Sum, typename Body>
    Sum reduce(const Range& range, int threads, const Body& body) {
        const std::span<const BoxRef> refs(refs_.data() + range.begin, range.size());
        Sum total;
        if (threads == 1 || range.size() <= kChunk) {
            body(refs, total);
            return total;
        }
        std::vector<Sum> sums((range.size() + kChunk - 1) / kChunk);
        parallel_for(sums.size(), threads, stop_, [&](std::size_t i) {
            body(refs.subspan(i * kChunk, std::min(kChunk, refs.size() - i * kChunk)), sums[i]);
        });
        if (stop_.stop_requested()) throw Cancelled();
        for (const Sum& sum : sums)
            total.extend(sum);
        return total;
    }

    std::vector<BoxRef> refs_;
    int threads_;
    std::stop_token stop_;
};

}  // namespace

Bvh build_bvh(std::span<const Bounds> boxes, int threads, const std::stop_token& stop) {
    return Builder(boxes, threads, stop).build();
}

}  // namespace raypick
