// Several meshes as if they were one: their triangles are numbered through.
#pragma once

#include "tracer/scene/scene.h"

#include <algorithm>
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
    }

    [[nodiscard]] std::size_t size() const { return meshes_.size(); }
    [[nodiscard]] std::size_t triangles() const { return first_.back(); }
    [[nodiscard]] const Mesh& mesh(std::size_t member) const { return *meshes_[member]; }
    // The numbers of a member's triangles are [first(member), first(member + 1)).
    [[nodiscard]] std::size_t first(std::size_t member) const { return first_[member]; }
    [[nodiscard]] std::size_t member_of(std::size_t triangle) const {
        if (meshes_.size() == 1) return 0;
        const auto behind = std::upper_bound(first_.begin(), first_.end(), triangle);
        return static_cast<std::size_t>(behind - first_.begin()) - 1;
    }

private:
    std::vector<const Mesh*> meshes_;
    std::vector<std::size_t> first_;
};

}  // namespace raypick
