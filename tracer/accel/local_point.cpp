#include "tracer/accel/local_point.h"

#include "tracer/geometry/absolute.h"
#include "tracer/geometry/axis_frame.h"
#include "tracer/geometry/rectangle.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace raypick {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double largest_coordinate(const glm::dvec3& v) {
    return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

glm::dvec3 at(const ObjectRay& ray, double t) {
    return ray.origin + t * ray.direction;
}

double finite_or(double t, float known) {
    return std::isfinite(t) ? t : static_cast<double>(known);
}

// What the shape's intersection found where it gave this hit: a Hit has t in float only. `parts`:
// the hit's primitive is a part of the shape, not an element of a set.
template <typename AnyShape>
ShapeHit found_again(const AnyShape& shape, const ObjectRay& ray, const Hit& hit, bool parts) {
    ShapeHit best;
    best.t = static_cast<double>(hit.t);
    best.primitive = parts ? hit.primitive : 0;
    double smallest_gap = std::numeric_limits<double>::infinity();
    const ShapeHits hits = intersect(shape, ray);
    for (int i = 0; i < hits.count; ++i) {
        const ShapeHit& candidate = hits.hit[static_cast<std::size_t>(i)];
        if (parts && candidate.primitive != hit.primitive) continue;
        const double gap = std::abs(candidate.t - static_cast<double>(hit.t));
        if (!(gap < smallest_gap)) continue;
        smallest_gap = gap;
        best = candidate;
    }
    return best;
}

// How near to the rim of a piece of surface points may lie.
class Rim {
public:
    explicit Rim(const PointNeeds& needs) : needs_(needs) {}

    // The rim's share of a way across the piece, at most a quarter.
    [[nodiscard]] double share(const glm::dvec3& across) const {
        return share(glm::length(in_scene(across)));
    }
    // The same of the height over `edge` of a piece that reaches by `across` from it.
    [[nodiscard]] double share(const glm::dvec3& across, const glm::dvec3& edge) const {
        const glm::dvec3 base = in_scene(edge);
        const double area = glm::length(glm::cross(in_scene(across), base));
        return share(area / glm::length(base));
    }
    [[nodiscard]] bool holds(const glm::dvec3& way) const {
        return glm::length(in_scene(way)) < needs_.rim;
    }
    // True if a point of a triangle whose least weight this is lies within no rim of its edges: its
    // distance to each is at least that weight's share of the least height. Quick to see for most.
    [[nodiscard]] bool is_far(double least_weight, const glm::dvec3& edge_b,
                              const glm::dvec3& edge_c, const glm::dvec3& normal) const {
        const glm::dvec3 b = in_scene(edge_b);
        const glm::dvec3 c = in_scene(edge_c);
        const glm::dvec3 area = needs_.world_from_object != nullptr ? glm::cross(b, c) : normal;
        const glm::dvec3 across = c - b;
        const double longest =
            std::max(std::max(glm::dot(b, b), glm::dot(c, c)), glm::dot(across, across));
        return least_weight > 0.0 && least_weight * least_weight * glm::dot(area, area) >
                                         1.0001 * needs_.rim * needs_.rim * longest;
    }

private:
    [[nodiscard]] double share(double length) const {
        return length > 4.0 * needs_.rim ? needs_.rim / length : 0.25;
    }
    [[nodiscard]] glm::dvec3 in_scene(const glm::dvec3& v) const {
        return needs_.world_from_object != nullptr ? *needs_.world_from_object * v : v;
    }

    const PointNeeds& needs_;
};

// Around an axis: the unit vectors away from it and along the turn. On the axis: the frame's own.
struct Around {
    glm::dvec3 away{0.0};
    glm::dvec3 along{0.0};
    double distance = 0.0;
};

Around around_axis(const AxisFrame& frame, const glm::dvec3& from_axis_point) {
    const double x = glm::dot(from_axis_point, frame.x);
    const double z = glm::dot(from_axis_point, frame.z);
    const double distance = std::hypot(x, z);
    const double cosine = distance > 0.0 ? x / distance : 1.0;
    const double sine = distance > 0.0 ? z / distance : 0.0;
    return {cosine * frame.x + sine * frame.z, cosine * frame.z - sine * frame.x, distance};
}

