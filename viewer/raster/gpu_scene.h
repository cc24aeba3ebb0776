// A scene on the GPU.
#pragma once

#include "tracer/scene/scene.h"
#include "viewer/raster/gpu_materials.h"
#include "viewer/raster/gpu_mesh.h"
#include "viewer/raster/gpu_sets.h"
#include "viewer/raster/gpu_sky.h"
#include "viewer/raster/gpu_textures.h"
#include "viewer/raster/unit_shapes.h"
#include "viewer/raster/view_numbers.h"

#include <memory>
#include <variant>
#include <vector>

namespace raypick {

// What a scene's object is to the rasteriser. Plain triangles are meshes of one.
using DrawnShape =
    std::variant<std::shared_ptr<const GpuMesh>, Sphere, Box, Plane, UnitDisk, UnitSquare, UnitCone,
                 UnitTorus, std::shared_ptr<const GpuSphereSet>, std::shared_ptr<const GpuConeSet>>;

struct DrawnObject {
    ObjectId id = kNoObject;
    std::uint32_t mask = 0;
    MaterialId material = kNoMaterial;
    Sides sides = Sides::both;
    SurfaceLook look;
    DrawnShape shape;
    Transform scene_from_object;
    Transform object_from_scene;
    Bounds bounds;  // scene space; empty: infinite
};

struct GpuScene {
    std::shared_ptr<const Scene> scene;
    std::vector<std::shared_ptr<const GpuMesh>> meshes;  // as in the scene; null: not drawn
    std::vector<std::shared_ptr<const GpuSphereSet>> sphere_sets;
    std::vector<std::shared_ptr<const GpuConeSet>> cone_sets;
    std::vector<DrawnObject> objects;  // ids ascending
    GpuMaterials materials;
    std::shared_ptr<const GpuTextures> textures;
    std::shared_ptr<const GpuSky> sky;
};

// Meshes and sets that `before` has on the GPU already stay there. Throws Error if an object's
// transform is singular or the GPU has no room.
GpuScene upload_scene(std::shared_ptr<const Scene> scene, const GpuScene& before);

}  // namespace raypick
