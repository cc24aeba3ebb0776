#include "tracer/bvh/wide_nodes.h"

namespace raypick {

namespace {

void set_box(WideNode& node, std::uint32_t i, const Bounds& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.planes[axis][i] = box.min[static_cast<int>(axis)];
        node.planes[3 + axis][i] = box.max[static_cast<int>(axis)];
    }
}

}  // namespace

WideChildren open_node(std::span<const BvhNode> nodes, std::uint32_t root) {
    WideChildren children;
    std::array<float, kWidth> area{};  // -1: a leaf
    const auto put = [&](std::uint32_t i, std::uint32_t node) {
        children.node[i] = node;
        area[i] = nodes[node].is_leaf() ? -1.0f : nodes[node].bounds.half_area();
    };
    put(0, nodes[root].first);
    put(1, nodes[root].first + 1);
    for (children.count = 2; children.count < kWidth; ++children.count) {
        std::uint32_t widest = kWidth;
        float most = -1.0f;
        for (std::uint32_t i = 0; i < children.count; ++i) {
            if (!(area[i] > most)) continue;
            most = area[i];
            widest = i;
        }
        if (widest == kWidth) break;
        const std::uint32_t first = nodes[children.node[widest]].first;
        put(widest, first);
        put(children.count, first + 1);
    }
    return children;
}

WideNode node_with_boxes(std::span<const BvhNode> nodes, const WideChildren& children) {
    WideNode node;
    node.order.fill(0);
    node.child.fill(WideRef::kNothing);
    for (std::uint32_t i = 0; i < kWidth; ++i)
        set_box(node, i, i < children.count ? nodes[children.node[i]].bounds : Bounds{});
    node.sort_children();
    return node;
}

}  // namespace raypick
