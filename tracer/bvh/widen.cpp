// From binary nodes to wide ones: the nodes near the root first, then the subtrees below them, each
// by one thread, then all in one array.
#include "tracer/bvh/wide_bvh.h"
#include "tracer/bvh/wide_nodes.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <stdexcept>
#include <utility>
#include <vector>

namespace raypick {

namespace {

// Marks its end among the indices.
WideRef leaf_of(const BvhNode& leaf, WideBvh& wide) {
    wide.indices[leaf.first + leaf.count - 1] |= WideBvh::kLast;
    return WideRef::leaf(leaf.first);
}

// A wide node near the root, or the root of a subtree. Inner children are places, too.
struct Place {
    std::uint32_t binary = 0;
    std::uint32_t wide = 0;
    WideNode node;  // of one near the root; children are places
};

// What is below a place, which itself is node 0.
struct Subtree {
    LargeArray<WideNode> nodes;
    std::uint32_t begin = 0;  // where node 1 goes
};

// Nodes are numbered depth first, so that what a ray meets one after the other lies close together.
class Widener {
public:
    Widener(std::span<const BvhNode> nodes, WideBvh& wide) : nodes_(nodes), wide_(wide) {}

    void run(int threads, const std::stop_token& stop) {
        open_top(threads == 1 ? 1 : kSubtrees);
        parallel_for(subtrees_.size(), threads, stop, [this](std::size_t i) { widen_subtree(i); });
        if (stop.stop_requested()) throw Cancelled();
        if (opened_ == 0) {
            wide_.nodes = std::move(subtrees_.front().nodes);
            return;
        }
        wide_.nodes.resize(number_nodes());
        move_top();
        parallel_for(subtrees_.size(), threads, stop, [this](std::size_t i) { move_subtree(i); });
        if (stop.stop_requested()) throw Cancelled();
    }

private:
    static constexpr std::size_t kSubtrees = 128;  // enough for many threads

    [[nodiscard]] auto leaf() {
        return [this](const BvhNode& node) { return leaf_of(node, wide_).bits; };
    }

    // Fills places until there are so many others.
    void open_top(std::size_t subtrees) {
        places_.push_back({});
        for (; opened_ < places_.size() && places_.size() - opened_ < subtrees; ++opened_) {
            const WideNode node =
                make_wide_node(nodes_, open_node(nodes_, places_[opened_].binary), leaf(),
                               [this](std::uint32_t n) {
                                   places_.push_back({n, 0, {}});
                                   return static_cast<std::uint32_t>(places_.size() - 1);
                               });
            places_[opened_].node = node;
        }
        subtrees_.resize(places_.size() - opened_);
    }

    void widen_subtree(std::size_t which) {
        LargeArray<WideNode> nodes;
        append_wide_nodes(
            nodes, nodes_, places_[opened_ + which].binary,
            [this](std::uint32_t node) { return open_node(nodes_, node); }, leaf());
        subtrees_[which].nodes = std::move(nodes);
    }

    // Returns how many there are.
    std::uint32_t number_nodes() {
        std::uint32_t next = 1;
        std::vector<std::uint32_t> todo{0};
        while (!todo.empty()) {
            const std::uint32_t place = todo.back();
            todo.pop_back();
            if (place >= opened_) {
                Subtree& subtree = subtrees_[place - opened_];
                subtree.begin = next;
                next += static_cast<std::uint32_t>(subtree.nodes.size() - 1);
                continue;
            }
            const WideNode& node = places_[place].node;
            for (std::uint32_t i = kWidth; i-- > 0;) {
                if (node.ref(i).is_leaf()) continue;
                places_[node.child[i]].wide = next++;
                todo.push_back(node.child[i]);
            }
        }
        return next;
    }

    void move_top() {
        for (std::size_t place = 0; place < opened_; ++place) {
            WideNode node = places_[place].node;
            for (std::uint32_t& child : node.child) {
                if (!WideRef{child}.is_leaf()) child = places_[child].wide;
            }
            wide_.nodes[places_[place].wide] = node;
        }
    }

    void move_subtree(std::size_t which) {
        Subtree& subtree = subtrees_[which];
        for (std::uint32_t i = 0; i < subtree.nodes.size(); ++i) {
            WideNode& node =
                wide_.nodes[i == 0 ? places_[opened_ + which].wide : subtree.begin + i - 1];
            node = subtree.nodes[i];
            move_children(node, subtree.begin - 1, 0);
        }
        free_array(subtree.nodes);
    }

    std::span<const BvhNode> nodes_;
    WideBvh& wide_;
    std::vector<Place> places_;
    std::size_t opened_ = 0;  // places near the root; the others have subtrees
    std::vector<Subtree> subtrees_;
};

}  // namespace

WideBvh widen(Bvh&& bvh, int threads, const std::stop_token& stop) {
    WideBvh wide;
    wide.indices = std::move(bvh.indices);
    if (wide.indices.size() >= WideRef::kLeaf) {
        throw std::length_error("a tree has place for 2147483647 primitives");
    }
    if (bvh.nodes.empty()) return wide;
    wide.bounds = bvh.nodes[0].bounds;
    if (bvh.nodes[0].is_leaf()) {
        wide.root = leaf_of(bvh.nodes[0], wide);
        return wide;
    }
    wide.root = WideRef::node(0);
    Widener(bvh.nodes, wide).run(threads, stop);
    return wide;
}

}  // namespace raypick
