// A tree that is one leaf.
#pragma once

#include "tracer/bvh/wide_bvh.h"
#include "tracer/scene/scene.h"

#include <cstdint>
#include <utility>

namespace raypick {

// Of all triangles, in their order.
inline WideBvh one_leaf(const Mesh& mesh) {
    Bvh binary;
    binary.nodes.resize(1);
    binary.nodes[0].count = static_cast<std::uint32_t>(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        binary.indices.push_back(i);
    for (const glm::vec3& position : mesh.positions)
        binary.nodes[0].bounds.extend(position);
    return widen(std::move(binary));
}

}  // namespace raypick
