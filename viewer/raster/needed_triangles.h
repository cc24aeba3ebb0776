// Which triangles of a frame's meshes OpenGL must draw. Of a detailed model most take no pixel's
// centre or are hidden by others: without a GPU, finding out what those are costs a fraction of
// drawing them. What is left gives the same picture to the bit.
#pragma once

#include "tracer/geometry/pixel.h"
#include "viewer/raster/view_numbers.h"

#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// A mesh as one object shows it.
struct MeshInView {
    std::span<const glm::vec3> positions;
    std::span<const glm::uvec3> triangles;
    MeshNumbers numbers;
    bool hides_others = false;  // both its sides are there, and it has no holes
};

struct NeededTriangles {
    bool all = true;
    std::vector<std::uint32_t> triangles;  // unless all; ascending
};

// For each mesh in turn. The image has view.block.size.
std::vector<NeededTriangles> needed_triangles(const ViewNumbers& view, ImageSize size,
                                              std::span<const MeshInView> meshes);

}  // namespace raypick
