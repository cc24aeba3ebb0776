#include "tracer/accel/triangle_patches.h"

#include "tracer/bvh/float4.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <stdexcept>

namespace raypick {

namespace {

// The corners of a leaf's next triangles, and the patch of as many of them as fit into one.
class PatchMaker {
public:
    // Of the first eight primitives at most.
    PatchMaker(const Mesh& mesh, std::span<const std::uint32_t> primitives) {
        const std::size_t most = std::min<std::size_t>(primitives.size(), kTriangles);
        for (std::size_t i = 0; i < most; ++i) {
            primitives_[i] = primitives[i] & ~WideBvh::kLast;
            const glm::uvec3 t = mesh.triangles[primitives_[i]];
            for (int k = 0; k < 3; ++k)
                put_corner(3 * i + static_cast<std::size_t>(k), mesh.positions[t[k]]);
        }
        while (patch_.triangles < most && add_triangle(patch_.triangles)) {
        }
    }

    [[nodiscard]] std::uint32_t triangles() const { return patch_.triangles; }
    void finish_leaf() { patch_.last = 1; }

    void append_to(std::vector<TrianglePatches::Block>& blocks) const {
        const std::size_t first = blocks.size();
        blocks.resize(first + patch_.size());
        auto* at = reinterpret_cast<std::byte*>(blocks.data() + first);
        const auto put = [&at](const void* from, std::size_t bytes) {
            std::memcpy(at, from, bytes);
            at += bytes;
        };
        put(&patch_, sizeof patch_);
        put(primitives_.data(), patch_.triangles * sizeof(std::uint32_t));
        for (const Coordinates& along : coordinates_)
            put(along.data(), patch_.corners * sizeof(float));
    }

private:
    static constexpr std::size_t kTriangles = TrianglePatch::kMostTriangles;
    // With room for a last triangle that doesn't fit.
    using Coordinates = std::array<std::int32_t, TrianglePatch::kMostCorners + 3>;  // as bits

    void put_corner(std::size_t i, const glm::vec3& position) {
        const auto at = std::bit_cast<std::array<std::int32_t, 3>>(position);
        for (std::size_t axis = 0; axis < 3; ++axis)
            corners_[axis][i / 4][i % 4] = at[axis];
    }

    // The first corner at the position of corner i, bit for bit. Looks at all up to i at once,
    // four by four: which of them it is can't be foretold, so that a branch would be costly.
    [[nodiscard]] std::size_t first_like(std::size_t i) const {
        const std::size_t last = i / 4;
        const Int4 x = all4(corners_[0][last][i % 4]);
        const Int4 y = all4(corners_[1][last][i % 4]);
        const Int4 z = all4(corners_[2][last][i % 4]);
        Int4 bit{1, 2, 4, 8};
        Int4 same{};
        for (std::size_t v = 0; v <= last; ++v) {
            same |= (corners_[0][v] == x) & (corners_[1][v] == y) & (corners_[2][v] == z) & bit;
            bit <<= 4;
        }
        same |= __builtin_shufflevector(same, same, 2, 3, 0, 1);
        return static_cast<std::size_t>(
            std::countr_zero(static_cast<std::uint32_t>(same[0] | same[1])));
    }

    // False if there is no room for its corners.
    bool add_triangle(std::uint32_t triangle) {
        std::uint32_t corners = patch_.corners;
        std::array<std::uint32_t, 3> numbers{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = 3 * std::size_t{triangle} + k;
            const std::size_t first = first_like(i);
            numbers[k] = first == i ? corners : numbers_[first];
            corners += first == i ? 1u : 0u;
            numbers_[i] = numbers[k];
            for (std::size_t axis = 0; axis < 3; ++axis)
                coordinates_[axis][numbers[k]] = corners_[axis][i / 4][i % 4];
        }
        if (corners > TrianglePatch::kMostCorners) return false;
        for (std::size_t k = 0; k < 3; ++k)
            patch_.corner[k] |= numbers[k] << (4 * triangle);
        patch_.corners = static_cast<std::uint8_t>(corners);
        ++patch_.triangles;
        return true;
    }

