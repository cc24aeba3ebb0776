#include "tracer/accel/triangle_patches.h"

#include "tracer/accel/same_corners.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <span>
#include <stdexcept>

namespace raypick {

namespace {

using Blocks = LargeArray<TrianglePatches::Block>;

// A patch of as many of a leaf's next triangles as fit into one.
class PatchMaker {
public:
    // Of the first eight primitives at most.
    PatchMaker(const Mesh& mesh, std::size_t member, std::span<const std::uint32_t> primitives) {
        patch_.member = static_cast<std::uint16_t>(member & JoinedMeshes::kMostMeshes);
        const std::size_t most = std::min<std::size_t>(primitives.size(), kTriangles);
        for (std::size_t i = 0; i < most; ++i) {
            primitives_[i] = primitives[i];
            const glm::uvec3 t = mesh.triangles[primitives_[i]];
            for (int k = 0; k < 3; ++k)
                put_place(3 * i + static_cast<std::size_t>(k), mesh.positions[t[k]]);
        }
        find_first_corners(places_, 3 * most, first_);
        while (patch_.triangles < most && add_triangle(patch_.triangles)) {
        }
    }

    [[nodiscard]] std::uint32_t triangles() const { return patch_.triangles; }
    void finish_leaf() { patch_.last = 1; }

    // Copies as much as there may be, as it takes less time than to copy what there is. What lies
    // behind that is overwritten.
    void append_to(Blocks& blocks) const {
        constexpr std::size_t kMostBlocks = 16;
        const std::size_t first = blocks.size();
        blocks.resize(first + kMostBlocks);
        auto* at = reinterpret_cast<std::byte*>(blocks.data() + first);
        std::memcpy(at, &patch_, sizeof patch_);
        at += sizeof patch_;
        std::memcpy(at, primitives_.data(), sizeof primitives_);
        at += patch_.triangles * sizeof(std::uint32_t);
        for (const Coordinates& along : coordinates_) {
            std::memcpy(at, along.data(), TrianglePatch::kMostCorners * sizeof(float));
            at += patch_.corners * sizeof(float);
        }
        std::memset(at, 0, sizeof(TrianglePatches::Block));
        blocks.resize(first + patch_.size());
    }

private:
    static constexpr std::size_t kTriangles = TrianglePatch::kMostTriangles;
    // With room for a last triangle that doesn't fit.
    using Coordinates = std::array<std::uint32_t, TrianglePatch::kMostCorners + 3>;  // as bits

    void put_place(std::size_t i, const glm::vec3& position) {
        const auto at = std::bit_cast<std::array<std::uint32_t, 3>>(position);
        for (std::size_t axis = 0; axis < 3; ++axis)
            places_.along[axis][i] = at[axis];
    }

