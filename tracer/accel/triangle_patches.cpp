#include "tracer/accel/triangle_patches.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>

namespace raypick {

namespace {

// A patch that is being put together.
class Collector {
public:
    explicit Collector(const Mesh& mesh) : mesh_(mesh) {}

    // False if there is no room for it.
    bool add(std::uint32_t primitive) {
        if (patch_.triangles == TrianglePatch::kMostTriangles) return false;
        const std::uint8_t before = patch_.corners;
        std::array<std::uint32_t, 3> numbers{};
        for (int k = 0; k < 3; ++k) {
            const auto i = static_cast<std::size_t>(k);
            numbers[i] = number_of(mesh_.positions[mesh_.triangles[primitive][k]]);
            if (numbers[i] == TrianglePatch::kMostCorners) {
                patch_.corners = before;
                return false;
            }
        }
        for (std::size_t k = 0; k < 3; ++k)
            patch_.corner[k] |= numbers[k] << (4 * patch_.triangles);
        primitives_[patch_.triangles++] = primitive;
        return true;
    }

    [[nodiscard]] bool empty() const { return patch_.triangles == 0; }
    [[nodiscard]] std::size_t size() const { return patch_.size(); }
    void clear() { patch_ = {}; }
    void finish_leaf() { patch_.last = 1; }

    void append_to(std::vector<TrianglePatches::Block>& blocks) const {
        const std::size_t first = blocks.size();
        blocks.resize(first + size());
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
    using Coordinates = std::array<std::uint32_t, TrianglePatch::kMostCorners>;  // as bits

    // Of the corner at a position, bit for bit; kMostCorners if there is no room for it.
    std::uint32_t number_of(const glm::vec3& position) {
        const auto at = std::bit_cast<std::array<std::uint32_t, 3>>(position);
        // All of them without a branch, so that compilers take several at once.
        std::array<std::uint32_t, TrianglePatch::kMostCorners> differs{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < differs.size(); ++i)
                differs[i] |= coordinates_[axis][i] ^ at[axis];
        }
        for (std::uint32_t i = 0; i < patch_.corners; ++i) {
            if (differs[i] == 0) return i;
        }
        if (patch_.corners == TrianglePatch::kMostCorners) return TrianglePatch::kMostCorners;
        for (std::size_t axis = 0; axis < 3; ++axis)
            coordinates_[axis][patch_.corners] = at[axis];
        return patch_.corners++;
    }

    const Mesh& mesh_;
    TrianglePatch patch_;
    std::array<std::uint32_t, TrianglePatch::kMostTriangles> primitives_{};
    std::array<Coordinates, 3> coordinates_{};
};

// Calls full(collector) for each patch of a leaf.
template <typename Full>
void collect(const WideBvh& bvh, const Mesh& mesh, const WideRef& leaf, const Full& full) {
    Collector collector(mesh);
    each_index(bvh, leaf, [&](std::uint32_t primitive) {
        if (collector.add(primitive)) return false;
        full(collector);
        collector.clear();
        collector.add(primitive);
        return false;
    });
    collector.finish_leaf();
    full(collector);
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
        each_leaf([&](std::uint32_t& leaf) {
            const auto place = static_cast<std::uint32_t>(blocks.size());
            collect(bvh, mesh, {leaf}, [&](const Collector& patch) { patch.append_to(blocks); });
            leaf = WideRef::leaf(place).bits;
        });
        blocks.shrink_to_fit();
    }

    void move_to(TrianglePatches& patches, std::size_t block) {
        std::copy(blocks.begin(), blocks.end(),
                  patches.blocks.begin() + static_cast<std::ptrdiff_t>(block));
        blocks = {};
        each_leaf([&](std::uint32_t& leaf) { leaf += static_cast<std::uint32_t>(block); });
    }

private:
    template <typename Leaf>
    void each_leaf(const Leaf& leaf) const {
        if (bvh.root.is_leaf()) leaf(bvh.root.bits);
        for (std::size_t n = begin; n < end; ++n) {
            for (std::uint32_t& child : bvh.nodes[n].child) {
                if (child != WideRef::kNothing && WideRef{child}.is_leaf()) leaf(child);
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
}

}  // namespace

TrianglePatches take_triangles(WideBvh& bvh, const Mesh& mesh, int threads,
                               const std::stop_token& stop) {
    TrianglePatches patches;
    if (bvh.empty()) return patches;
    constexpr std::size_t kNodes = 512;
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
