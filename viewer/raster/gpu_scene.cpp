#include "viewer/raster/gpu_scene.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"
#include "viewer/gl/load_gl.h"

#include <algorithm>

namespace raypick {

namespace {

// Each mesh of the scene, taken over from `before` where it is there.
std::vector<std::shared_ptr<const GpuMesh>> upload_meshes(const Scene& scene,
                                                          const GpuScene& before) {
    const std::size_t max_texels = max_buffer_texels();
    std::vector<std::shared_ptr<const GpuMesh>> meshes;
    std::vector<std::shared_ptr<GpuMesh>> fresh;
    meshes.reserve(scene.meshes.size());
    for (const Mesh& mesh : scene.meshes) {
        const auto known = std::find_if(before.meshes.begin(), before.meshes.end(),
                                        [&mesh](const auto& other) { return other->holds(mesh); });
        if (known != before.meshes.end()) {
            meshes.push_back(*known);
        } else {
            meshes.push_back(fresh.emplace_back(std::make_shared<GpuMesh>(mesh, max_texels)));
        }
    }
    parallel_for(fresh.size(), 0, {}, [&](std::size_t i) { fresh[i]->fill(); });
    for (const std::shared_ptr<GpuMesh>& mesh : fresh)
        mesh->finish();
    return meshes;
}

// The same for sets; `upload` makes one.
template <typename Set, typename Upload>
std::vector<std::shared_ptr<const GpuSet<Set>>> upload_sets(
    const std::vector<Set>& sets, const std::vector<std::shared_ptr<const GpuSet<Set>>>& before,
    const Upload& upload) {
    std::vector<std::shared_ptr<const GpuSet<Set>>> uploaded;
    uploaded.reserve(sets.size());
    for (SetId id = 0; id < sets.size(); ++id) {
        const auto known = std::find_if(before.begin(), before.end(),
                                        [&](const auto& other) { return holds(*other, sets[id]); });
        uploaded.push_back(known != before.end() ? *known
                                                 : std::make_shared<GpuSet<Set>>(upload(id)));
    }
    return uploaded;
}

// Nothing of it can be drawn.
bool is_empty(const GpuScene& gpu, const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshInstance>(&shape)) {
        return gpu.meshes[mesh->mesh]->chunks().empty();
    }
    if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
        return gpu.sphere_sets[spheres->set]->chunks.empty();
    }
    const auto* cones = std::get_if<ConeSetInstance>(&shape);
    return cones != nullptr && gpu.cone_sets[cones->set]->chunks.empty();
}

SurfaceLook look_of(const GpuScene& gpu, const Object& object) {
    if (object.material != kNoMaterial) return gpu.materials.look(object.material);
    SurfaceLook look;
    for (const Part& part : parts_of(*gpu.scene, object.shape))
        look |= gpu.materials.look(part.material);
    return look;
}

// Corners relative to the first one, which keeps them exact far from the origin.
std::shared_ptr<const GpuMesh> upload_triangle(const Triangle& triangle) {
    MeshData data;
    data.positions = {glm::vec3(0.0f), glm::vec3(triangle.b - triangle.a),
                      glm::vec3(triangle.c - triangle.a)};
    data.uvs = {glm::vec2(0.0f), glm::vec2(1.0f, 0.0f), glm::vec2(0.0f, 1.0f)};  // barycentric
    data.triangles = {glm::uvec3(0, 1, 2)};
    return upload_mesh(make_mesh("triangle", std::move(data)), max_buffer_texels());
}

Transform inverse_of(const Object& object, const Transform& transform) {
    const auto inverted = inverse(transform);
    if (!inverted) throw Error("object " + object.name + ": its transform is singular");
    return *inverted;
}

// Fills in what depends on the kind of shape.
struct ShapeDrawing {
    const Scene& scene;
    const Object& object;
    const GpuScene& gpu;
    DrawnObject& drawn;

    void operator()(const MeshInstance& instance) const {
        drawn.shape = gpu.meshes[instance.mesh];
        const Bounds& bounds = gpu.meshes[instance.mesh]->bounds();
        drawn.bounds =
            world_bounds(drawn.scene_from_object, glm::dvec3(bounds.min), glm::dvec3(bounds.max));
    }
    void operator()(const Triangle& triangle) const {
        drawn.shape = upload_triangle(triangle);
        move_into(translate(triangle.a));
        drawn.bounds = object_bounds(scene, object);
    }
    void operator()(const Plane& plane) const { drawn.shape = plane; }
    void operator()(const SphereSetInstance& instance) const {
        take_set(gpu.sphere_sets[instance.set]);
    }
    void operator()(const ConeSetInstance& instance) const {
        take_set(gpu.cone_sets[instance.set]);
    }
    template <typename FiniteShape>
    void operator()(const FiniteShape& shape) const {
        drawn.bounds = object_bounds(scene, object);
        if constexpr (std::is_constructible_v<DrawnShape, FiniteShape>) {
            drawn.shape = shape;
        } else {
            drawn.shape = unit_shape(shape);
            move_into(object_from_unit(shape));
        }
    }

private:
    template <typename Set>
    void take_set(const std::shared_ptr<const GpuSet<Set>>& set) const {
        drawn.shape = set;
        drawn.bounds = world_bounds(drawn.scene_from_object, set->extent->min, set->extent->max);
    }

    // From here on the object's space is another one.
    void move_into(const Transform& object_from_inner) const {
        drawn.scene_from_object = drawn.scene_from_object * object_from_inner;
        drawn.object_from_scene = inverse_of(object, object_from_inner) * drawn.object_from_scene;
    }
};

DrawnObject drawn_object(const GpuScene& gpu, const Object& object) {
    DrawnObject drawn;
    drawn.id = object.id;
    drawn.mask = object.mask;
    drawn.material = object.material;
    drawn.sides = object.sides;
    drawn.look = look_of(gpu, object);
    drawn.scene_from_object = object.world_from_object;
    drawn.object_from_scene = inverse_of(object, object.world_from_object);
    std::visit(ShapeDrawing{*gpu.scene, object, gpu, drawn}, object.shape);
    return drawn;
}

}  // namespace

GpuScene upload_scene(std::shared_ptr<const Scene> scene, const GpuScene& before) {
    GpuScene gpu;
    gpu.scene = std::move(scene);
    gpu.meshes = upload_meshes(*gpu.scene, before);
    gpu.sphere_sets = upload_sets(gpu.scene->sphere_sets, before.sphere_sets, [&](SetId id) {
        return upload_sphere_set(*gpu.scene, id, max_buffer_texels());
    });
    gpu.cone_sets = upload_sets(gpu.scene->cone_sets, before.cone_sets, [&](SetId id) {
        return upload_cone_set(*gpu.scene, id, max_buffer_texels());
    });
    gpu.materials = upload_materials(*gpu.scene);
    for (const Object& object : gpu.scene->objects) {
        if (!is_empty(gpu, object.shape)) gpu.objects.push_back(drawn_object(gpu, object));
    }
    gpu.textures = upload_textures(*gpu.scene, before.textures);
    gpu.sky = upload_sky(gpu.scene->environment, before.sky);
    check_gl("uploading the scene");
    return gpu;
}

}  // namespace raypick