    // False if there is no room for its corners.
    bool add_triangle(std::uint32_t triangle) {
        std::uint32_t corners = patch_.corners;
        std::array<std::uint32_t, 3> numbers{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = 3 * std::size_t{triangle} + k;
            numbers[k] = first_[i] == i ? corners : numbers_[first_[i]];
            corners += first_[i] == i ? 1u : 0u;
            numbers_[i] = numbers[k];
            for (std::size_t axis = 0; axis < 3; ++axis)
                coordinates_[axis][numbers[k]] = places_.along[axis][i];
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
    CornerPlaces places_;
    FirstCorners first_;
    std::array<std::uint32_t, CornerPlaces::kMost> numbers_;  // of the corners, in the patch
    std::array<Coordinates, 3> coordinates_;
};

// A leaf, and where it stands in the tree.
struct Leaf {
    std::uint32_t* place = nullptr;
    std::span<const std::uint32_t> primitives;
};

// A leaf's primitives by member, and numbered as in their meshes.
class LeafTriangles {
public:
    LeafTriangles(std::span<const std::uint32_t> primitives, const JoinedMeshes& meshes)
        : meshes_(meshes), count_(primitives.size()) {
        assert(count_ <= numbers_.size());
        for (std::size_t i = 0; i < count_; ++i)
            numbers_[i] = primitives[i] & ~WideBvh::kLast;
        if (meshes.size() > 1) std::sort(numbers_.begin(), numbers_.begin() + count_);
    }

    // Calls body(member, primitives, last) for the members in turn.
    template <typename Body>
    void each_member(const Body& body) {
        for (std::size_t begin = 0; begin < count_;) {
            const std::size_t member = meshes_.member_of(numbers_[begin]);
            const auto first = static_cast<std::uint32_t>(meshes_.first(member));
            const std::size_t behind = meshes_.first(member + 1);
            std::size_t end = begin;
            while (end < count_ && numbers_[end] < behind)
                numbers_[end++] -= first;
            body(member, std::span(numbers_).subspan(begin, end - begin), end == count_);
            begin = end;
        }
    }

private:
    const JoinedMeshes& meshes_;
    std::size_t count_;
    std::array<std::uint32_t, kWideSurfaceLeaves.max_leaf> numbers_{};
};

void append_patches(const Leaf& leaf, const JoinedMeshes& meshes, Blocks& blocks) {
    LeafTriangles(leaf.primitives, meshes)
        .each_member([&](std::size_t member, std::span<const std::uint32_t> primitives, bool last) {
            while (!primitives.empty()) {
                PatchMaker patch(meshes.mesh(member), member, primitives);
                primitives = primitives.subspan(patch.triangles());
                if (last && primitives.empty()) patch.finish_leaf();
                patch.append_to(blocks);
            }
        });
}

// Calls body(mesh, triangle) for a leaf's triangles.
template <typename Body>
void each_triangle(const Leaf& leaf, const JoinedMeshes& meshes, const Body& body) {
    for (const std::uint32_t primitive : leaf.primitives) {
        const std::size_t number = primitive & ~WideBvh::kLast;
        const std::size_t member = meshes.member_of(number);
        const Mesh& mesh = meshes.mesh(member);
        body(mesh, mesh.triangles[number - meshes.first(member)]);
    }
}

// Reads along the leaves' order jump about in the mesh, so the processor is told what comes.
void fetch_triangles(const Leaf& leaf, const JoinedMeshes& meshes) {
    each_triangle(leaf, meshes,
                  [](const Mesh&, const glm::uvec3& triangle) { __builtin_prefetch(&triangle); });
}
void fetch_corners(const Leaf& leaf, const JoinedMeshes& meshes) {
    each_triangle(leaf, meshes, [](const Mesh& mesh, const glm::uvec3& triangle) {
        for (int k = 0; k < 3; ++k)
            __builtin_prefetch(&mesh.positions[triangle[k]]);
    });
}

// Some places in a tree, and the patches of the leaves among them.
struct Portion {
    WideBvh& bvh;
    const JoinedMeshes& meshes;
    std::size_t begin = 0;  // node
    std::size_t end = 0;
    Blocks blocks;

    // A leaf's index counts from the portion's first block then.
    void collect_leaves() {
        constexpr std::size_t kAhead = 4;  // leaves
        std::vector<Leaf> leaves;
        leaves.reserve(kWidth * (end - begin));
        std::size_t triangles = 0;
        each_leaf([&](std::uint32_t& place) {
            leaves.push_back({&place, indices_of(bvh, {place})});
            triangles += leaves.back().primitives.size();
        });
        blocks.reserve(2 * triangles);  // enough for surfaces
        for (std::size_t i = 0; i < leaves.size() + 2 * kAhead; ++i) {
            if (i < leaves.size()) fetch_triangles(leaves[i], meshes);
            const std::size_t next = i - kAhead;
            if (next < leaves.size()) fetch_corners(leaves[next], meshes);
            const std::size_t now = next - kAhead;
            if (now >= leaves.size()) continue;
            *leaves[now].place = WideRef::leaf(static_cast<std::uint32_t>(blocks.size())).bits;
            append_patches(leaves[now], meshes, blocks);
        }
        blocks.shrink_to_fit();
    }

    void move_to(TrianglePatches& patches, std::size_t block) {
        std::copy(blocks.begin(), blocks.end(),
                  patches.blocks.begin() + static_cast<std::ptrdiff_t>(block));
        blocks = {};
        each_leaf([&](std::uint32_t& place) { place += static_cast<std::uint32_t>(block); });
    }

private:
    template <typename Body>
    void each_leaf(const Body& body) const {
        if (bvh.root.is_leaf()) body(bvh.root.bits);
        for (std::size_t n = begin; n < end; ++n) {
            for (std::uint32_t& child : bvh.nodes[n].child) {
                if (child != WideRef::kNothing && WideRef{child}.is_leaf()) body(child);
            }
        }
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

TrianglePatches take_triangles(WideBvh& bvh, const JoinedMeshes& meshes, int threads,
                               const std::stop_token& stop) {
    TrianglePatches patches;
    if (bvh.empty()) return patches;
    constexpr std::size_t kNodes = 256;
    std::vector<Portion> portions;
    for (std::size_t n = 0; n == 0 || n < bvh.nodes.size(); n += kNodes)
        portions.push_back({bvh, meshes, n, std::min(bvh.nodes.size(), n + kNodes), {}});
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
