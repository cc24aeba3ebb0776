// Surface points on triangles, many at once.
#pragma once

#include "tracer/accel/surface.h"
#include "tracer/accel/surface_rows.h"
#include "tracer/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace raypick {

// Works the surface points of a mesh's hits out together, as vectors of whatever width the
// processor has. What set_surface_point says, to the bit.
class TriangleSurfaces {
public:
    // Whether add() takes such hits: triangles of a mesh that nothing moves.
    [[nodiscard]] static bool takes(const HitObject& at);

    // Of the hit that these rows have in this lane.
    void add(std::size_t lane, const Mesh& mesh, const Hit& hit);
    // Sets the points of the rows' hits, all of which have been added. Returns bits of those so
    // near an edge that they want a closer look: set_surface_point's.
    std::uint32_t find(SurfaceRows& rows) const;

    // One float of each hit goes into each of these rows: corners, their normals (0 where there are
    // none) and uv.
    static constexpr std::size_t kCorners = 0;
    static constexpr std::size_t kNormals = 9;
    static constexpr std::size_t kU = 18;
    static constexpr std::size_t kV = 19;
    static constexpr std::size_t kInputs = 20;
    static constexpr std::size_t kLanes = SurfaceRows::kLanes;
    struct Inputs {
        alignas(64) std::array<float, kInputs * kLanes> row{};
    };

private:
    Inputs in_;
};

inline void TriangleSurfaces::add(std::size_t lane, const Mesh& mesh, const Hit& hit) {
    float* const in = &in_.row[lane];
    const glm::uvec3& corner = mesh.triangles[hit.primitive];
    const bool smooth = !mesh.normals.empty();
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = corner[static_cast<int>(k)];
        put_vector<kLanes>(in, kCorners + 3 * k, mesh.positions[vertex]);
        put_vector<kLanes>(in, kNormals + 3 * k, smooth ? mesh.normals[vertex] : glm::vec3(0.0f));
    }
    in[kU * kLanes] = hit.uv.x;
    in[kV * kLanes] = hit.uv.y;
}

}  // namespace raypick