LocalPoint flat_point(const glm::dvec3& position, const glm::dvec3& normal, double magnitude) {
    LocalPoint point;
    point.position = position;
    point.geometric_normal = normal;
    point.shading_normal = normal;
    point.magnitude = magnitude;
    return point;
}

// The t, in double, at which the ray meets a sphere nearest to this one.
double sphere_t(const Sphere& sphere, const ObjectRay& ray, double t) {
    const double a = glm::dot(ray.direction, ray.direction);
    const glm::dvec3 f = ray.origin - sphere.centre;
    const double middle = -glm::dot(f, ray.direction) / a;
    const glm::dvec3 closest = f + middle * ray.direction;
    const double squared = (sphere.radius * sphere.radius - glm::dot(closest, closest)) / a;
    if (!(squared > 0.0)) return t;
    return middle + std::copysign(std::sqrt(squared), t - middle);
}

LocalPoint sphere_point(const Sphere& sphere, const Hit& hit, const ObjectRay& ray,
                        bool derivatives) {
    const double t = sphere_t(sphere, ray, static_cast<double>(hit.t));
    const glm::dvec3 n = glm::normalize(at(ray, t) - sphere.centre);
    LocalPoint point = flat_point(sphere.centre + sphere.radius * n, n,
                                  largest_coordinate(sphere.centre) + sphere.radius);
    if (!derivatives) return point;
    const double from_axis = std::hypot(n.x, n.z);
    if (!(from_axis > 1e-9)) return point;  // the poles have no longitude
    point.dpdu = kTurn * sphere.radius * glm::dvec3(-n.z, 0.0, n.x);
    point.dpdv = std::numbers::pi * sphere.radius *
                 glm::dvec3(n.y * n.x / from_axis, -from_axis, n.y * n.z / from_axis);
    return point;
}

// A disk and its derivatives by angle and radius; the outer radius counts.
LocalPoint disk_point(const Disk& disk, const AxisFrame& frame, const ObjectRay& ray, double t,
                      const Rim& rim) {
    const Around around = around_axis(frame, at(ray, t) - disk.centre);
    const double width = disk.radius - disk.inner_radius;
    const double margin = width * rim.share(width * around.away);
    const double hole = disk.inner_radius > 0.0 ? disk.inner_radius + margin : 0.0;
    const double radius = std::clamp(around.distance, hole, disk.radius - margin);
    LocalPoint point = flat_point(disk.centre + radius * around.away, disk.normal,
                                  largest_coordinate(disk.centre) + disk.radius);
    if (!(around.distance > 0.0)) return point;
    point.dpdu = kTurn * radius * around.along;
    point.dpdv = disk.radius * around.away;
    return point;
}

LocalPoint cone_point(const Cone& cone, const ShapeHit& hit, const ObjectRay& ray, const Rim& rim) {
    const glm::dvec3 axis = cone.apex - cone.base;
    const double length = glm::length(axis);
    // Caps measure their angles in the side's frame, whichever way they look.
    const AxisFrame frame = axis_frame(axis);
    const double magnitude =
        std::max(largest_coordinate(cone.base), largest_coordinate(cone.apex)) +
        std::max(cone.base_radius, cone.apex_radius);
    if (hit.primitive != 0) {
        const bool is_base = hit.primitive == 1;
        const Disk cap{is_base ? cone.base : cone.apex, is_base ? -frame.y : frame.y,
                       is_base ? cone.base_radius : cone.apex_radius, 0.0};
        LocalPoint point = disk_point(cap, frame, ray, hit.t, rim);
        point.magnitude = magnitude;
        return point;
    }
    const glm::dvec3 from_base = at(ray, hit.t) - cone.base;
    const Around around = around_axis(frame, from_base);
    const glm::dvec3 narrowing = (cone.apex_radius - cone.base_radius) * around.away;
    const double end = rim.share(axis + narrowing);
    // At a tip the side itself is the other wall.
    const auto margin = [&](double radius) {
        return rim.holds(radius * around.away) ? std::max(end, rim.share(narrowing)) : end;
    };
    const double height = std::clamp(glm::dot(from_base, frame.y) / length,
                                     margin(cone.base_radius), 1.0 - margin(cone.apex_radius));
    const double radius = cone.base_radius + height * (cone.apex_radius - cone.base_radius);
    const double widening = (cone.apex_radius - cone.base_radius) / length;
    const glm::dvec3 foot =
        height < 0.5 ? cone.base + height * axis : cone.apex - (1.0 - height) * axis;
    LocalPoint point =
        flat_point(foot + radius * around.away, around.away - widening * frame.y, magnitude);
    if (!(radius > 0.0)) return point;
    point.dpdu = kTurn * radius * around.along;
    point.dpdv = axis + narrowing;
    return point;
}

