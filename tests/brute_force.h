// The closest hit without any tree: every shape and triangle is asked, then the tie rule of
// tracer/accel/hit.h is applied word for word.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/geometry/ray.h"
#include "tracer/scene/scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

namespace raypick {

// A hit before anything is rounded to float.
struct Candidate {
    ObjectId object = kNoObject;
    std::uint32_t primitive = 0;
    double t = 0.0;
    glm::dvec2 uv{0.0};
    bool front_face = false;

    [[nodiscard]] Hit rounded() const {
        return {object, primitive, static_cast<float>(t), glm::vec2(uv), front_face};
    }
};

// Bounding spheres of a mesh's triangles: a quick "certainly not" that no tree is involved in.
class TriangleSpheres {
public:
    explicit TriangleSpheres(const Mesh& mesh) {
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec3 a = mesh.positions[t.x];
            const glm::vec3 b = mesh.positions[t.y];
            const glm::vec3 c = mesh.positions[t.z];
            const glm::vec3 centre = (a + b + c) / 3.0f;
            x_.push_back(centre.x);
            y_.push_back(centre.y);
            z_.push_back(centre.z);
            radius_.push_back(std::max(
                {glm::distance(centre, a), glm::distance(centre, b), glm::distance(centre, c)}));
            reach_ = std::max(reach_, glm::length(centre) + radius_.back());
        }
    }

    // Triangles that the ray's line comes near; too many rather than too few. Block by block, so
    // that the compiler can do several at once.
    void near_line(const ObjectRay& ray, std::vector<std::uint32_t>& near) const {
        constexpr std::size_t kBlock = 64;
        const glm::vec3 o(ray.origin);
        const glm::vec3 d(glm::normalize(ray.direction));
        const float slack = 1e-5f * (reach_ + glm::length(o));
        near.clear();
        for (std::size_t first = 0; first < x_.size(); first += kBlock) {
            const std::size_t end = std::min(first + kBlock, x_.size());
            int any = 0;
            for (std::size_t i = first; i < end; ++i)
                any |= is_near(i, o, d, slack) ? 1 : 0;
            if (any == 0) continue;
            for (std::size_t i = first; i < end; ++i) {
                if (is_near(i, o, d, slack)) near.push_back(static_cast<std::uint32_t>(i));
            }
        }
    }

private:
    // Arranged so that NaN means near.
    [[nodiscard]] bool is_near(std::size_t i, const glm::vec3& o, const glm::vec3& d,
                               float slack) const {
        const float x = x_[i] - o.x;
        const float y = y_[i] - o.y;
        const float z = z_[i] - o.z;
        const float cx = y * d.z - z * d.y;
        const float cy = z * d.x - x * d.z;
        const float cz = x * d.y - y * d.x;
        const float r = radius_[i] + slack;
        return !(cx * cx + cy * cy + cz * cz > r * r);
    }

    std::vector<float> x_, y_, z_, radius_;
    float reach_ = 0.0f;
};

class BruteForce {
public:
    explicit BruteForce(const Scene& scene) : scene_(scene) {
        for (const Mesh& mesh : scene.meshes)
            spheres_.emplace_back(mesh);
        for (const Object& object : scene.objects) {
            object_from_world_.push_back(inverse(object.world_from_object).value());
        }
    }

    // All hits that the query leaves, in no particular order.
    [[nodiscard]] std::vector<Candidate> all(const Ray& ray, const RayQuery& query = {}) const {
        std::vector<Candidate> found;
        for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
            const Object& object = scene_.objects[i];
            if ((object.mask & query.mask) == 0) continue;
            const Transform& object_from_world = object_from_world_[i];
            const ObjectRay object_ray{object_from_world.point(glm::dvec3(ray.origin)),
                                       object_from_world.vector(glm::dvec3(ray.direction))};
            collect(object, object_ray, found);
        }
        std::erase_if(found, [&](const Candidate& c) { return !kept(c, ray, query); });
        return found;
    }

