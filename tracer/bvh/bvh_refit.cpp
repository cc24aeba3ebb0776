#include "tracer/bvh/box_refs.h"
#include "tracer/bvh/bvh.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <vector>

namespace raypick {

namespace {

// Subtrees that threads work on: enough to keep many busy although they differ in size.
constexpr std::size_t kSubtrees = 256;

class Refitter {
public:
    Refitter(Bvh& bvh, const BoxSource& boxes) : bvh_(bvh), boxes_(boxes) {}

    void run(int threads, const std::stop_token& stop) {
        const std::vector<std::uint32_t> top = upper_nodes();
        const std::vector<std::uint32_t> roots(top.begin() + static_cast<std::ptrdiff_t>(inner_),
                                               top.end());
        parallel_for(roots.size(), threads, stop, [&](std::size_t i) { refit_below(roots[i]); });
        if (stop.stop_requested()) throw Cancelled();
        for (std::size_t i = inner_; i-- > 0;)
            join_children(bvh_.nodes[top[i]]);
    }

private:
    // Breadth first: inner nodes, the first inner_ of the answer, then the roots of the subtrees
    // below them.
    std::vector<std::uint32_t> upper_nodes() {
        std::vector<std::uint32_t> nodes;
        std::vector<std::uint32_t> leaves;
        if (!bvh_.nodes.empty()) nodes.push_back(0);
        while (inner_ < nodes.size() && nodes.size() - inner_ < kSubtrees) {
            const BvhNode& node = bvh_.nodes[nodes[inner_]];
            if (node.is_leaf()) {
                leaves.push_back(nodes[inner_]);
                nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(inner_));
                continue;
            }
            nodes.push_back(node.first);
            nodes.push_back(node.first + 1);
            ++inner_;
        }
        nodes.insert(nodes.end(), leaves.begin(), leaves.end());
        return nodes;
    }

    void refit_below(std::uint32_t index) {
        BvhNode& node = bvh_.nodes[index];
        if (node.is_leaf()) {
            refit_leaf(node);
            return;
        }
        refit_below(node.first);
        refit_below(node.first + 1);
        join_children(node);
    }

    void refit_leaf(BvhNode& node) {
        node.bounds = {};
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            Bounds box;
            boxes_(bvh_.indices[i], {&box, 1});
            if (is_usable(box4(box))) node.bounds.extend(box);
        }
    }

    void join_children(BvhNode& node) {
        node.bounds = bvh_.nodes[node.first].bounds;
        node.bounds.extend(bvh_.nodes[node.first + 1].bounds);
    }

    Bvh& bvh_;
    const BoxSource& boxes_;
    std::size_t inner_ = 0;
};

}  // namespace

void refit(Bvh& bvh, const BoxSource& boxes, int threads, const std::stop_token& stop) {
    Refitter(bvh, boxes).run(threads, stop);
}

}  // namespace raypick