LocalPoint torus_point(const Torus& torus, const ShapeHit& hit, const ObjectRay& ray) {
    const AxisFrame frame = axis_frame(torus.axis);
    const glm::dvec3 from_centre = at(ray, hit.t) - torus.centre;
    const Around around = around_axis(frame, from_centre);
    const glm::dvec3 ring = torus.major_radius * around.away;
    const glm::dvec3 out = glm::normalize(from_centre - ring);
    LocalPoint point =
        flat_point(torus.centre + ring + torus.minor_radius * out, out,
                   largest_coordinate(torus.centre) + torus.major_radius + torus.minor_radius);
    const double from_axis = torus.major_radius + torus.minor_radius * glm::dot(out, around.away);
    point.dpdu = kTurn * from_axis * around.along;
    point.dpdv = kTurn * torus.minor_radius *
                 (glm::dot(out, around.away) * frame.y - glm::dot(out, frame.y) * around.away);
    return point;
}

// Weights of a triangle's corners, none of them below its margin.
glm::dvec3 off_the_edges(const glm::dvec3& weights, const glm::dvec3& margin) {
    const glm::dvec3 room = glm::max(weights - margin, 0.0);
    if (room == weights - margin) return weights;
    const double free = 1.0 - (margin.x + margin.y + margin.z);
    return margin + free / (room.x + room.y + room.z) * room;
}

// The weights of b and c where the ray meets the triangle's plane, in double: a Hit has them in
// float. Source: Moeller, Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1),
// 1997.
glm::dvec2 exact_weights(const ObjectRay& ray, const Hit& hit, const glm::dvec3& a,
                         const glm::dvec3& edge_b, const glm::dvec3& edge_c,
                         const glm::dvec3& normal) {
    const glm::dvec3 q = glm::cross(ray.origin - a, ray.direction);
    const double scale = -1.0 / glm::dot(normal, ray.direction);
    const glm::dvec2 uv{glm::dot(q, edge_c) * scale, -glm::dot(q, edge_b) * scale};
    // A ray along the plane gives anything.
    const glm::dvec2 known(hit.uv);
    const glm::dvec2 gap = absolute(uv - known);
    return gap.x < 1e-3 && gap.y < 1e-3 ? uv : known;
}

// The point a u v of the plane through the corners, exact to double rounding.
LocalPoint triangle_point(const ObjectRay& ray, const Hit& hit, const glm::dvec3& a,
                          const glm::dvec3& b, const glm::dvec3& c, const Rim& rim) {
    const glm::dvec3 edge_b = b - a;
    const glm::dvec3 edge_c = c - a;
    const glm::dvec3 normal = glm::cross(edge_b, edge_c);
    const glm::dvec2 uv = exact_weights(ray, hit, a, edge_b, edge_c, normal);
    glm::dvec3 weights{1.0 - uv.x - uv.y, uv.x, uv.y};
    const double least = std::min(std::min(weights.x, weights.y), weights.z);
    if (!rim.is_far(least, edge_b, edge_c, normal)) {
        weights = off_the_edges(weights, {rim.share(edge_b, c - b), rim.share(b - c, edge_c),
                                          rim.share(edge_c, edge_b)});
    }
    LocalPoint point = flat_point(
        weights.x * a + weights.y * b + weights.z * c, normal,
        std::max(std::max(largest_coordinate(a), largest_coordinate(b)), largest_coordinate(c)));
    point.dpdu = edge_b;
    point.dpdv = edge_c;
    return point;
}