private:
    void collect(const Object& object, const ObjectRay& ray, std::vector<Candidate>& found) const {
        std::visit([&](const auto& shape) { collect(object, shape, ray, found); }, object.shape);
    }

    template <typename SimpleShape>
    static void collect(const Object& object, const SimpleShape& shape, const ObjectRay& ray,
                        std::vector<Candidate>& found) {
        add(object, {}, ray, intersect(shape, ray), found);
    }
    void collect(const Object& object, const MeshInstance& instance, const ObjectRay& ray,
                 std::vector<Candidate>& found) const {
        collect_mesh(object, instance.mesh, ray, found);
    }
    void collect(const Object& object, const SphereSetInstance& instance, const ObjectRay& ray,
                 std::vector<Candidate>& found) const {
        const SphereSet& set = scene_.sphere_sets[instance.set];
        for (std::uint32_t i = 0; i < set.spheres.size(); ++i)
            add(object, i, ray, intersect(sphere_of(set, i), ray), found);
    }
    void collect(const Object& object, const ConeSetInstance& instance, const ObjectRay& ray,
                 std::vector<Candidate>& found) const {
        const ConeSet& set = scene_.cone_sets[instance.set];
        for (std::uint32_t i = 0; i < set.size(); ++i)
            add(object, i, ray, intersect(cone_of(set, i), ray), found);
    }

    void collect_mesh(const Object& object, MeshId id, const ObjectRay& ray,
                      std::vector<Candidate>& found) const {
        const Mesh& mesh = scene_.meshes[id];
        std::vector<std::uint32_t> near;
        spheres_[id].near_line(ray, near);
        for (const std::uint32_t i : near) {
            const glm::uvec3& t = mesh.triangles[i];
            const Triangle triangle{glm::dvec3(mesh.positions[t.x]),
                                    glm::dvec3(mesh.positions[t.y]),
                                    glm::dvec3(mesh.positions[t.z])};
            add(object, i, ray, intersect(triangle, ray), found);
        }
    }

    // `element`: the shape's number in a mesh or set.
    static void add(const Object& object, std::optional<std::uint32_t> element,
                    const ObjectRay& ray, const ShapeHits& hits, std::vector<Candidate>& found) {
        for (int i = 0; i < hits.count; ++i) {
            const ShapeHit& hit = hits.hit[static_cast<std::size_t>(i)];
            const bool front_face = glm::dot(hit.normal, ray.direction) < 0.0;
            if (object.sides == Sides::front_only && !front_face) continue;
            if (object.sides == Sides::back_only && front_face) continue;
            found.push_back(
                {object.id, element.value_or(hit.primitive), hit.t, hit.uv, front_face});
        }
    }

    static bool kept(const Candidate& c, const Ray& ray, const RayQuery& query) {
        if (!(c.t > static_cast<double>(ray.t_min) && c.t < static_cast<double>(ray.t_max))) {
            return false;
        }
        if (query.sides == Sides::front_only && !c.front_face) return false;
        if (query.sides == Sides::back_only && c.front_face) return false;
        const glm::dvec3 p = glm::dvec3(ray.origin) + c.t * glm::dvec3(ray.direction);
        for (const ClipPlane& plane : query.clip_planes) {
            if (glm::dot(glm::dvec3(plane.normal), p) + static_cast<double>(plane.d) < 0.0) {
                return false;
            }
        }
        return query.accept(c.rounded());
    }

    const Scene& scene_;
    std::vector<TriangleSpheres> spheres_;
    std::vector<Transform> object_from_world_;
};

// The winner if surfaces within `gap` of the closest tie.
inline std::optional<Candidate> winner(const std::vector<Candidate>& candidates, double gap) {
    if (candidates.empty()) return std::nullopt;
    double closest = candidates.front().t;
    for (const Candidate& c : candidates)
        closest = std::min(closest, c.t);
    std::optional<Candidate> best;
    for (const Candidate& c : candidates) {
        if (c.t > closest * (1.0 + gap)) continue;
        if (!best || std::tuple(c.object, c.primitive, c.t) <
                         std::tuple(best->object, best->primitive, best->t)) {
            best = c;
        }
    }
    return best;
}

inline std::string to_text(const Hit& hit) {
    std::ostringstream text;
    text.precision(9);
    text << "object " << hit.object << " primitive " << hit.primitive << " t " << hit.t << " uv "
         << hit.uv.x << ' ' << hit.uv.y << (hit.front_face ? " front" : " back");
    return text.str();
}

inline std::string to_text(const std::optional<Hit>& hit) {
    return hit ? to_text(*hit) : std::string("miss");
}

inline std::string to_text(const Ray& ray) {
    std::ostringstream text;
    text << std::hexfloat << "origin " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z
         << " direction " << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z
         << " t " << ray.t_min << " .. " << ray.t_max;
    return text.str();
}

// "" if `got` is what the candidates and the tie rule say, else what is wrong. The rule speaks
// of the t that a Hit holds, a float: what lies on the rim of the gap, give or take the rounding of
// two floats, may be in or out.
inline std::string complaint(const std::optional<Hit>& got,
                             const std::vector<Candidate>& candidates) {
    const std::optional<Candidate> narrow = winner(candidates, 0.9 * kTieGap);
    const std::optional<Candidate> wide = winner(candidates, 1.1 * kTieGap);
    if (!narrow) return got ? "should miss, but hits " + to_text(*got) : "";
    if (got && (*got == narrow->rounded() || *got == wide->rounded())) return "";
    return "should hit " + to_text(narrow->rounded()) + ", but " + to_text(got);
}

}  // namespace raypick
