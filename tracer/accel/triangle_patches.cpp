#include "tracer/accel/triangle_patches.h"

#include "tracer/accel/same_corners.h"
#include "tracer/accel/triangle_box.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <iterator>
#include <span>
#include <stdexcept>

namespace raypick {

namespace {

using Blocks = LargeArray<TrianglePatches::Block>;

// Room for the largest patch, what is written beyond it, and zeros at its end.
constexpr std::size_t kMostBlocks = 20;
static_assert(kMostBlocks * sizeof(TrianglePatches::Block) >=
              sizeof(TrianglePatch) + (8 + 3 * 16 + kWrittenBeyondPatch) * sizeof(float) + 16);

// As three rows of four lanes.
void store_four(CornerPlaces& places, std::size_t first, const std::array<Float4, 4>& corners) {
    const auto& [a, b, c, d] = corners;
    const Float4 xy = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const Float4 xy_next = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const Float4 z = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Float4 z_next = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    const std::array<Float4, 3> axes{__builtin_shufflevector(xy, xy_next, 0, 1, 4, 5),
                                     __builtin_shufflevector(xy, xy_next, 2, 3, 6, 7),
                                     __builtin_shufflevector(z, z_next, 0, 1, 4, 5)};
    for (std::size_t axis = 0; axis < 3; ++axis)
        std::memcpy(&places.along[axis][first], &axes[axis], sizeof axes[axis]);
}

// The corners of up to eight triangles; returns the box around them.
Box4 find_places(const Mesh& mesh, std::span<const std::uint32_t> primitives,
                 CornerPlaces& places) {
    std::array<std::uint32_t, CornerPlaces::kMost> vertices;
    const std::size_t count = 3 * primitives.size();
    for (std::size_t i = 0; i < primitives.size(); ++i)
        std::memcpy(&vertices[3 * i], &mesh.triangles[primitives[i]], 3 * sizeof vertices[0]);
    std::fill_n(vertices.begin() + static_cast<std::ptrdiff_t>(count), (0u - count) % 4,
                vertices[0]);
    Box4 box;
    for (std::size_t i = 0; i < count; i += 4) {
        std::array<Float4, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) {
            corners[k] = vertex_position(mesh, vertices[i + k]);
            box.extend(corners[k]);
        }
        store_four(places, i, corners);
    }
    return box;
}

// Appends a patch of as many triangles as fit into one, and returns how many these are. It is the
// last of its leaf if it takes all, and the leaf ends with them.
std::size_t append_patch(const CornerPlaces& places, std::span<const std::uint32_t> primitives,
                         std::size_t member, bool leaf_ends, Blocks& blocks) {
    const std::size_t first = blocks.size();
    blocks.resize(first + kMostBlocks);
    auto& patch = *reinterpret_cast<TrianglePatch*>(blocks.data() + first);
    auto* const numbers = reinterpret_cast<std::uint32_t*>(&patch + 1);
    std::copy(primitives.begin(), primitives.end(), numbers);
    const SharedCorners shared = share_corners(places, primitives.size(), patch);
    patch.triangles = static_cast<std::uint8_t>(shared.triangles);
    patch.corners = static_cast<std::uint8_t>(shared.corners);
    patch.last = leaf_ends && shared.triangles == primitives.size() ? 1 : 0;
    patch.member = static_cast<std::uint16_t>(member & JoinedMeshes::kMostMeshes);
    std::memset(numbers + shared.triangles + std::size_t{3} * shared.corners, 0,
                sizeof(TrianglePatches::Block));
    blocks.resize(first + TrianglePatch::size(shared.triangles, shared.corners));
    return shared.triangles;
}

// Appends the patches of some triangles of a mesh; returns the box around them.
Box4 append_patches(std::span<const std::uint32_t> triangles, const Mesh& mesh, std::size_t member,
                    bool leaf_ends, Blocks& blocks) {
    Box4 box;
    std::array<std::uint32_t, TrianglePatch::kMostTriangles> some;
    while (!triangles.empty()) {
        const std::span primitives = std::span(some).first(std::min(triangles.size(), some.size()));
        for (std::size_t i = 0; i < primitives.size(); ++i)
            primitives[i] = triangles[i] & ~WideBvh::kLast;
        CornerPlaces places;
        box.extend(find_places(mesh, primitives, places));
        const bool ends = leaf_ends && triangles.size() == primitives.size();
        triangles = triangles.subspan(append_patch(places, primitives, member, ends, blocks));
    }
    return box;
}

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
            body(member, std::span<const std::uint32_t>(numbers_).subspan(begin, end - begin),
                 end == count_);
            begin = end;
        }
    }

private:
    const JoinedMeshes& meshes_;
    std::size_t count_;
    std::array<std::uint32_t, kWideSurfaceLeaves.max_leaf> numbers_{};
};

// Appends a leaf's patches; returns the box around its triangles.
Box4 append_leaf(std::span<const std::uint32_t> primitives, const JoinedMeshes& meshes,
                 Blocks& blocks) {
    if (meshes.size() == 1) return append_patches(primitives, meshes.mesh(0), 0, true, blocks);
    Box4 box;
    LeafTriangles(primitives, meshes)
        .each_member([&](std::size_t member, std::span<const std::uint32_t> some, bool last) {
            box.extend(append_patches(some, meshes.mesh(member), member, last, blocks));
        });
    return box;
}

