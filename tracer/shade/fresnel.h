// How much light a surface reflects.
#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace raypick {

// Unpolarised reflectance of the boundary between two dielectrics: the mean of Fresnel's two
// polarisations. `cosine` is that of the angle of incidence, 0..1; `eta` the index on the ray's
// side over that beyond. 1 on total internal reflection.
inline float fresnel_dielectric(float cosine, float eta) {
    const float sine_squared = eta * eta * (1.0f - cosine * cosine);
    if (!(sine_squared < 1.0f)) return 1.0f;
    const float beyond = std::sqrt(1.0f - sine_squared);
    const float across = (eta * cosine - beyond) / (eta * cosine + beyond);
    const float along = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5f * (across * across + along * along);
}

// A sheet of that dielectric: both faces, and all the light that goes back and forth between them.
inline float fresnel_sheet(float cosine, float eta) {
    const float once = fresnel_dielectric(cosine, eta);
    return 2.0f * once / (1.0f + once);
}

// Source: Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994.
inline glm::vec3 fresnel_conductor(const glm::vec3& facing, float cosine) {
    const float grazing = std::pow(1.0f - cosine, 5.0f);
    return facing + (1.0f - facing) * grazing;
}

}  // namespace raypick
