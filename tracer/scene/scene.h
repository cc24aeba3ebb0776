// The scene: arrays of values tied together by integer ids.
#pragma once

#include "tracer/geometry/camera.h"
#include "tracer/geometry/shapes.h"
#include "tracer/geometry/transform.h"
#include "tracer/scene/environment.h"
#include "tracer/scene/light.h"
#include "tracer/scene/material.h"
#include "tracer/scene/texture.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

namespace raypick {

using ObjectId = std::uint32_t;
inline constexpr ObjectId kNoObject = 0xffffffffu;

using MeshId = std::uint32_t;
using SetId = std::uint32_t;

// A use of scene.meshes[mesh].
struct MeshInstance {
    MeshId mesh = 0;
};

// Uses of scene.sphere_sets[set] and scene.cone_sets[set].
struct SphereSetInstance {
    SetId set = 0;
};
struct ConeSetInstance {
    SetId set = 0;
};

using Shape = std::variant<Sphere, Plane, Triangle, Box, MeshInstance, Disk, Rectangle, Cone, Torus,
                           SphereSetInstance, ConeSetInstance>;

// The sides of a surface that rays, picks and the screen see.
enum class Sides { both, front_only, back_only };

// One placed instance of one named thing: what a click selects.
struct Object {
    ObjectId id = kNoObject;  // given by add_object; never reused within a session
    std::string name;         // unique in the scene: a second "wheel" is "wheel#2"
    std::string path{};       // place in the file's tree, e.g. "/truck/axle/wheel"
    Shape shape{};
    Transform world_from_object{};
    MaterialId material = kNoMaterial;  // overrides the mesh's parts; kNoMaterial: use the parts
    std::uint32_t mask = 0xffffffffu;   // visible to a ray if (mask & query mask) != 0
    Sides sides = Sides::both;          // the others are not there for any ray
};

struct NamedCamera {
    std::string name;
    Camera camera;
};

// Everything is relative to `origin`: file coordinates = origin + scene coordinates.
struct Scene {
    glm::dvec3 origin{0.0};
    std::vector<Mesh> meshes;
    std::vector<SphereSet> sphere_sets;
    std::vector<ConeSet> cone_sets;
    std::vector<Object> objects;  // ids ascending
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Light> lights;  // none: a headlight
    std::vector<NamedCamera> cameras;
    glm::vec3 background{0.18f, 0.20f, 0.23f};  // where there is no other environment
    Environment environment;
    glm::vec3 ambient{0.1f};
    ObjectId next_object_id = 0;
    // Kept by add_object: every name given so far, with the last number behind a "#" of it.
    std::unordered_map<std::string, std::uint32_t> used_names;
};

// Appends an object, gives it the next id and makes its name unique ("" becomes "object"); an empty
// path becomes "/" and the name. A name is not given again after its object is gone. Returns the
// id. The caller sees to it that mesh and material ids exist (check_scene).
ObjectId add_object(Scene& scene, Object object);
MaterialId add_material(Scene& scene, Material material);
MeshId add_mesh(Scene& scene, Mesh mesh);
SetId add_sphere_set(Scene& scene, SphereSet set);
SetId add_cone_set(Scene& scene, ConeSet set);
TextureId add_texture(Scene& scene, Texture texture);

// nullptr if there is no such object (any more).
const Object* find_object(const Scene& scene, ObjectId id);
// Index into scene.objects of an id that exists.
std::size_t object_index(const Scene& scene, ObjectId id);

// The material of a primitive; a grey default if neither object nor part names one.
MaterialId material_id(const Scene& scene, const Object& object, std::uint32_t primitive);
const Material& material(const Scene& scene, MaterialId id);
// The material ranges of the shape's mesh or set; none for other shapes.
std::span<const Part> parts_of(const Scene& scene, const Shape& shape);

// Number of primitives: the mesh's triangles, the set's spheres or cones, 6 faces of a box, a cone
// and its caps, else 1.
std::uint32_t primitive_count(const Scene& scene, const Object& object);

// Bounds in object space; nothing for an infinite plane, an empty mesh or set.
struct ObjectExtent {
    glm::dvec3 min{0.0};
    glm::dvec3 max{0.0};
};
std::optional<ObjectExtent> object_extent(const Scene& scene, const Shape& shape);
ObjectExtent shape_extent(const Cone& cone);

// World bounds of one object and of all finite visible objects. Infinite planes don't count: their
// bounds are empty.
Bounds object_bounds(const Scene& scene, const Object& object);
Bounds scene_bounds(const Scene& scene);

// Chooses the scene's origin: 0 where float coordinates resolve the scene well, else the middle of
// its bounds. Moves objects, lights and cameras, so that file coordinates stay what they were.
void choose_origin(Scene& scene);

// The first camera of the file; without one, a view from the front, right and above that frames
// the bounds. `near` is set from the bounds.
Camera default_camera(const Scene& scene, ImageSize size, const glm::dvec3& up = {0, 1, 0});

// What a person says about the camera, in file coordinates; the rest comes from the file or from
// default_camera.
struct CameraOverride {
    std::optional<glm::dvec3> eye;
    std::optional<glm::dvec3> at;
    std::optional<glm::dvec3> up;
    std::optional<double>
        fovy;  // degrees; asks for a perspective view unless `projection` is given
    // Without an eye, an orthographic view that the file doesn't have stands before all of the
    // scene and, without a height, keeps the size of what lies in the plane through `at`.
    std::optional<Projection> projection;
    std::optional<double> height;  // of an orthographic view
};

// The camera to begin with. Throws Error (check_camera) if the numbers make no view.
Camera choose_camera(const Scene& scene, ImageSize size, const CameraOverride& wanted);

// The scene's lights as seen from this camera: the scene's own, or a headlight.
std::vector<Light> effective_lights(const Scene& scene, const Camera& camera);

// Throws Error that names the object, the key and the value if an id dangles, a number is not
// finite, a colour is negative, a radius is not positive, a normal is zero or a transform is
// singular.
void check_scene(const Scene& scene);

}  // namespace raypick