    TrianglePatch patch_;
    std::array<std::uint32_t, kTriangles> primitives_;
    std::array<std::array<Int4, 3 * kTriangles / 4>, 3> corners_;  // axis by axis, as bits
    std::array<std::uint32_t, 3 * kTriangles> numbers_;            // of the corners, in the patch
    std::array<Coordinates, 3> coordinates_;
};

// Appends a leaf's patches.
void collect(const WideBvh& bvh, const Mesh& mesh, const WideRef& leaf,
             std::vector<TrianglePatches::Block>& blocks) {
    std::span<const std::uint32_t> primitives = indices_of(bvh, leaf);
    while (!primitives.empty()) {
        PatchMaker patch(mesh, primitives);
        primitives = primitives.subspan(patch.triangles());
        if (primitives.empty()) patch.finish_leaf();
        patch.append_to(blocks);
    }
}

// Reads along the leaves' order jump about in the mesh, so the processor is told what comes.
void fetch_triangles(std::span<const std::uint32_t> primitives, const Mesh& mesh) {
    for (const std::uint32_t primitive : primitives)
        __builtin_prefetch(&mesh.triangles[primitive & ~WideBvh::kLast]);
}
void fetch_corners(std::span<const std::uint32_t> primitives, const Mesh& mesh) {
    for (const std::uint32_t primitive : primitives) {
        const glm::uvec3 t = mesh.triangles[primitive & ~WideBvh::kLast];
        for (int k = 0; k < 3; ++k)
            __builtin_prefetch(&mesh.positions[t[k]]);
    }
}

// Some places in a tree, and the patches of the leaves among them.
struct Portion {
    WideBvh& bvh;
    const Mesh& mesh;
    std::size_t begin = 0;  // node
    std::size_t end = 0;
    std::vector<TrianglePatches::Block> blocks;

    // A leaf's index counts from the portion's first block then.
    void collect_leaves() {
        constexpr std::size_t kAhead = 4;  // leaves
        const std::vector<std::uint32_t*> leaves = leaves_of();
        for (std::size_t i = 0; i < leaves.size() + 2 * kAhead; ++i) {
            if (i < leaves.size()) fetch_triangles(indices_of(bvh, {*leaves[i]}), mesh);
            const std::size_t next = i - kAhead;
            if (next < leaves.size()) fetch_corners(indices_of(bvh, {*leaves[next]}), mesh);
            const std::size_t now = next - kAhead;
            if (now >= leaves.size()) continue;
            const auto place = static_cast<std::uint32_t>(blocks.size());
            collect(bvh, mesh, {*leaves[now]}, blocks);
            *leaves[now] = WideRef::leaf(place).bits;
        }
        blocks.shrink_to_fit();
    }

    void move_to(TrianglePatches& patches, std::size_t block) {
        std::copy(blocks.begin(), blocks.end(),
                  patches.blocks.begin() + static_cast<std::ptrdiff_t>(block));
        blocks = {};
        for (std::uint32_t* const leaf : leaves_of())
            *leaf += static_cast<std::uint32_t>(block);
    }

private:
    // Where the leaves stand in the tree.
    [[nodiscard]] std::vector<std::uint32_t*> leaves_of() const {
        if (bvh.root.is_leaf()) return {&bvh.root.bits};
        std::vector<std::uint32_t*> leaves;
        leaves.reserve(kWidth * (end - begin));
        for (std::size_t n = begin; n < end; ++n) {
            for (std::uint32_t& child : bvh.nodes[n].child) {
                if (child != WideRef::kNothing && WideRef{child}.is_leaf())
                    leaves.push_back(&child);
            }
        }
        return leaves;
    }
};

// Leaves of a ray may be read beyond the end, see TrianglePatch::along.
constexpr std::size_t kReadBeyond = TrianglePatch::kMostCorners * sizeof(float) / 16;

void make_room(TrianglePatches& patches, std::size_t blocks) {
    if (blocks >= WideRef::kLeaf) {
        throw std::length_error("the mesh has too many triangles for one tree");
    }
    patches.blocks.resize(blocks + kReadBeyond);
    std::fill_n(patches.blocks.begin() + static_cast<std::ptrdiff_t>(blocks), kReadBeyond,
                TrianglePatches::Block{});
}

}  // namespace

TrianglePatches take_triangles(WideBvh& bvh, const Mesh& mesh, int threads,
                               const std::stop_token& stop) {
    TrianglePatches patches;
    if (bvh.empty()) return patches;
    constexpr std::size_t kNodes = 256;
    std::vector<Portion> portions;
    for (std::size_t n = 0; n == 0 || n < bvh.nodes.size(); n += kNodes)
        portions.push_back({bvh, mesh, n, std::min(bvh.nodes.size(), n + kNodes), {}});
    std::vector<std::size_t> first(portions.size() + 1);
    parallel_for(portions.size(), threads, stop,
                 [&](std::size_t i) { portions[i].collect_leaves(); });
    if (stop.stop_requested()) throw Cancelled();
    bvh.indices = {};
    for (std::size_t i = 0; i < portions.size(); ++i)
        first[i + 1] = first[i] + portions[i].blocks.size();
    make_room(patches, first.back());
    parallel_for(portions.size(), threads, stop,
                 [&](std::size_t i) { portions[i].move_to(patches, first[i]); });
    if (stop.stop_requested()) throw Cancelled();
    return patches;
}

}  // namespace raypick
