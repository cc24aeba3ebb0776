// Analytic shapes and the mesh, in object space, and their exact ray intersections.
//
// Shapes are plain structs. The functions here are the ONE place that decides where a ray meets a
// shape: they work in double on the float ray, so a hit is the same for every caller and order.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/geometry/transform.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
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

// A material range of a mesh: the triangles [first, first + count) in file order.
struct Part {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    MaterialId material = kNoMaterial;
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

// Throws Error if an index is out of range, an array has the wrong length, the parts don't cover
// the triangles or there are more than 2^30 of these; the message names the first offender.
void check_mesh(const Mesh& mesh);

// The part that holds a triangle; nullptr if the mesh has no parts.
const Part* part_of(const Mesh& mesh, std::uint32_t triangle);

// A ray in some object's space, in double: the direction is NOT renormalised, so t is the world
// ray's t.
struct ObjectRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
};

// Where a ray meets a shape. uv: barycentric (weights of the second and third corner) on triangles;
// longitude and colatitude over 2 pi and pi on spheres; the two free coordinates on planes; face
// coordinates in [0, 1] on boxes.
struct ShapeHit {
    double t = 0.0;
    glm::dvec2 uv{0.0};
    glm::dvec3 normal{0.0};       // geometric, outward, object space, not normalised
    std::uint32_t primitive = 0;  // of a box: face 0..5 = -x +x -y +y -z +z; 0 on the others
};

// At most two hits, nearest first: a ray meets a plane or a triangle once, a sphere or a box twice.
struct ShapeHits {
    ShapeHit hit[2];
    int count = 0;
};

ShapeHits intersect(const Sphere& sphere, const ObjectRay& ray);
ShapeHits intersect(const Plane& plane, const ObjectRay& ray);
ShapeHits intersect(const Triangle& triangle, const ObjectRay& ray);
ShapeHits intersect(const Box& box, const ObjectRay& ray);

}  // namespace raypick
