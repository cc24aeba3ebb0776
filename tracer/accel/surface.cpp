#include "tracer/accel/surface.h"

#include "tracer/accel/local_point.h"
#include "tracer/geometry/absolute.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace raypick {

namespace {

double largest_component(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

// The way of points and vectors between an object's space and the scene's. Where both are the same
// nothing is multiplied.
class Placement {
public:
    Placement(const Transform& world_from_object, const Transform& object_from_world)
        : world_from_object_(world_from_object),
          object_from_world_(object_from_world),
          moves_(!object_from_world.is_identity()) {}

    [[nodiscard]] ObjectRay object_ray(const Ray& ray) const {
        const glm::dvec3 origin(ray.origin);
        const glm::dvec3 direction(ray.direction);
        if (!moves_) return {origin, direction};
        return {object_from_world_.point(origin), object_from_world_.vector(direction)};
    }
    [[nodiscard]] glm::dvec3 world_point(const glm::dvec3& p) const {
        return moves_ ? world_from_object_.point(p) : p;
    }
    [[nodiscard]] glm::dvec3 world_vector(const glm::dvec3& v) const {
        return moves_ ? world_from_object_.vector(v) : v;
    }
    [[nodiscard]] glm::dvec3 world_normal(const glm::dvec3& n) const {
        return moves_ ? raypick::world_normal(object_from_world_, n) : glm::normalize(n);
    }
    // nullptr where nothing moves.
    [[nodiscard]] const glm::dmat3* linear() const {
        return moves_ ? &world_from_object_.linear : nullptr;
    }

    // Bound on what rounding did to the point: to float when it was stored, and to double (with
    // room to spare) on the way from the ray through the object's space and back. A secondary ray's
    // own intersection goes the same way, and must find the surface behind it.
    [[nodiscard]] glm::dvec3 rounding_bound(double magnitude, const glm::dvec3& position) const {
        const glm::dvec3 size = absolute(position);
        return size * 0x1p-24 + reach(magnitude, size) * 0x1p-47;
    }

    // The largest of rounding_bound(0, position).
    [[nodiscard]] double largest_rounding_bound(const glm::dvec3& position) const {
        if (moves_) return largest_component(rounding_bound(0.0, position));
        const double size = largest_component(absolute(position));
        return size * 0x1p-24 + size * 0x1p-47;
    }

private:
    [[nodiscard]] glm::dvec3 reach(double magnitude, const glm::dvec3& size) const {
        if (!moves_) return size + magnitude;
        const auto sizes = [](const glm::dmat3& m) {
            return glm::dmat3(absolute(m[0]), absolute(m[1]), absolute(m[2]));
        };
        const glm::dvec3 inside = sizes(object_from_world_.linear) * size +
                                  absolute(object_from_world_.translation) + magnitude;
        return sizes(world_from_object_.linear) * inside + absolute(world_from_object_.translation);
    }

    const Transform& world_from_object_;
    const Transform& object_from_world_;
    bool moves_;
};

// A ray leaves a wall by up to three such bounds. This many along the wall keep it on the right
// side of another one that meets it at a sharp angle, and are less than can be seen.
constexpr double kRimInBounds = 64.0;

// The weights of tangent vectors p and q that make up `vector`, which lies in their plane.
class TangentPlane {
public:
    TangentPlane(const glm::vec3& p, const glm::vec3& q)
        : p_(p), q_(q), pp_(glm::dot(p_, p_)), pq_(glm::dot(p_, q_)), qq_(glm::dot(q_, q_)) {
        const double determinant = pp_ * qq_ - pq_ * pq_;
        inverse_ = determinant > 1e-12 * pp_ * qq_ ? 1.0 / determinant : 0.0;
    }

    // 0 if p and q span no plane.
    [[nodiscard]] glm::vec2 weights(const glm::dvec3& vector) const {
        const double along_p = glm::dot(vector, p_);
        const double along_q = glm::dot(vector, q_);
        return {static_cast<float>((qq_ * along_p - pq_ * along_q) * inverse_),
                static_cast<float>((pp_ * along_q - pq_ * along_p) * inverse_)};
    }

private:
    glm::dvec3 p_;
    glm::dvec3 q_;
    double pp_;
    double pq_;
    double qq_;
    double inverse_ = 0.0;
};

}  // namespace

SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit) {
    const Object& object = scene.objects[object_index(scene, hit.object)];
    const Transform object_from_world = inverse(object.world_from_object).value_or(Transform{});
    SurfacePoint surface;
    set_surface_point(scene, {object, object_from_world, material_id(scene, object, hit.primitive)},
                      ray, hit, surface);
    return surface;
}

void set_surface_point(const Scene& scene, const HitObject& at, const Ray& ray, const Hit& hit,
                       SurfacePoint& surface) {
    const Placement place(at.object.world_from_object, at.object_from_world);
    const glm::dvec3 met =
        glm::dvec3(ray.origin) + static_cast<double>(hit.t) * glm::dvec3(ray.direction);
    const double rim = kRimInBounds * place.largest_rounding_bound(met);
    const LocalPoint local = local_point(scene, at.object, place.object_ray(ray), hit,
                                         {place.linear(), rim, at.textured});
    const glm::dvec3 position = place.world_point(local.position);

    surface.position = glm::vec3(position);
    surface.position_error = glm::vec3(place.rounding_bound(local.magnitude, position)) +
                             std::numeric_limits<float>::min();
    surface.geometric_normal = glm::vec3(place.world_normal(local.geometric_normal));
    surface.shading_normal = local.smooth ? glm::vec3(place.world_normal(local.shading_normal))
                                          : surface.geometric_normal;
    set_untextured(hit, at.material, surface);
    if (at.textured) {
        surface.texture_uv = texture_uv(scene, at.object, hit);
        surface.dpdu = glm::vec3(place.world_vector(local.dpdu));
        surface.dpdv = glm::vec3(place.world_vector(local.dpdv));
    }
}

glm::vec2 texture_uv(const Scene& scene, const Object& object, const Hit& hit) {
    const auto* instance = std::get_if<MeshInstance>(&object.shape);
    if (instance == nullptr) return hit.uv;
    const Mesh& mesh = scene.meshes[instance->mesh];
    if (mesh.uvs.empty()) return glm::vec2(0.0f);
    const glm::uvec3 corner = mesh.triangles[hit.primitive];
    return (1.0f - hit.uv.x - hit.uv.y) * mesh.uvs[corner.x] + hit.uv.x * mesh.uvs[corner.y] +
           hit.uv.y * mesh.uvs[corner.z];
}

Footprint footprint(const SurfacePoint& point, const glm::vec3& direction, float width) {
    constexpr double kLeastCosine = 1.0 / 64;
    const glm::dvec3 n(point.geometric_normal);
    const glm::dvec3 d(direction);
    const double cosine = glm::dot(n, d);
    glm::dvec3 across = glm::cross(n, d);
    // Seen straight on the ellipse is a circle: any two directions do.
    if (!(glm::dot(across, across) > 1e-12)) across = glm::cross(n, glm::dvec3(point.dpdu));
    const double length = glm::length(across);
    if (!(length > 0.0)) return {};
    across /= length;
    const glm::dvec3 shadow = glm::cross(across, n);
    const auto size = static_cast<double>(width);
    const TangentPlane plane(point.dpdu, point.dpdv);
    return {plane.weights(size / std::max(std::abs(cosine), kLeastCosine) * shadow),
            plane.weights(size * across)};
}

}  // namespace raypick