// What a pick reads next to the corners' positions is seldom in a cache: the processor may bring it
// while the point is worked out.
void fetch_more(const Mesh& mesh, const glm::uvec3& corner) {
    for (int k = 0; k < 3; ++k) {
        if (!mesh.normals.empty()) __builtin_prefetch(&mesh.normals[corner[k]]);
        if (!mesh.uvs.empty()) __builtin_prefetch(&mesh.uvs[corner[k]]);
    }
}

// Interpolated, turned to the side of the geometric normal.
void take_mesh_normal(const Mesh& mesh, const glm::uvec3& corner, const Hit& hit,
                      LocalPoint& point) {
    const auto u = static_cast<double>(hit.uv.x);
    const auto v = static_cast<double>(hit.uv.y);
    const glm::dvec3 normal = (1.0 - u - v) * glm::dvec3(mesh.normals[corner.x]) +
                              u * glm::dvec3(mesh.normals[corner.y]) +
                              v * glm::dvec3(mesh.normals[corner.z]);
    if (!(glm::dot(normal, normal) > 1e-12)) return;
    point.shading_normal = glm::dot(normal, point.geometric_normal) < 0.0 ? -normal : normal;
    point.smooth = true;
}

struct LocalPointOf {
    const Scene& scene;
    const ObjectRay& ray;
    const Hit& hit;
    Rim rim;
    bool derivatives;

    LocalPoint operator()(const Sphere& sphere) const {
        return sphere_point(sphere, hit, ray, derivatives);
    }

    LocalPoint operator()(const Plane& plane) const {
        const glm::dvec3 n = plane.normal;
        const double above = glm::dot(n, ray.origin) + plane.d;
        const glm::dvec3 p = at(ray, finite_or(-above / glm::dot(n, ray.direction), hit.t));
        const double height = glm::dot(n, p) + plane.d;
        LocalPoint point = flat_point(p - n * (height / glm::dot(n, n)), n, largest_coordinate(p));
        // u and v are the coordinates other than the one that the normal is longest along.
        const glm::dvec3 length = absolute(n);
        int across = 2;
        if (length.x > length.y && length.x > length.z) {
            across = 0;
        } else if (length.y >= length.z) {
            across = 1;
        }
        const int u = across == 0 ? 1 : 0;
        const int v = across == 2 ? 1 : 2;
        point.dpdu[u] = 1.0;
        point.dpdu[across] = -n[u] / n[across];
        point.dpdv[v] = 1.0;
        point.dpdv[across] = -n[v] / n[across];
        return point;
    }

    LocalPoint operator()(const Box& box) const {
        const auto axis = static_cast<int>(hit.primitive / 2);
        const bool upper = hit.primitive % 2 != 0;
        LocalPoint point;
        point.position[axis] = upper ? box.max[axis] : box.min[axis];
        const double way = (point.position[axis] - ray.origin[axis]) / ray.direction[axis];
        const glm::dvec3 p = at(ray, finite_or(way, hit.t));
        point.geometric_normal[axis] = upper ? 1.0 : -1.0;
        point.shading_normal = point.geometric_normal;
        point.magnitude = std::max(largest_coordinate(box.min), largest_coordinate(box.max));
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        point.dpdu[u] = box.max[u] - box.min[u];
        point.dpdv[v] = box.max[v] - box.min[v];
        const double margin_u = point.dpdu[u] * rim.share(point.dpdu, point.dpdv);
        const double margin_v = point.dpdv[v] * rim.share(point.dpdv, point.dpdu);
        point.position[u] = std::clamp(p[u], box.min[u] + margin_u, box.max[u] - margin_u);
        point.position[v] = std::clamp(p[v], box.min[v] + margin_v, box.max[v] - margin_v);
        return point;
    }

