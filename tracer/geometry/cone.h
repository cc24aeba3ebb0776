// Where a ray meets a truncated cone, step by step: the roots alone for those who only ask whether
// and how far; the normal and the uv, which takes an arc tangent, for hits that count.
#pragma once

#include "tracer/geometry/shapes.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace raypick {

// The cone along its axis: the radius at height h above the base is base_radius + widening h.
struct ConeProfile {
    glm::dvec3 axis{0.0, 1.0, 0.0};
    double length = 1.0;
    double widening = 0.0;
};

// A ray split along and across the axis, seen from the base's centre; its parameter is counted from
// `start` of the original ray's t.
struct AxialRay {
    double start = 0.0;
    double height = 0.0;
    double climb = 0.0;
    glm::dvec3 across{0.0};
    glm::dvec3 drift{0.0};

    void advance(double t) {
        start += t;
        height += t * climb;
        across += t * drift;
    }
};

// The numbers of ShapeHit::primitive.
enum class ConePart : std::uint32_t { side = 0, base_cap = 1, apex_cap = 2 };

struct ConeRoot {
    double after = 0.0;  // the axial ray's start
    ConePart part = ConePart::side;
};

struct ConeRoots {
    ConeProfile profile;
    AxialRay axial;
    std::array<ConeRoot, 2> root;  // where the line enters, and where it leaves
    int count = 0;                 // fewer than two if it does so through an open end

    [[nodiscard]] double t(const ConeRoot& of) const { return axial.start + of.after; }
};

// Nothing if the ray's line misses the body.
std::optional<ConeRoots> cone_roots(const Cone& cone, const ObjectRay& ray);
glm::dvec3 cone_normal(const Cone& cone, const ConeRoots& roots, const ConeRoot& root);
glm::dvec2 cone_uv(const Cone& cone, const ConeRoots& roots, const ConeRoot& root);

}  // namespace raypick
