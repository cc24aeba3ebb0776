// A scene on the GPU.
#pragma once

#include "tracer/scene/scene.h"
#include "viewer/raster/gpu_mesh.h"
#include "viewer/raster/view_numbers.h"

#include <memory>
#include <variant>
#include <vector>

namespace raypick {

// What a scene's object is to the rasteriser. Plain triangles are meshes of one.
using DrawnShape = std::variant<std::shared_ptr<const GpuMesh>, Sphere, Box, Plane>;

struct DrawnObject {
    ObjectId id = kNoObject;
    std::uint32_t mask = 0;
    MaterialId material = kNoMaterial;
    DrawnShape shape;
    Transform scene_from_object;
    Transform object_from_scene;
    Bounds bounds;  // scene space; empty: infinite
};

struct GpuScene {
    std::shared_ptr<const Scene> scene;
    std::vector<std::shared_ptr<const GpuMesh>> meshes;  // as in the scene; null: not drawn
    std::vector<DrawnObject> objects;                    // ids ascending
    BufferTexture materials;                             // four texels each, the default last
};

// Meshes that `before` has on the GPU already stay there. Throws Error if an object's transform is
// singular or the GPU has no room.
GpuScene upload_scene(std::shared_ptr<const Scene> scene, const GpuScene& before);

// The lights of a view, two texels each: place relative to `eye` and 1 for a point, unit direction
// to the light and 0 for a directional light; then the colour.
struct GpuLights {
    BufferTexture texels;
    int count = 0;
};
GpuLights upload_lights(const std::vector<Light>& lights, const glm::dvec3& eye);

}  // namespace raypick