    LocalPoint operator()(const Triangle& triangle) const {
        return triangle_point(ray, hit, triangle.a, triangle.b, triangle.c, rim);
    }

    LocalPoint operator()(const Disk& disk) const {
        return disk_point(disk, axis_frame(disk.normal), ray, found_again(disk, ray, hit, true).t,
                          rim);
    }

    LocalPoint operator()(const Rectangle& rectangle) const {
        ShapeHit exact;
        meet_within(rectangle, ray, exact);
        const glm::dvec3& u = rectangle.edge_u;
        const glm::dvec3& v = rectangle.edge_v;
        const double magnitude =
            largest_coordinate(rectangle.corner) + largest_coordinate(u) + largest_coordinate(v);
        const double margin_u = rim.share(u, v);
        const double margin_v = rim.share(v, u);
        LocalPoint point =
            flat_point(rectangle.corner + std::clamp(exact.uv.x, margin_u, 1.0 - margin_u) * u +
                           std::clamp(exact.uv.y, margin_v, 1.0 - margin_v) * v,
                       glm::cross(u, v), magnitude);
        point.dpdu = u;
        point.dpdv = v;
        return point;
    }

    LocalPoint operator()(const Cone& cone) const {
        return cone_point(cone, found_again(cone, ray, hit, true), ray, rim);
    }

    LocalPoint operator()(const Torus& torus) const {
        return torus_point(torus, found_again(torus, ray, hit, true), ray);
    }

    LocalPoint operator()(const SphereSetInstance& instance) const {
        const Sphere sphere = sphere_of(scene.sphere_sets[instance.set], hit.primitive);
        return sphere_point(sphere, hit, ray, derivatives);
    }

    LocalPoint operator()(const ConeSetInstance& instance) const {
        const Cone cone = cone_of(scene.cone_sets[instance.set], hit.primitive);
        return cone_point(cone, found_again(cone, ray, hit, false), ray, rim);
    }

    LocalPoint operator()(const MeshInstance& instance) const {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const glm::uvec3 corner = mesh.triangles[hit.primitive];
        fetch_more(mesh, corner);
        LocalPoint point = triangle_point(ray, hit, glm::dvec3(mesh.positions[corner.x]),
                                          glm::dvec3(mesh.positions[corner.y]),
                                          glm::dvec3(mesh.positions[corner.z]), rim);
        if (!mesh.normals.empty()) take_mesh_normal(mesh, corner, hit, point);
        if (derivatives) {
            const MeshDerivatives by_uv = mesh_derivatives(mesh, corner);
            point.dpdu = by_uv.dpdu;
            point.dpdv = by_uv.dpdv;
        }
        return point;
    }
};

}  // namespace

MeshDerivatives mesh_derivatives(const Mesh& mesh, const glm::uvec3& corner) {
    if (mesh.uvs.empty()) return {};
    const glm::dvec2 a(mesh.uvs[corner.x]);
    const glm::dvec2 b = glm::dvec2(mesh.uvs[corner.y]) - a;
    const glm::dvec2 c = glm::dvec2(mesh.uvs[corner.z]) - a;
    const double determinant = b.x * c.y - b.y * c.x;
    if (!(std::abs(determinant) > 1e-15 * glm::length(b) * glm::length(c))) return {};
    const glm::dvec3 first(mesh.positions[corner.x]);
    const glm::dvec3 edge_b = glm::dvec3(mesh.positions[corner.y]) - first;
    const glm::dvec3 edge_c = glm::dvec3(mesh.positions[corner.z]) - first;
    return {(c.y * edge_b - b.y * edge_c) / determinant,
            (b.x * edge_c - c.x * edge_b) / determinant};
}

LocalPoint local_point(const Scene& scene, const Object& object, const ObjectRay& ray,
                       const Hit& hit, const PointNeeds& needs) {
    return std::visit(LocalPointOf{scene, ray, hit, Rim(needs), needs.derivatives}, object.shape);
}

}  // namespace raypick
