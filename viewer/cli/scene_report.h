// Counts and sizes of a scene, as people and scripts want to know them.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/scene/scene.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>

namespace raypick {

using Json = nlohmann::ordered_json;

struct SceneCounts {
    std::uint64_t triangles = 0;         // as placed: an instance counts like a copy
    std::uint64_t unique_triangles = 0;  // as stored
    std::uint64_t primitives = 0;        // as placed: triangles, spheres, planes, faces of boxes
};

SceneCounts count(const Scene& scene);

// Bytes of the arrays of all meshes; an array used twice counts once.
std::uint64_t mesh_bytes(const Scene& scene);

// The most memory that this process ever had, in bytes.
std::uint64_t peak_memory_bytes();

// "objects", "triangles", ... for a JSON object of statistics.
void add_counts(Json& json, const Scene& scene);

// Bounds of one object, or of all finite visible ones, in file coordinates and as tight as double
// numbers are; nothing for infinite planes and empty meshes.
std::optional<ObjectExtent> file_extent(const Scene& scene, const Object& object);
std::optional<ObjectExtent> file_extent(const Scene& scene);

// {"min": [x, y, z], "max": [x, y, z]}, or null.
Json extent_json(const std::optional<ObjectExtent>& extent);

// A vector as a JSON array. Floats are written as the shortest decimals that read back as the same
// float, so that 0.8f is 0.8.
Json vector_json(const glm::dvec3& v);
Json vector_json(const glm::vec3& v);
double shortest_decimal(float value);

// On one line; what is not valid UTF-8 becomes U+FFFD.
std::string dump(const Json& json);

}  // namespace raypick
