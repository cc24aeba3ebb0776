// Wide nodes from binary ones.
#pragma once

#include "tracer/bvh/bvh.h"
#include "tracer/bvh/wide_bvh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// Binary nodes that become one wide node's children.
struct WideChildren {
    std::array<std::uint32_t, kWidth> node{};
    std::uint32_t count = 0;
};

// Of an inner node: opens the one with the largest surface until there are eight, or only leaves.
WideChildren open_node(std::span<const BvhNode> nodes, std::uint32_t root);

// With the children's boxes and order, but nothing in their places.
WideNode node_with_boxes(std::span<const BvhNode> nodes, const WideChildren& children);

// Calls leaf(binary node) and inner(index of a binary node) for the children's places, in bits.
template <typename Leaf, typename Inner>
WideNode make_wide_node(std::span<const BvhNode> nodes, const WideChildren& children,
                        const Leaf& leaf, const Inner& inner) {
    WideNode node = node_with_boxes(nodes, children);
    // The last comes first, so that the first is what a stack gives back next.
    for (std::uint32_t i = children.count; i-- > 0;) {
        const BvhNode& child = nodes[children.node[i]];
        node.child[i] = child.is_leaf() ? leaf(child) : inner(children.node[i]);
    }
    return node;
}

// Appends what is below a binary node depth first, so that what a ray meets one after the other
// lies close together, and returns where its root is. children(index) is what becomes of an inner
// node; leaves are at leaf(binary node), in bits.
template <typename Children, typename Leaf>
WideRef append_wide_nodes(LargeArray<WideNode>& wide, std::span<const BvhNode> nodes,
                          std::uint32_t root, const Children& children, const Leaf& leaf) {
    if (nodes[root].is_leaf()) return {leaf(nodes[root])};
    struct Pending {
        std::uint32_t binary = 0;
        std::uint32_t wide = 0;
    };
    const auto first = static_cast<std::uint32_t>(wide.size());
    wide.emplace_back();
    std::vector<Pending> todo{{root, first}};
    while (!todo.empty()) {
        const Pending at = todo.back();
        todo.pop_back();
        const WideNode node =
            make_wide_node(nodes, children(at.binary), leaf, [&](std::uint32_t binary) {
                const auto place = static_cast<std::uint32_t>(wide.size());
                wide.emplace_back();
                todo.push_back({binary, place});
                return place;
            });
        wide[at.wide] = node;
    }
    return WideRef::node(first);
}

// Its inner children so many nodes on, its leaves so many places.
inline void move_children(WideNode& node, std::uint32_t nodes, std::uint32_t places) {
    for (std::uint32_t& child : node.child) {
        if (child == WideRef::kNothing) continue;
        child += WideRef{child}.is_leaf() ? places : nodes;
    }
}

}  // namespace raypick
