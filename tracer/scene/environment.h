// What rays see that hit nothing.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <filesystem>
#include <memory>
#include <variant>
#include <vector>

namespace raypick {

struct Scene;

// From `horizon` to `zenith` by the sine of the height above the horizon, and to `ground` below.
struct GradientSky {
    glm::vec3 zenith{0.25f, 0.45f, 0.85f};
    glm::vec3 horizon{0.85f, 0.9f, 0.95f};
    glm::vec3 ground{0.25f, 0.23f, 0.2f};
    glm::dvec3 up{0.0, 1.0, 0.0};  // any length but 0
};

// Linear RGB, equirectangular: row 0 is the zenith, the middle column is `forward`.
struct SkyPixels {
    int rows = 0;
    int cols = 0;
    std::vector<glm::vec3> texels;
    std::vector<SkyPixels> smaller;  // the mip chain: half the size each, down to 1 x 1
};

// With the mip chain, which wide rays are averaged by. Throws Error if the size doesn't fit or a
// texel is negative or not finite.
std::shared_ptr<const SkyPixels> make_sky_pixels(int rows, int cols, std::vector<glm::vec3> texels);

struct ImageSky {
    std::shared_ptr<const SkyPixels> pixels;
    std::filesystem::path file;
    glm::dvec3 up{0.0, 1.0, 0.0};        // any length but 0
    glm::dvec3 forward{0.0, 0.0, -1.0};  // not parallel to up
    float scale = 1.0f;
};

// monostate: the scene's background colour all around.
using Environment = std::variant<std::monostate, GradientSky, ImageSky>;

// Linear RGB seen along a unit direction. `spread` is the angle (radians) that the ray stands for:
// images are averaged over it.
glm::vec3 environment_colour(const Scene& scene, const glm::vec3& direction, float spread = 0.0f);

}  // namespace raypick
