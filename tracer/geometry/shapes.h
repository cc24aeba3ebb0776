// Analytic shapes and the mesh, in object space, and their exact ray intersections.
//
// Shapes are plain structs. The functions here are the ONE place that decides where a ray meets a
// shape: they work in double on the float ray, so a hit is the same for every caller and order.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/geometry/transform.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace raypick {

using MaterialId = std::uint32_t;
inline constexpr MaterialId kNoMaterial = 0xffffffffu;

struct Sphere {
    glm::dvec3 centre{0.0};
    double radius = 1.0;
};

// The points with dot(normal, p) + d = 0. Infinite; the outside is where the normal points.
struct Plane {
    glm::dvec3 normal{0.0, 1.0, 0.0};
    double d = 0.0;
};

// Counter-clockwise seen from outside.
struct Triangle {
    glm::dvec3 a{0.0, 0.0, 0.0};
    glm::dvec3 b{1.0, 0.0, 0.0};
    glm::dvec3 c{0.0, 1.0, 0.0};
};

struct Box {
    glm::dvec3 min{-0.5};
    glm::dvec3 max{0.5};
};

// Flat and round, with a hole if inner_radius > 0. The outside is where the normal points.
struct Disk {
    glm::dvec3 centre{0.0};
    glm::dvec3 normal{0.0, 1.0, 0.0};  // any length but 0
    double radius = 1.0;
    double inner_radius = 0.0;
};

// The parallelogram corner + a edge_u + b edge_v with a, b in [0, 1]. The outside is where
// cross(edge_u, edge_v) points.
struct Rectangle {
    glm::dvec3 corner{-0.5, 0.0, 0.5};
    glm::dvec3 edge_u{1.0, 0.0, 0.0};
    glm::dvec3 edge_v{0.0, 0.0, -1.0};
};

// A truncated cone of revolution, a cylinder if the radii are equal; open, or with a disk at either
// end. At most one radius may be 0.
struct Cone {
    glm::dvec3 base{0.0};
    glm::dvec3 apex{0.0, 1.0, 0.0};
    double base_radius = 1.0;
    double apex_radius = 1.0;
    bool capped = true;
};

// A ring torus: minor_radius <= major_radius.
struct Torus {
    glm::dvec3 centre{0.0};
    glm::dvec3 axis{0.0, 1.0, 0.0};  // any length but 0
    double major_radius = 1.0;
    double minor_radius = 0.25;
};

// A material range of a mesh or a set: the primitives [first, first + count) in file order.
struct Part {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    MaterialId material = kNoMaterial;

    friend bool operator==(const Part&, const Part&) = default;
};

// Vertex arrays that a Mesh may own.
struct MeshData {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> uvs;
    std::vector<glm::uvec3> triangles;
};

// Triangles over indexed vertices. The arrays belong to `storage`, or to the caller if that is
// null, who then keeps them alive and unchanged. Copying a Mesh copies no vertex.
struct Mesh {
    std::string name;
    std::span<const glm::vec3> positions;
    std::span<const glm::vec3> normals;     // one a vertex, unit length; or empty: flat shading
    std::span<const glm::vec2> uvs;         // one a vertex, v up; or empty
    std::span<const glm::uvec3> triangles;  // indices into `positions`, counter-clockwise
    std::vector<Part> parts;                // ascending, covering all triangles; or empty
    std::shared_ptr<const MeshData> storage;
};

// A mesh that owns its arrays.
Mesh make_mesh(std::string name, MeshData data, std::vector<Part> parts = {});

// A mesh over the caller's arrays, which are not copied.
Mesh borrow_mesh(std::string name, std::span<const glm::vec3> positions,
                 std::span<const glm::uvec3> triangles, std::span<const glm::vec3> normals = {});

// Many spheres as one object, each a primitive: xyz is the centre, w the radius, > 0. The array
// belongs to `storage`, or to the caller if that is null, as for a Mesh.
struct SphereSet {
    std::string name;
    std::span<const glm::vec4> spheres;
    std::vector<Part> parts;  // ascending, covering all spheres; or empty
    std::shared_ptr<const std::vector<glm::vec4>> storage;
};

