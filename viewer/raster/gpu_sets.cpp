#include "viewer/raster/gpu_sets.h"

#include <algorithm>

namespace raypick {

namespace {

// Six vertices an element, and OpenGL counts vertices in an int.
constexpr std::size_t kMostElements = std::size_t{1} << 28;

// By the number of the element, from `first` on.
std::vector<MaterialId> materials_of(std::span<const Part> parts, std::size_t first,
                                     std::size_t count) {
    std::vector<MaterialId> materials(count, kNoMaterial);
    for (const Part& part : parts) {
        const std::size_t begin = std::max<std::size_t>(part.first, first);
        const std::size_t end =
            std::min<std::size_t>(std::size_t{part.first} + part.count, first + count);
        for (std::size_t i = begin; i < end; ++i)
            materials[i - first] = part.material;
    }
    return materials;
}

// `texels` holds `texels_each` for each element.
std::vector<SetChunk> upload_chunks(std::span<const glm::vec4> texels, std::size_t texels_each,
                                    std::span<const Part> parts, std::size_t max_texels) {
    const std::size_t most = std::min(max_texels / texels_each, kMostElements);
    const std::size_t total = texels.size() / texels_each;
    std::vector<SetChunk> chunks;
    for (std::size_t first = 0; first < total; first += most) {
        const std::size_t count = std::min(most, total - first);
        const auto run = texels.subspan(first * texels_each, count * texels_each);
        SetChunk& chunk = chunks.emplace_back();
        chunk.first = static_cast<std::uint32_t>(first);
        chunk.count = static_cast<std::uint32_t>(count);
        chunk.elements = {GL_RGBA32F, sizeof(glm::vec4), std::as_bytes(run), "spheres or cones"};
        chunk.has_materials = !parts.empty();
        if (!chunk.has_materials) continue;
        const std::vector<MaterialId> materials = materials_of(parts, first, count);
        chunk.materials = {GL_R32UI, sizeof(MaterialId), std::as_bytes(std::span(materials)),
                           "materials of a set"};
    }
    return chunks;
}

bool same_arrays(std::span<const glm::vec4> a, std::span<const glm::vec4> b,
                 const std::vector<Part>& a_parts, const std::vector<Part>& b_parts) {
    return a.data() == b.data() && a.size() == b.size() && a_parts == b_parts;
}

}  // namespace

GpuSphereSet upload_sphere_set(const Scene& scene, SetId id, std::size_t max_texels) {
    const SphereSet& set = scene.sphere_sets[id];
    return {set, object_extent(scene, SphereSetInstance{id}),
            upload_chunks(set.spheres, 1, set.parts, max_texels)};
}

GpuConeSet upload_cone_set(const Scene& scene, SetId id, std::size_t max_texels) {
    const ConeSet& set = scene.cone_sets[id];
    return {set, object_extent(scene, ConeSetInstance{id}),
            upload_chunks(set.ends, 2, set.parts, max_texels)};
}

bool holds(const GpuSphereSet& gpu, const SphereSet& set) {
    return same_arrays(gpu.set.spheres, set.spheres, gpu.set.parts, set.parts);
}

bool holds(const GpuConeSet& gpu, const ConeSet& set) {
    return gpu.set.capped == set.capped &&
           same_arrays(gpu.set.ends, set.ends, gpu.set.parts, set.parts);
}

}  // namespace raypick
