// Where a tree lies in memory, for traversals that ask for parts of it before they need them.
#pragma once

#include "tracer/accel/trees.h"
#include "tracer/bvh/wide_bvh.h"

#include <array>
#include <cstddef>

#include <hwy/base.h>

namespace raypick {

// The tree must outlive it. Inlined by force where rays pass: those that go alone lose 7 % else.
class TreeMemory {
public:
    TreeMemory() = default;  // of no tree

    // Of the tree over a scene's objects.
    explicit TreeMemory(const WideBvh& top)
        : parts_{part_of(top.nodes, 1), part_of(top.indices, 1)} {}

    explicit TreeMemory(const PrimitiveTree& tree)
        : parts_{part_of(tree.bvh.nodes, 1), leaves_of(tree)} {}

    [[nodiscard]] HWY_INLINE const WideNode& node(const WideRef& ref) const {
        return reinterpret_cast<const WideNode*>(parts_[0].first)[ref.index()];
    }

    // Tells the processor that what `ref` stands for is needed soon: a node, or what most leaves
    // hold. Nothing happens if it isn't there, as a child that a node doesn't have.
    HWY_INLINE void fetch(const WideRef& ref) const {
        const Part& part = parts_[ref.bits >> 31u];
        const std::byte* line = part.first + ref.index() * part.size;
        for (std::size_t i = 0; i < sizeof(WideNode); i += kLine)
            __builtin_prefetch(line + i);
    }

private:
    static constexpr std::size_t kLine = 64;  // bytes

    // What references of one kind stand for.
    struct Part {
        const std::byte* first = nullptr;
        std::size_t size = 0;  // of each, in bytes
    };

    template <typename Array>
    static Part part_of(const Array& array, std::size_t stride) {
        return {reinterpret_cast<const std::byte*>(array.data()), stride * sizeof(array[0])};
    }

    static Part leaves_of(const PrimitiveTree& tree) {
        if (tree.bvh.indices.empty()) return part_of(tree.patches.blocks, 1);
        if (tree.elements.stride != 0) return part_of(tree.elements.rows, tree.elements.stride);
        return part_of(tree.bvh.indices, 1);
    }

    std::array<Part, 2> parts_;  // nodes, leaves
};

}  // namespace raypick