// Many truncated cones as one object, each a primitive: elements 2i and 2i + 1 are base and apex of
// cone i, xyz the centre and w the radius there.
struct ConeSet {
    std::string name;
    std::span<const glm::vec4> ends;
    bool capped = false;
    std::vector<Part> parts;  // ascending, covering all cones; or empty
    std::shared_ptr<const std::vector<glm::vec4>> storage;

    [[nodiscard]] std::size_t size() const { return ends.size() / 2; }
};

// Sets that own their arrays.
SphereSet make_sphere_set(std::string name, std::vector<glm::vec4> spheres,
                          std::vector<Part> parts = {});
ConeSet make_cone_set(std::string name, std::vector<glm::vec4> ends, bool capped,
                      std::vector<Part> parts = {});

// One element of a set.
inline Sphere sphere_of(const SphereSet& set, std::uint32_t primitive) {
    const glm::dvec4 sphere(set.spheres[primitive]);
    return {glm::dvec3(sphere), sphere.w};
}
inline Cone cone_of(const ConeSet& set, std::uint32_t primitive) {
    const std::size_t first = std::size_t{2} * primitive;
    const glm::dvec4 base(set.ends[first]);
    const glm::dvec4 apex(set.ends[first + 1]);
    return {glm::dvec3(base), glm::dvec3(apex), base.w, apex.w, set.capped};
}

// Throw Error that names the first sphere or cone that is not finite, has no size, or that parts
// don't cover, as check_mesh.
void check_set(const SphereSet& set);
void check_set(const ConeSet& set);

// Throws Error if an index is out of range, an array has the wrong length, the parts don't cover
// the triangles or there are more than 2^30 of these; the message names the first offender.
void check_mesh(const Mesh& mesh);

// The part that holds a primitive; nullptr if there are none.
const Part* part_of(std::span<const Part> parts, std::uint32_t primitive);
const Part* part_of(const Mesh& mesh, std::uint32_t triangle);

// A ray in some object's space, in double: the direction is NOT renormalised, so t is the world
// ray's t.
struct ObjectRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
};

// Where a ray meets a shape. uv: barycentric (weights of the second and third corner) on triangles;
// longitude and colatitude over 2 pi and pi on spheres; the two free coordinates on planes; face
// coordinates in [0, 1] on boxes; the weights of the edges on rectangles; angle over 2 pi and
// radius over the outer radius on disks and caps; angle over 2 pi and height from base to apex
// in [0, 1] on cones; angle about the axis and about the tube over 2 pi on tori.
struct ShapeHit {
    double t = 0.0;
    glm::dvec2 uv{0.0};
    glm::dvec3 normal{0.0};  // geometric, outward, object space, not normalised
    // Of a box: face 0..5 = -x +x -y +y -z +z; of a cone: side 0, base cap 1, apex cap 2; 0 on the
    // others.
    std::uint32_t primitive = 0;
};

// At most four hits, nearest first: a ray meets a plane or a triangle once, a sphere, a box or a
// cone up to twice, a torus up to four times.
struct ShapeHits {
    std::array<ShapeHit, 4> hit;
    int count = 0;
};

// Where a ray's line meets a sphere; nothing if it misses. The hit at one of them takes an arc
// tangent more.
struct SphereRoots {
    double t[2] = {0.0, 0.0};  // ascending
};
std::optional<SphereRoots> sphere_roots(const Sphere& sphere, const ObjectRay& ray);
ShapeHit sphere_hit(const Sphere& sphere, const ObjectRay& ray, double t);

ShapeHits intersect(const Sphere& sphere, const ObjectRay& ray);
ShapeHits intersect(const Plane& plane, const ObjectRay& ray);
ShapeHits intersect(const Triangle& triangle, const ObjectRay& ray);
ShapeHits intersect(const Box& box, const ObjectRay& ray);
ShapeHits intersect(const Disk& disk, const ObjectRay& ray);
ShapeHits intersect(const Rectangle& rectangle, const ObjectRay& ray);
ShapeHits intersect(const Cone& cone, const ObjectRay& ray);
ShapeHits intersect(const Torus& torus, const ObjectRay& ray);

}  // namespace raypick