// Calls body(mesh, triangle) for a leaf's triangles.
template <typename Body>
void each_triangle(std::span<const std::uint32_t> primitives, const JoinedMeshes& meshes,
                   const Body& body) {
    for (const std::uint32_t primitive : primitives) {
        const std::size_t number = primitive & ~WideBvh::kLast;
        const std::size_t member = meshes.member_of(number);
        const Mesh& mesh = meshes.mesh(member);
        body(mesh, mesh.triangles[number - meshes.first(member)]);
    }
}

// Reads along the leaves' order jump about in the mesh, so the processor is told what comes.
void fetch_triangles(std::span<const std::uint32_t> leaf, const JoinedMeshes& meshes) {
    each_triangle(leaf, meshes,
                  [](const Mesh&, const glm::uvec3& triangle) { __builtin_prefetch(&triangle); });
}
void fetch_corners(std::span<const std::uint32_t> leaf, const JoinedMeshes& meshes) {
    each_triangle(leaf, meshes, [](const Mesh& mesh, const glm::uvec3& triangle) {
        for (int k = 0; k < 3; ++k)
            __builtin_prefetch(&mesh.positions[triangle[k]]);
    });
}

// Appends the patches of so many leaves, whose primitives are primitives_of(i), and calls
// done(i, first block, box).
template <typename PrimitivesOf, typename Done>
void append_leaves(std::size_t count, const PrimitivesOf& primitives_of, const JoinedMeshes& meshes,
                   Blocks& blocks, const Done& done) {
    constexpr std::size_t kAhead = 4;  // leaves
    for (std::size_t i = 0; i < count + 2 * kAhead; ++i) {
        if (i < count) fetch_triangles(primitives_of(i), meshes);
        const std::size_t next = i - kAhead;
        if (next < count) fetch_corners(primitives_of(next), meshes);
        const std::size_t now = next - kAhead;
        if (now >= count) continue;
        const auto first = static_cast<std::uint32_t>(blocks.size());
        done(now, first, append_leaf(primitives_of(now), meshes, blocks));
    }
}

// A leaf, and where it stands in the tree.
struct Leaf {
    std::uint32_t* place = nullptr;
    std::span<const std::uint32_t> primitives;
};

// Some places in a tree, and the patches of the leaves among them.
struct Portion {
    WideBvh& bvh;
    const JoinedMeshes& meshes;
    std::size_t begin = 0;  // node
    std::size_t end = 0;
    Blocks blocks;

    // A leaf's index counts from the portion's first block then.
    void collect_leaves() {
        std::vector<Leaf> leaves;
        leaves.reserve(kWidth * (end - begin));
        std::size_t triangles = 0;
        each_leaf([&](std::uint32_t& place) {
            leaves.push_back({&place, indices_of(bvh, {place})});
            triangles += leaves.back().primitives.size();
        });
        blocks.reserve(2 * triangles + kMostBlocks);  // enough for surfaces
        append_leaves(
            leaves.size(), [&](std::size_t i) { return leaves[i].primitives; }, meshes, blocks,
            [&](std::size_t i, std::uint32_t first, const Box4& /*box*/) {
                *leaves[i].place = WideRef::leaf(first).bits;
            });
        blocks.shrink_to_fit();
    }

    void move_to(TrianglePatches& patches, std::size_t block) {
        std::copy(blocks.begin(), blocks.end(),
                  patches.blocks.begin() + static_cast<std::ptrdiff_t>(block));
        free_array(blocks);
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
    free_array(bvh.indices);
    for (std::size_t i = 0; i < portions.size(); ++i)
        first[i + 1] = first[i] + portions[i].blocks.size();
    make_room(patches, first.back());
    parallel_for(portions.size(), threads, stop,
                 [&](std::size_t i) { portions[i].move_to(patches, first[i]); });
    if (stop.stop_requested()) throw Cancelled();
    return patches;
}

PatchStore::PatchStore(const JoinedMeshes& meshes, std::size_t keys)
    : meshes_(meshes), chunks_((keys + kKeysInChunk - 1) / kKeysInChunk) {
    patches_.blocks.reserve(keys * 7 / 4 + kMostBlocks);  // enough for surfaces
}

LeafStore PatchStore::leaves() {
    return {[this](std::size_t chunk, std::span<const MortonKey> keys,
                   std::span<TreeletLeaf> leaves) { return store(chunk, keys, leaves); },
            [this](std::size_t chunk) { append(chunk); }};
}

std::size_t PatchStore::store(std::size_t chunk, std::span<const MortonKey> keys,
                              std::span<TreeletLeaf> leaves) {
    std::array<std::uint32_t, kKeysInChunk> primitives;
    for (std::size_t i = 0; i < keys.size(); ++i)
        primitives[i] = keys[i].index;
    Blocks& blocks = chunks_[chunk];
    blocks.reserve(2 * keys.size() + kMostBlocks);  // enough for surfaces
    append_leaves(
        leaves.size(),
        [&](std::size_t i) {
            return std::span<const std::uint32_t>(&primitives[leaves[i].first], leaves[i].count);
        },
        meshes_, blocks,
        [&](std::size_t i, std::uint32_t first, const Box4& box) {
            leaves[i].first = first;
            leaves[i].box = box;
        });
    return blocks.size();
}

void PatchStore::append(std::size_t chunk) {
    patches_.blocks.insert(patches_.blocks.end(), chunks_[chunk].begin(), chunks_[chunk].end());
    free_array(chunks_[chunk]);
}

TrianglePatches PatchStore::take() {
    make_room(patches_, patches_.blocks.size());
    return std::move(patches_);
}

}  // namespace raypick
