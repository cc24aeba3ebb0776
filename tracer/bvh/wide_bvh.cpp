#include "tracer/bvh/wide_bvh.h"

#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace raypick {

namespace {

void set_box(WideNode& node, std::uint32_t i, const Bounds& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.planes[axis][i] = box.min[static_cast<int>(axis)];
        node.planes[3 + axis][i] = box.max[static_cast<int>(axis)];
    }
}

// Binary nodes that become one wide node's children.
struct Children {
    std::array<std::uint32_t, kWidth> node{};
    std::uint32_t count = 0;
};

// Opens the inner node with the largest surface until there are eight, or only leaves.
Children open_node(const std::vector<BvhNode>& nodes, std::uint32_t root) {
    Children children;
    children.node[0] = nodes[root].first;
    children.node[1] = nodes[root].first + 1;
    children.count = 2;
    while (children.count < kWidth) {
        std::uint32_t widest = kWidth;
        float area = -1.0f;
        for (std::uint32_t i = 0; i < children.count; ++i) {
            const BvhNode& child = nodes[children.node[i]];
            if (child.is_leaf() || !(child.bounds.half_area() > area)) continue;
            area = child.bounds.half_area();
            widest = i;
        }
        if (widest == kWidth) break;
        const std::uint32_t first = nodes[children.node[widest]].first;
        children.node[widest] = first;
        children.node[children.count++] = first + 1;
    }
    return children;
}

// A node whose children are still to be numbered.
struct Pending {
    std::uint32_t binary = 0;
    std::uint32_t wide = 0;
};

}  // namespace

Bounds WideNode::box(std::uint32_t i) const {
    return {{planes[0][i], planes[1][i], planes[2][i]}, {planes[3][i], planes[4][i], planes[5][i]}};
}

// By their centres along the octant's diagonal; in opposite octants the other way round.
void WideNode::sort_children() {
    for (std::size_t octant = 0; octant < 4; ++octant) {
        std::array<float, kWidth> place{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float sign = ((octant >> axis) & 1) != 0 ? -1.0f : 1.0f;
            for (std::size_t i = 0; i < kWidth; ++i)
                place[i] += sign * (planes[axis][i] + planes[3 + axis][i]);
        }
        // Empty boxes have no centre: they come last.
        for (float& along : place)
            along = along == along ? along : -std::numeric_limits<float>::infinity();
        std::array<std::uint32_t, kWidth> sorted{};
        for (std::uint32_t i = 0; i < kWidth; ++i) {
            std::uint32_t before = 0;  // how many come first
            for (std::uint32_t k = 0; k < kWidth; ++k) {
                const bool tie = place[k] == place[i] && k < i;
                before += place[k] > place[i] || tie ? 1u : 0u;
            }
            sorted[before] = i;
        }
        std::uint32_t forwards = 0;
        std::uint32_t backwards = 0;
        for (std::size_t i = 0; i < kWidth; ++i) {
            forwards |= sorted[i] << (3 * i);
            backwards |= sorted[kWidth - 1 - i] << (3 * i);
        }
        std::memcpy(order.data() + 3 * octant, &forwards, 3);
        std::memcpy(order.data() + 3 * (7 - octant), &backwards, 3);
    }
}

WideBvh widen(Bvh&& bvh) {
    WideBvh wide;
    wide.indices = std::move(bvh.indices);
    if (wide.indices.size() >= WideRef::kLeaf) {
        throw std::length_error("a tree has place for 2147483647 primitives");
    }
    if (bvh.nodes.empty()) return wide;
    const std::vector<BvhNode>& nodes = bvh.nodes;
    wide.bounds = nodes[0].bounds;
    const auto leaf_of = [&wide](const BvhNode& leaf) {
        wide.indices[leaf.first + leaf.count - 1] |= WideBvh::kLast;
        return WideRef::leaf(leaf.first);
    };
    if (nodes[0].is_leaf()) {
        wide.root = leaf_of(nodes[0]);
        return wide;
    }
    wide.root = WideRef::node(0);
    wide.nodes.reserve(nodes.size() / 8 + 1);
    wide.nodes.emplace_back();
    // Depth first, so that what a ray meets one after the other lies close together.
    std::vector<Pending> todo{{0, 0}};
    while (!todo.empty()) {
        const Pending at = todo.back();
        todo.pop_back();
        const Children children = open_node(nodes, at.binary);
        WideNode node;
        node.child.fill(WideRef::kNothing);
        for (std::uint32_t i = 0; i < kWidth; ++i) {
            if (i >= children.count) {
                set_box(node, i, Bounds{});
                continue;
            }
            const BvhNode& child = nodes[children.node[i]];
            set_box(node, i, child.bounds);
            if (child.is_leaf()) node.child[i] = leaf_of(child).bits;
        }
        for (std::uint32_t i = children.count; i-- > 0;) {
            if (nodes[children.node[i]].is_leaf()) continue;
            node.child[i] = static_cast<std::uint32_t>(wide.nodes.size());
            wide.nodes.emplace_back();
            todo.push_back({children.node[i], node.child[i]});
        }
        node.sort_children();
        wide.nodes[at.wide] = node;
    }
    return wide;
}

}  // namespace raypick
