// The triangles of a mesh's tree, leaf by leaf: what a ray needs of a leaf lies in one piece of
// memory, corners that its triangles share only once.
//
// Memory: 16 bytes a patch, 12 a corner, 4 a triangle; about 25 bytes a triangle.
#pragma once

#include "tracer/accel/joined_meshes.h"
#include "tracer/bvh/bvh_fast.h"
#include "tracer/bvh/wide_bvh.h"
#include "tracer/parallel/large_array.h"
#include "tracer/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace raypick {

// Up to eight triangles on up to sixteen corners. Corner k of triangle i is number
// (corner[k] >> 4 i) & 15; beyond the last triangle it is 0.
struct TrianglePatch {
    static constexpr std::uint32_t kMostTriangles = 8;
    static constexpr std::uint32_t kMostCorners = 16;

    std::uint8_t triangles = 0;
    std::uint8_t corners = 0;
    std::uint16_t last : 1 = 0;     // 1: of its leaf
    std::uint16_t member : 15 = 0;  // whose triangles they are, in a tree over several meshes
    std::uint32_t corner[3] = {0, 0, 0};

    // Of the mesh: one a triangle.
    [[nodiscard]] const std::uint32_t* primitives() const {
        return reinterpret_cast<const std::uint32_t*>(this + 1);
    }
    // Coordinates of all corners along an axis. At least sixteen can be read.
    [[nodiscard]] const float* along(int axis) const {
        return reinterpret_cast<const float*>(primitives() + triangles) +
               static_cast<std::ptrdiff_t>(axis) * corners;
    }
    [[nodiscard]] glm::vec3 position(std::uint32_t triangle, int k) const {
        const float* at = along(0) + ((corner[k] >> (4 * triangle)) & 15u);
        return {at[0], at[corners], at[std::size_t{2} * corners]};
    }
    // In blocks; the next patch of a leaf with more triangles follows.
    [[nodiscard]] std::size_t size() const { return size(triangles, corners); }
    [[nodiscard]] static std::size_t size(std::size_t triangles, std::size_t corners) {
        return (4 + triangles + 3u * corners + 3) / 4;
    }
};

struct TrianglePatches {
    struct alignas(16) Block {
        std::byte bytes[16];
    };
    LargeArray<Block> blocks;

    [[nodiscard]] const TrianglePatch& at(std::size_t block) const {
        return *reinterpret_cast<const TrianglePatch*>(blocks.data() + block);
    }
    [[nodiscard]] std::uint64_t bytes() const { return blocks.size() * sizeof(Block); }
};

// Puts the leaves' triangles into patches: a leaf's index is its first patch's block then, and the
// tree's indices, of the meshes' triangles, are gone. The same for any number of threads. Throws
// Cancelled.
TrianglePatches take_triangles(WideBvh& bvh, const JoinedMeshes& meshes, int threads,
                               const std::stop_token& stop);
// Of one mesh.
inline TrianglePatches take_triangles(WideBvh& bvh, const Mesh& mesh, int threads,
                                      const std::stop_token& stop) {
    return take_triangles(bvh, JoinedMeshes({&mesh}), threads, stop);
}

// Puts a first tree's leaves into patches as they are made: a leaf's place is its first patch's
// block.
class PatchStore {
public:
    // The meshes must outlive it.
    PatchStore(const JoinedMeshes& meshes, std::size_t keys);

    [[nodiscard]] LeafStore leaves();
    // The patches of all chunks, one after the other.
    [[nodiscard]] TrianglePatches take();

private:
    std::size_t store(std::size_t chunk, std::span<const MortonKey> keys,
                      std::span<TreeletLeaf> leaves);
    void append(std::size_t chunk);

    const JoinedMeshes& meshes_;
    std::vector<LargeArray<TrianglePatches::Block>> chunks_;
    TrianglePatches patches_;
};

// Calls body(patch) for a leaf's patches until it returns true, and returns whether it did.
template <typename Body>
bool each_patch(const TrianglePatches& patches, const WideRef& leaf, const Body& body) {
    std::size_t block = leaf.index();
    while (true) {
        const TrianglePatch& patch = patches.at(block);
        if (body(patch)) return true;
        if (patch.last != 0) return false;
        block += patch.size();
    }
}

}  // namespace raypick
