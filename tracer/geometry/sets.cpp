#include "tracer/error.h"
#include "tracer/geometry/parts.h"
#include "tracer/geometry/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace raypick {

namespace {

// Primitives and tree nodes are numbered in 32 bits.
void check_count(const std::string& what, const char* primitives, std::size_t count) {
    constexpr std::size_t kMost = std::size_t{1} << 30;
    if (count <= kMost) return;
    throw Error(fmt::format("{}: {} {} are too many, split it into sets of {}", what, count,
                            primitives, kMost));
}

bool finite(const glm::vec4& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

void check_end(const std::string& set, std::size_t cone, const char* name, const glm::vec4& end) {
    if (!finite(end)) {
        throw Error(
            fmt::format("{}: cone {}: {} and its radius must be finite numbers, not {} {} "
                        "{} and {}",
                        set, cone, name, end.x, end.y, end.z, end.w));
    }
    if (!(end.w >= 0.0f)) {
        throw Error(fmt::format("{}: cone {}: {}_radius must be 0 or more, not {}", set, cone, name,
                                end.w));
    }
}

void check_cone(const std::string& set, std::size_t cone, const glm::vec4& base,
                const glm::vec4& apex) {
    check_end(set, cone, "base", base);
    check_end(set, cone, "apex", apex);
    if (base.w == 0.0f && apex.w == 0.0f) {
        throw Error(
            fmt::format("{}: cone {}: base_radius and apex_radius must not both be 0", set, cone));
    }
    if (glm::vec3(base) == glm::vec3(apex)) {
        throw Error(fmt::format("{}: cone {}: base and apex are the same point, {} {} {}", set,
                                cone, base.x, base.y, base.z));
    }
}

}  // namespace

SphereSet make_sphere_set(std::string name, std::vector<glm::vec4> spheres,
                          std::vector<Part> parts) {
    SphereSet set;
    set.name = std::move(name);
    set.parts = std::move(parts);
    set.storage = std::make_shared<const std::vector<glm::vec4>>(std::move(spheres));
    set.spheres = *set.storage;
    return set;
}

ConeSet make_cone_set(std::string name, std::vector<glm::vec4> ends, bool capped,
                      std::vector<Part> parts) {
    ConeSet set;
    set.name = std::move(name);
    set.capped = capped;
    set.parts = std::move(parts);
    set.storage = std::make_shared<const std::vector<glm::vec4>>(std::move(ends));
    set.ends = *set.storage;
    return set;
}

void check_set(const SphereSet& set) {
    const std::string what = fmt::format("sphere set \"{}\"", set.name);
    check_count(what, "spheres", set.spheres.size());
    for (std::size_t i = 0; i < set.spheres.size(); ++i) {
        const glm::vec4& sphere = set.spheres[i];
        if (!finite(sphere)) {
            throw Error(
                fmt::format("{}: sphere {}: centre and radius must be finite numbers, not "
                            "{} {} {} and {}",
                            what, i, sphere.x, sphere.y, sphere.z, sphere.w));
        }
        if (!(sphere.w > 0.0f)) {
            throw Error(
                fmt::format("{}: sphere {}: radius must be positive, not {}", what, i, sphere.w));
        }
    }
    check_parts("sphere set", set.name, "sphere", set.parts, set.spheres.size());
}

void check_set(const ConeSet& set) {
    const std::string what = fmt::format("cone set \"{}\"", set.name);
    if (set.ends.size() % 2 != 0) {
        throw Error(fmt::format("{}: {} ends are no whole number of cones: give two a cone", what,
                                set.ends.size()));
    }
    check_count(what, "cones", set.size());
    for (std::size_t i = 0; i < set.size(); ++i)
        check_cone(what, i, set.ends[2 * i], set.ends[2 * i + 1]);
    check_parts("cone set", set.name, "cone", set.parts, set.size());
}

}  // namespace raypick
