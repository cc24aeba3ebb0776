// What of a scene a frame draws.
#pragma once

#include "viewer/raster/gpu_scene.h"
#include "viewer/raster/view_numbers.h"

#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// Corners of triangles to draw, in the index buffer.
struct IndexRun {
    std::size_t first = 0;
    std::size_t count = 0;
};

struct SeenObject {
    const DrawnObject* object = nullptr;
    // Of a mesh that isn't drawn in full, for each chunk. Corner k of the chunk's triangle i has
    // the index 3 i + k.
    std::vector<IndexRun> runs;
};

struct SeenObjects {
    std::vector<SeenObject> objects;  // in the scene's order
    std::vector<std::uint32_t> indices;
};

// Those of the mask that may show.
SeenObjects seen_objects(const GpuScene& scene, const ViewNumbers& view, std::uint32_t mask);

// Leaves out the triangles that can't be seen in the image of this size, for what draws slowly:
// see needed_triangles.h. The picture stays the same.
void leave_out_unseen(SeenObjects& seen, const ViewNumbers& view, ImageSize size);

}  // namespace raypick
