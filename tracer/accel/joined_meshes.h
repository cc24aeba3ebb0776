// Several meshes as if they were one: their triangles are numbered through.
#pragma once

#include "tracer/scene/scene.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace raypick {

class JoinedMeshes {
public:
    // Most there can be, of meshes and of triangles (TrianglePatch::member, WideBvh::kLast).
    static constexpr std::size_t kMostMeshes = (1u << 15) - 1;
    static constexpr std::size_t kMostTriangles = (std::size_t{1} << 31) - 1;

    // The meshes must outlive this, and have triangles, unless there is but one.
    explicit JoinedMeshes(std::vector<const Mesh*> meshes) : meshes_(std::move(meshes)) {
        std::size_t count = 0;
        for (const Mesh* mesh : meshes_)
            first_.push_back(std::exchange(count, count + mesh->triangles.size()));
        first_.push_back(count);
        fill_slots();
    }

    [[nodiscard]] std::size_t size() const { return meshes_.size(); }
    [[nodiscard]] std::size_t triangles() const { return first_.back(); }
    [[nodiscard]] const Mesh& mesh(std::size_t member) const { return *meshes_[member]; }
    // The numbers of a member's triangles are [first(member), first(member + 1)).
    [[nodiscard]] std::size_t first(std::size_t member) const { return first_[member]; }
    [[nodiscard]] std::size_t member_of(std::size_t triangle) const {
        std::size_t member = slots_[triangle >> slot_shift_];
        while (triangle >= first_[member + 1])
            ++member;
        return member;
    }

private:
    void fill_slots() {
        const std::size_t most = std::bit_ceil(4 * size());
        slot_shift_ = static_cast<int>(std::bit_width(triangles() / most));
        for (std::size_t member = 0, begin = 0; begin < triangles();) {
            while (begin >= first_[member + 1])
                ++member;
            slots_.push_back(static_cast<std::uint16_t>(member));
            begin = slots_.size() << slot_shift_;
        }
    }

    std::vector<const Mesh*> meshes_;
    std::vector<std::size_t> first_;
    // Triangles in runs of 2 to the power of slot_shift_, a few for each mesh: whose a run's first
    // one is. From there it isn't far to the others' meshes.
    std::vector<std::uint16_t> slots_;
    int slot_shift_ = 0;
};

}  // namespace raypick
