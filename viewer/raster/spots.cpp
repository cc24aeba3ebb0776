#include "viewer/raster/spots.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

// How much the coordinates that shaders/mesh.vert computes may differ from those of find_spots(),
// relative to their terms: seven roundings each.
constexpr float kRounding = 16 * 0x1p-24f;
// What of kSpotMargin this may take; the grid takes a quarter.
constexpr float kTolerated = 0.5f * kSpotMargin;
constexpr float kNearMargin = 1e-3f;

struct SpotFinder {
    glm::mat3 clip_from_object;
    glm::vec3 error;  // of clip coordinates, times the sum of a vector's magnitudes
    glm::vec3 eye_high;
    glm::vec3 eye_low;
    float near = 0.0f;
    bool orthographic = false;
    float half_cols = 0.0f;
    float half_rows = 0.0f;

    [[nodiscard]] Spot operator()(const glm::vec3& position) const {
        const glm::vec3 v = (position - eye_high) - eye_low;
        const glm::vec3 clip = clip_from_object * v;
        const glm::vec3 off = error * (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
        const float per_w = orthographic ? 1.0f : 1.0f / clip.z;
        const float w_off = orthographic ? 0.0f : off.z;
        const float x = clip.x * per_w;
        const float y = clip.y * per_w;
        const float off_x = half_cols * (off.x + std::abs(x) * w_off);
        const float off_y = half_rows * (off.y + std::abs(y) * w_off);
        // NaN and infinities stay unknown.
        const bool known = clip.z - off.z > (1.0f + kNearMargin) * near &&
                           std::max(off_x, off_y) * per_w <= kTolerated;
        const bool clipped = clip.z + off.z < (1.0f - kNearMargin) * near;
        return {half_cols * (1.0f + x), half_rows * (1.0f + y),
                known     ? per_w
                : clipped ? kClipped
                          : kUnknown};
    }
};

// The greatest entry of each row.
glm::vec3 largest_terms(const glm::mat3& m) {
    return glm::max(glm::max(glm::abs(m[0]), glm::abs(m[1])), glm::abs(m[2]));
}

}  // namespace

void find_spots(const ViewNumbers& view, const MeshNumbers& mesh,
                std::span<const glm::vec3> positions, std::span<Spot> spots) {
    const SpotFinder spot_of{mesh.clip_from_object,
                             kRounding * largest_terms(mesh.clip_from_object),
                             mesh.eye_high,
                             mesh.eye_low,
                             static_cast<float>(view.near),
                             view.orthographic,
                             0.5f * view.block.size.x,
                             0.5f * view.block.size.y};
    std::transform(positions.begin(), positions.end(), spots.begin(), spot_of);
}

}  // namespace raypick
