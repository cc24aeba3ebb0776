// How many rays of which kind a picture took.
#pragma once

#include "tracer/shade/branches.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace raypick {

// Of RenderSettings::depth.
inline constexpr int kMaxDepth = 64;

// Rays by kind. Sums over pixels: the same for any number of threads.
struct RayCounts {
    std::uint64_t eye = 0;
    std::uint64_t eye_hits = 0;
    std::uint64_t reflection = 0;
    std::uint64_t refraction = 0;
    std::uint64_t shadow = 0;
    std::uint64_t shadow_blocked = 0;
    // The same by depth: of the ray that arrives (an eye ray is depth 1), or for shadow rays of the
    // ray whose hit they start from.
    std::array<std::uint64_t, kMaxDepth + 1> reflection_at{};
    std::array<std::uint64_t, kMaxDepth + 1> refraction_at{};
    std::array<std::uint64_t, kMaxDepth + 1> shadow_at{};

    [[nodiscard]] std::uint64_t total() const { return eye + reflection + refraction + shadow; }
    RayCounts& operator+=(const RayCounts& other);
    friend bool operator==(const RayCounts&, const RayCounts&) = default;
};

inline std::size_t counted_depth(int depth) {
    return static_cast<std::size_t>(std::min(depth, kMaxDepth));
}

// `depth`: of the rays that leave.
inline void count_branches(RayCounts& counts, BranchKind kind, std::size_t rays, int depth) {
    const bool mirrored = kind == BranchKind::mirrored;
    (mirrored ? counts.reflection : counts.refraction) += rays;
    (mirrored ? counts.reflection_at : counts.refraction_at)[counted_depth(depth)] += rays;
}

// `depth`: of the ray whose hit they start from.
inline void count_shadows(RayCounts& counts, std::size_t rays, int depth) {
    counts.shadow += rays;
    counts.shadow_at[counted_depth(depth)] += rays;
}

}  // namespace raypick
