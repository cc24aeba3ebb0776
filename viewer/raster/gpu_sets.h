// Sets of spheres and of cones on the GPU.
#pragma once

#include "tracer/scene/scene.h"
#include "viewer/gl/textures.h"

#include <optional>
#include <vector>

namespace raypick {

// One draw: a run of a set's elements with all that its shader reads.
struct SetChunk {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    BufferTexture elements;   // the set's own array: a texel a sphere, two a cone
    BufferTexture materials;  // one an element, if the set has parts
    bool has_materials = false;
};

template <typename Set>
struct GpuSet {
    Set set;  // what was uploaded
    std::optional<ObjectExtent> extent;
    std::vector<SetChunk> chunks;  // none: an empty set
};
using GpuSphereSet = GpuSet<SphereSet>;
using GpuConeSet = GpuSet<ConeSet>;

// Buffer textures get at most `max_texels` elements; more are spread over several draws.
GpuSphereSet upload_sphere_set(const Scene& scene, SetId id, std::size_t max_texels);
GpuConeSet upload_cone_set(const Scene& scene, SetId id, std::size_t max_texels);

// True if these are the very arrays and parts of `set`, as GpuMesh::holds.
bool holds(const GpuSphereSet& gpu, const SphereSet& set);
bool holds(const GpuConeSet& gpu, const ConeSet& set);

}  // namespace raypick
