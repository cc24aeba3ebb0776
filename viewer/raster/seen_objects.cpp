#include "viewer/raster/seen_objects.h"

#include "viewer/raster/needed_triangles.h"

#include <algorithm>

namespace raypick {

namespace {

const GpuMesh* mesh_of(const SeenObject& seen) {
    const auto* mesh = std::get_if<std::shared_ptr<const GpuMesh>>(&seen.object->shape);
    return mesh != nullptr ? mesh->get() : nullptr;
}

MeshInView in_view(const ViewNumbers& view, const DrawnObject& object, const Mesh& mesh) {
    return {mesh.positions, mesh.triangles,
            mesh_numbers(view, object.scene_from_object, object.object_from_scene),
            object.sides == Sides::both && !object.look.cut_out};
}

// The triangles of a chunk, which are those from `first` up to `end` of the mesh.
IndexRun add_run(std::vector<std::uint32_t>& indices, std::span<const std::uint32_t> triangles,
                 const GpuMesh::Chunk& chunk) {
    const auto first = std::lower_bound(triangles.begin(), triangles.end(), chunk.first);
    const auto end = std::lower_bound(first, triangles.end(), chunk.first + chunk.count);
    const std::size_t begin = indices.size();
    for (auto triangle = first; triangle != end; ++triangle) {
        const std::uint32_t corner = 3 * (*triangle - chunk.first);
        indices.insert(indices.end(), {corner, corner + 1, corner + 2});
    }
    return {begin, indices.size() - begin};
}

}  // namespace

SeenObjects seen_objects(const GpuScene& scene, const ViewNumbers& view, std::uint32_t mask) {
    SeenObjects seen;
    for (const DrawnObject& object : scene.objects) {
        if ((object.mask & mask) == 0 || !may_be_seen(view, object.bounds)) continue;
        seen.objects.push_back({&object, {}});
    }
    return seen;
}

void leave_out_unseen(SeenObjects& seen, const ViewNumbers& view, ImageSize size) {
    std::vector<MeshInView> meshes;
    std::vector<SeenObject*> owners;
    for (SeenObject& object : seen.objects) {
        const GpuMesh* mesh = mesh_of(object);
        if (mesh == nullptr) continue;
        meshes.push_back(in_view(view, *object.object, mesh->mesh()));
        owners.push_back(&object);
    }
    const std::vector<NeededTriangles> needed = needed_triangles(view, size, meshes);
    for (std::size_t i = 0; i < needed.size(); ++i) {
        if (needed[i].all) continue;
        for (const GpuMesh::Chunk& chunk : mesh_of(*owners[i])->chunks())
            owners[i]->runs.push_back(add_run(seen.indices, needed[i].triangles, chunk));
    }
    std::erase_if(seen.objects, [](const SeenObject& object) {
        return !object.runs.empty() &&
               std::all_of(object.runs.begin(), object.runs.end(),
                           [](const IndexRun& run) { return run.count == 0; });
    });
}

}  // namespace raypick
