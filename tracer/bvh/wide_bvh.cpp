#include "tracer/bvh/wide_bvh.h"

#include "tracer/bvh/float4.h"

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

// Of each child, a lane for each of the four octants in which z is positive.
template <typename Lanes>
using PerChild = std::array<Lanes, kWidth>;

// How far the boxes' centres are along the octants' diagonals, times a factor.
PerChild<Float4> along_diagonals(const WideNode& node) {
    constexpr std::int32_t kSign = std::numeric_limits<std::int32_t>::min();
    const Int4 minus_x{0, kSign, 0, kSign};
    const Int4 minus_y{0, 0, kSign, kSign};
    const auto& planes = node.planes;
    PerChild<Float4> along{};
    for (std::size_t i = 0; i < kWidth; ++i) {
        const Int4 x = bits_of(all4(planes[0][i] + planes[3][i])) ^ minus_x;
        const Int4 y = bits_of(all4(planes[1][i] + planes[4][i])) ^ minus_y;
        const Float4 sum = from_bits(x) + from_bits(y) + all4(planes[2][i] + planes[5][i]);
        // Empty boxes have no centre: they come last.
        along[i] = sum == sum ? sum : all4(-std::numeric_limits<float>::infinity());
    }
    return along;
}

// How many children come before each: those that are farther, and those as far with a lower number.
PerChild<Int4> count_before(const PerChild<Float4>& along) {
    PerChild<Int4> before{};
    for (std::size_t i = 0; i < kWidth; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const Int4 farther = along[i] > along[k];  // -1 where it is
            before[k] -= farther;
            before[i] += farther + 1;
        }
    }
    return before;
}

// 8^power, exactly.
Float4 power_of_8(Int4 power) {
    return from_bits((3 * power + 127) << 23);
}

}  // namespace

Bounds WideNode::box(std::uint32_t i) const {
    return {{planes[0][i], planes[1][i], planes[2][i]}, {planes[3][i], planes[4][i], planes[5][i]}};
}

// By their centres along the octant's diagonal; in opposite octants the other way round.
void WideNode::sort_children() {
    const PerChild<Int4> before = count_before(along_diagonals(*this));
    // Three bits a child: whole numbers below 2^24, which floats hold exactly.
    Float4 forwards{};
    Float4 backwards{};
    for (std::size_t i = 0; i < kWidth; ++i) {
        const Float4 number = all4(static_cast<float>(i));
        forwards += number * power_of_8(before[i]);
        backwards += number * power_of_8(static_cast<std::int32_t>(kWidth - 1) - before[i]);
    }
    for (int octant = 0; octant < 4; ++octant) {
        const auto front = static_cast<std::uint32_t>(forwards[octant]);
        const auto back = static_cast<std::uint32_t>(backwards[octant]);
        std::memcpy(order.data() + 3 * octant, &front, 3);
        std::memcpy(order.data() + 3 * (7 - octant), &back, 3);
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
