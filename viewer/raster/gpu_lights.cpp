#include "viewer/raster/gpu_lights.h"

#include "viewer/gl/load_gl.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace raypick {

namespace {

using LightTexels = std::array<glm::vec4, 5>;

glm::vec4 attenuation_texel(const Attenuation& a, double radius = 0.0) {
    const glm::vec4 texel(glm::dvec4(a.constant, a.linear, a.quadratic, radius));
    return texel;
}

// Fills in what follows the kind.
struct TexelsOf {
    const glm::dvec3& eye;
    LightTexels& texels;

    void operator()(const PointLight& light) const {
        place(light.position - eye, light.colour, 0);
        texels[2] = attenuation_texel(light.attenuation);
    }
    void operator()(const DirectionalLight& light) const {
        place(-glm::normalize(light.direction), light.colour, 0);
    }
    void operator()(const SpotLight& light) const {
        const double inner = std::cos(glm::radians(light.inner_degrees));
        const double outer = std::cos(glm::radians(light.outer_degrees));
        place(light.position - eye, light.colour, 0);
        texels[2] = attenuation_texel(light.attenuation);
        texels[3] = glm::vec4(glm::dvec4(glm::normalize(light.direction), outer));
        texels[4].w = static_cast<float>(inner);
    }
    void operator()(const SphereLight& light) const {
        place(light.centre - eye, light.colour, light.samples);
        texels[2] = attenuation_texel(light.attenuation, light.radius);
    }
    void operator()(const RectangleLight& light) const {
        const glm::dvec3 centre = light.corner + 0.5 * (light.edge_u + light.edge_v);
        place(centre - eye, light.colour, light.samples);
        texels[2] = attenuation_texel(light.attenuation);
        texels[3] = glm::vec4(glm::vec3(light.edge_u), 0.0f);
        texels[4] = glm::vec4(glm::vec3(light.edge_v), 0.0f);
    }

private:
    void place(const glm::dvec3& where, const glm::vec3& colour, int samples) const {
        texels[0] = glm::vec4(glm::vec3(where), texels[0].w);
        texels[1] = glm::vec4(colour, static_cast<float>(samples));
    }
};

}  // namespace

GpuLights upload_lights(const std::vector<Light>& lights, const glm::dvec3& eye) {
    std::vector<LightTexels> texels;
    texels.reserve(lights.size());
    for (const Light& light : lights) {
        LightTexels& added = texels.emplace_back();
        added[0].w = static_cast<float>(light.index());
        std::visit(TexelsOf{eye, added}, light);
    }
    GpuLights gpu;
    gpu.shaped = std::any_of(lights.begin(), lights.end(), [](const Light& light) {
        return !std::holds_alternative<PointLight>(light) &&
               !std::holds_alternative<DirectionalLight>(light);
    });
    gpu.count = static_cast<int>(lights.size());
    gpu.texels = {GL_RGBA32F, sizeof(glm::vec4), std::as_bytes(std::span(texels)), "lights"};
    return gpu;
}

}  // namespace raypick
