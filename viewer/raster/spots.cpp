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
    glm::mat3 magnitude;  // its absolute values
    glm::vec3 eye_high;
    glm::vec3 eye_low;
    float near = 0.0f;
    bool orthographic = false;
    float half_cols = 0.0f;
    float half_rows = 0.0f;

    [[nodiscard]] Spot operator()(const glm::vec3& position) const {
        const glm::vec3 v = (position - eye_high) - eye_low;
        const glm::vec3 clip = clip_from_object * v;
        const glm::vec3 error = kRounding * (magnitude * glm::abs(v));
        const float w = orthographic ? 1.0f : clip.z;
        const float w_error = orthographic ? 0.0f : error.z;
        const float x = clip.x / w;
        const float y = clip.y / w;
        Spot spot{half_cols * (1.0f + x), half_rows * (1.0f + y), kUnknown};
        if (clip.z + error.z < (1.0f - kNearMargin) * near) spot.nearness = kClipped;
        // NaN and infinities stay unknown.
        const float off_x = half_cols * (error.x + std::abs(x) * w_error);
        const float off_y = half_rows * (error.y + std::abs(y) * w_error);
        if (clip.z - error.z > (1.0f + kNearMargin) * near &&
            std::max(off_x, off_y) <= kTolerated * w) {
            spot.nearness = 1.0f / w;
        }
        return spot;
    }
};

glm::mat3 absolute(const glm::mat3& m) {
    return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])};
}

}  // namespace

void find_spots(const ViewNumbers& view, const MeshNumbers& mesh,
                std::span<const glm::vec3> positions, std::span<Spot> spots) {
    const SpotFinder spot_of{mesh.clip_from_object,
                             absolute(mesh.clip_from_object),
                             mesh.eye_high,
                             mesh.eye_low,
                             static_cast<float>(view.near),
                             view.orthographic,
                             0.5f * view.block.size.x,
                             0.5f * view.block.size.y};
    std::transform(positions.begin(), positions.end(), spots.begin(), spot_of);
}

}  // namespace raypick
