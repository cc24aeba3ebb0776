#include "viewer/raster/needed_triangles.h"

#include "tracer/parallel/parallel.h"
#include "viewer/raster/cover.h"
#include "viewer/raster/spots.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace raypick {

namespace {

// Of spots, 200 MB: the meshes beyond are drawn as they are.
constexpr std::size_t kMaxSpots = std::size_t{1} << 24u;
constexpr std::size_t kBlock = 8192;  // vertices or triangles that a thread takes at once

// The larger side of a pixel's at distance 1.
float pixel_side(const ViewNumbers& view) {
    return std::max(glm::length(glm::vec3(view.block.right)),
                    glm::length(glm::vec3(view.block.up)));
}

float sum_of_squares(const glm::dmat3& m) {
    return static_cast<float>(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

// Quotient of the matrix's greatest and least singular value, or more: with that quotient k, the
// product of its and its inverse's Frobenius norm is k + 1 + 1 / k or more.
float stretch_of(const glm::dmat3& m) {
    const float sum =
        std::sqrt(sum_of_squares(m) * sum_of_squares(glm::inverse(m))) - 1.0f;  // k + 1 / k
    return 0.5f * (sum + std::sqrt(std::max(0.0f, sum * sum - 4.0f)));
}

// A run of a mesh's vertices or triangles.
struct Run {
    std::size_t mesh = 0;
    std::size_t first = 0;
    std::size_t count = 0;
    std::vector<std::uint32_t> needed;  // of triangles
};

class Sieve {
public:
    Sieve(const ViewNumbers& view, ImageSize size, std::span<const MeshInView> meshes)
        : view_(view), meshes_(meshes), cover_(size, pixel_side(view)) {
        std::size_t spots = 0;
        for (const MeshInView& mesh : meshes) {
            if (mesh.positions.size() > kMaxSpots - spots) break;
            first_spot_.push_back(spots);
            spots += mesh.positions.size();
        }
        spots_.resize(spots);
    }

    std::vector<NeededTriangles> sift() {
        find_all_spots();
        std::vector<Run> runs =
            runs_of([](const MeshInView& mesh) { return mesh.triangles.size(); });
        parallel_for(runs.size(), 0, {}, [&](std::size_t i) { keep_what_takes_pixels(runs[i]); });
        parallel_for(runs.size(), 0, {}, [&](std::size_t i) { drop_what_is_hidden(runs[i]); });
        return joined(runs);
    }

private:
    template <typename CountOf>
    [[nodiscard]] std::vector<Run> runs_of(const CountOf& count_of) const {
        std::vector<Run> runs;
        for (std::size_t mesh = 0; mesh < first_spot_.size(); ++mesh) {
            const std::size_t count = count_of(meshes_[mesh]);
            for (std::size_t first = 0; first < count; first += kBlock)
                runs.push_back({mesh, first, std::min(kBlock, count - first), {}});
        }
        return runs;
    }

    void find_all_spots() {
        const std::vector<Run> runs =
            runs_of([](const MeshInView& mesh) { return mesh.positions.size(); });
        parallel_for(runs.size(), 0, {}, [&](std::size_t i) {
            const Run& run = runs[i];
            const MeshInView& mesh = meshes_[run.mesh];
            find_spots(view_, mesh.numbers, mesh.positions.subspan(run.first, run.count),
                       std::span(spots_).subspan(first_spot_[run.mesh] + run.first, run.count));
        });
    }

    [[nodiscard]] SpotTriangle triangle(std::size_t mesh, std::size_t number) const {
        const glm::uvec3& corners = meshes_[mesh].triangles[number];
        const Spot* const spots = spots_.data() + first_spot_[mesh];
        return {spots[corners.x], spots[corners.y], spots[corners.z]};
    }

    static float least_nearness(const SpotTriangle& t) {
        return std::min(std::min(t[0].nearness, t[1].nearness), t[2].nearness);
    }
    static float greatest_nearness(const SpotTriangle& t) {
        return std::max(std::max(t[0].nearness, t[1].nearness), t[2].nearness);
    }

    void keep_what_takes_pixels(Run& run) {
        // Parallel views have no nearness to compare.
        const bool hides = meshes_[run.mesh].hides_others && !view_.orthographic;
        for (std::size_t i = run.first; i < run.first + run.count; ++i) {
            const SpotTriangle t = triangle(run.mesh, i);
            if (least_nearness(t) > 0.0f) {
                if (!cover_.add(t, hides)) continue;
            } else if (greatest_nearness(t) < 0.0f) {
                continue;
            }
            run.needed.push_back(static_cast<std::uint32_t>(i));
        }
    }

    void drop_what_is_hidden(Run& run) const {
        if (view_.orthographic) return;
        const float stretch = stretch_of(meshes_[run.mesh].numbers.object_from_scene);
        std::erase_if(run.needed, [&](std::uint32_t number) {
            const SpotTriangle t = triangle(run.mesh, number);
            return least_nearness(t) > 0.0f && cover_.hidden(t, stretch);
        });
    }

    [[nodiscard]] std::vector<NeededTriangles> joined(const std::vector<Run>& runs) const {
        std::vector<NeededTriangles> needed(meshes_.size());
        for (const Run& run : runs) {
            std::vector<std::uint32_t>& triangles = needed[run.mesh].triangles;
            triangles.insert(triangles.end(), run.needed.begin(), run.needed.end());
        }
        for (std::size_t mesh = 0; mesh < first_spot_.size(); ++mesh)
            needed[mesh].all = needed[mesh].triangles.size() == meshes_[mesh].triangles.size();
        return needed;
    }

    const ViewNumbers& view_;
    std::span<const MeshInView> meshes_;
    std::vector<std::size_t> first_spot_;  // of the meshes that are looked at
    std::vector<Spot> spots_;
    Cover cover_;
};

}  // namespace

std::vector<NeededTriangles> needed_triangles(const ViewNumbers& view, ImageSize size,
                                              std::span<const MeshInView> meshes) {
    return Sieve(view, size, meshes).sift();
}

}  // namespace raypick
