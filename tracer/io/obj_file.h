// The text of an OBJ file as numbers: everything checked, nothing interpreted yet.
#pragma once

#include "tracer/io/load.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace raypick {

// One corner of a face: indices from 0, or kNoIndex.
struct ObjCorner {
    static constexpr std::uint32_t kNoIndex = 0xffffffffu;

    std::uint32_t position = kNoIndex;
    std::uint32_t uv = kNoIndex;
    std::uint32_t normal = kNoIndex;
};

// Consecutive faces with the same `o`, `g` and `usemtl`: indices into the lists of names, or -1
// before the first such line.
struct ObjRun {
    std::uint32_t first_face = 0;
    int object = -1;
    int group = -1;
    int material = -1;
};

struct ObjFile {
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec3> normals;  // unit length, or 0 where the file's has no direction
    std::vector<ObjCorner> corners;
    std::vector<std::uint64_t> face_begin;  // in `corners`; one more than there are faces
    std::vector<ObjRun> runs;
    std::vector<std::string> objects;    // one an `o` line
    std::vector<std::string> groups;     // no name twice
    std::vector<std::string> materials;  // no name twice
    std::vector<std::string> libraries;  // the rest of each mtllib line

    [[nodiscard]] std::uint32_t face_count() const {
        return static_cast<std::uint32_t>(face_begin.size() - 1);
    }
    // Faces of runs[i].
    [[nodiscard]] std::uint32_t run_end(std::size_t i) const {
        return i + 1 < runs.size() ? runs[i + 1].first_face : face_count();
    }
};

// What one thread reads at a time.
inline constexpr std::size_t kObjChunkBytes = 1u << 19u;

// Throws FileError (with the line) or Cancelled. Whatever `chunk_bytes` is, the result is the same.
ObjFile parse_obj(const std::filesystem::path& file, const LoadOptions& options,
                  std::vector<std::string>& warnings, std::size_t chunk_bytes = kObjChunkBytes);

}  // namespace raypick
