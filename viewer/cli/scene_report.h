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

// {"min": [x, y, z], "max": ...} in file coordinates; null if empty.
Json bounds_json(const Scene& scene, const Bounds& bounds);

// A vector as a JSON array.
Json vector_json(const glm::dvec3& v);

// Prints text that is not UTF-8 with replacement characters; `indent` as nlohmann's dump.
std::string dump(const Json& json, int indent = -1);

}  // namespace raypick
