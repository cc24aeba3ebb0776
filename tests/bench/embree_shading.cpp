#include "tests/bench/embree_shading.h"

#ifdef RAYPICK_HAS_EMBREE

#include "tracer/scene/environment.h"
#include "tracer/shade/fresnel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raypick::bench {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float largest(const glm::vec3& v) {
    return std::max({v.x, v.y, v.z});
}

template <class T>
T weighted(std::span<const T> values, const glm::uvec3& corners, const RTCHit& hit) {
    return (1.0f - hit.u - hit.v) * values[corners.x] + hit.u * values[corners.y] +
           hit.v * values[corners.z];
}

glm::vec3 mirrored_at(const glm::vec3& incoming, const glm::vec3& normal) {
    return incoming - 2.0f * glm::dot(incoming, normal) * normal;
}

std::optional<glm::vec3> refracted_at(const glm::vec3& incoming, const glm::vec3& normal,
                                      float eta) {
    const float cosine = -glm::dot(incoming, normal);
    const float squared = 1.0f - eta * eta * (1.0f - cosine * cosine);
    if (!(squared >= 0.0f)) return std::nullopt;
    return eta * incoming + (eta * cosine - std::sqrt(squared)) * normal;
}

glm::vec3 phong_or_blinn(const SurfaceMaterial& material, const glm::vec3& normal,
                         const glm::vec3& to_light, const glm::vec3& incoming, float cosine) {
    glm::vec3 colour = cosine * material.diffuse;
    if (material.specular == glm::vec3(0.0f)) return colour;
    const float shine = material.model == LocalModel::phong
                            ? glm::dot(mirrored_at(incoming, normal), to_light)
                            : glm::dot(normal, glm::normalize(to_light - incoming));
    if (shine > 0.0f) colour += std::pow(shine, material.shininess) * material.specular;
    return colour;
}

}  // namespace

EmbreeShading::EmbreeShading(const EmbreeRenderer& renderer, const RenderSettings& settings)
    : renderer_(renderer), settings_(settings), scene_(renderer.scene().handle()) {
    rtcInitIntersectContext(&context_);
}

glm::vec3 EmbreeShading::follow(const Ray& ray, float weight, int depth) {
    RTCRayHit query;
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context_, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return environment_colour(renderer_.source(), ray.direction);
    }
    const Point point = point_of(ray, query);
    const glm::vec3 colour = shade(point, weight, depth);
    const glm::vec3& absorption = point.look->material->absorption;
    if (point.front_face || absorption == glm::vec3(0.0f)) return colour;
    return colour * glm::vec3(std::exp(-absorption.x * query.ray.tfar),
                              std::exp(-absorption.y * query.ray.tfar),
                              std::exp(-absorption.z * query.ray.tfar));
}

EmbreeShading::Point EmbreeShading::point_of(const Ray& ray, const RTCRayHit& query) const {
    const RTCHit& hit = query.hit;
    const bool is_instance = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
    const Surface& surface = renderer_.surfaces()[is_instance ? hit.instID[0] : hit.geomID];
    Point point;
    point.incoming = ray.direction;
    point.position = ray.origin + query.ray.tfar * ray.direction;
    find_normals(point, surface, hit);
    const std::size_t of = surface.looks.size() > 1 ? hit.primID : 0;
    point.look = &renderer_.looks()[surface.looks[of]];
    point.material = mapped(*point.look, surface, hit);
    return point;
}

void EmbreeShading::find_normals(Point& point, const Surface& surface, const RTCHit& hit) const {
    const glm::vec3 outward(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    point.geometric =
        glm::normalize(surface.is_instance ? surface.normal_from_object * outward : outward);
    point.normal = point.geometric;
    if (surface.mesh != nullptr && !surface.mesh->normals.empty()) {
        const glm::uvec3& corners = surface.mesh->triangles[hit.primID];
        point.normal = glm::normalize(surface.normal_from_object *
                                      weighted(surface.mesh->normals, corners, hit));
    }
    point.front_face = glm::dot(point.geometric, point.incoming) < 0.0f;
    if (!point.front_face) {
        point.geometric = -point.geometric;
        point.normal = -point.normal;
    }
}

SurfaceMaterial EmbreeShading::mapped(const Look& look, const Surface& surface,
                                      const RTCHit& hit) const {
    const Material& source = *look.material;
    SurfaceMaterial material = plain(source);
    if (!look.mapped || surface.mesh == nullptr || surface.mesh->uvs.empty()) return material;
    const glm::vec2 uv = weighted(surface.mesh->uvs, surface.mesh->triangles[hit.primID], hit);
    const auto apply = [&](MapSlot slot, glm::vec3& value) {
        const TextureMap& map = source.map(slot);
        if (map) value *= glm::vec3(sample(renderer_.source().textures[map.texture], map, uv));
    };
    glm::vec3 diffuse(1.0f);
    apply(MapSlot::diffuse, diffuse);
    material.diffuse *= diffuse;
    material.ambient *= diffuse;
    apply(MapSlot::specular, material.specular);
    apply(MapSlot::reflect, material.reflect);
    apply(MapSlot::transmit, material.transmit);
    apply(MapSlot::emissive, material.emissive);
    if (const TextureMap& map = source.map(MapSlot::shininess); map) {
        material.shininess *=
            sample(renderer_.source().textures[map.texture], map, uv)[map.channel];
    }
    return material;
}

glm::vec3 EmbreeShading::shade(const Point& point, float weight, int depth) {
    glm::vec3 colour = lit(point);
    if (depth >= settings_.depth || !(point.look->mirrors || point.look->transmits)) return colour;
    const Split split = split_at(point);
    if (split.through) {
        colour += further(point, *split.through, split.transmitted, weight, depth);
    }
    if (settings_.reflections) {
        glm::vec3 direction = mirrored_at(point.incoming, point.normal);
        if (!(glm::dot(direction, point.geometric) > 0.0f))
            direction = mirrored_at(point.incoming, point.geometric);
        colour += further(point, direction, split.mirrored, weight, depth);
    }
    return colour;
}

EmbreeShading::Split EmbreeShading::split_at(const Point& point) const {
    const Material& kind = *point.look->material;
    Split split;
    split.mirrored = point.material.reflect;
    const float eta = kind.thin_walled ? 1.0f : point.front_face ? 1.0f / kind.ior : kind.ior;
    const bool refracts = settings_.refractions && point.look->transmits;
    if (refracts) {
        split.transmitted = point.material.transmit;
        split.through = eta == 1.0f ? std::optional(point.incoming)
                                    : refracted_at(point.incoming, point.normal, eta);
    }
    const float cosine = std::clamp(-glm::dot(point.incoming, point.normal), 0.0f, 1.0f);
    if (kind.reflectance == Reflectance::dielectric) {
        const float f = kind.thin_walled ? fresnel_sheet(cosine, 1.0f / kind.ior)
                                         : fresnel_dielectric(cosine, eta);
        split.mirrored *= f;
        split.transmitted *= 1.0f - f;
    } else if (kind.reflectance == Reflectance::conductor && point.look->mirrors) {
        split.mirrored = fresnel_conductor(split.mirrored, cosine);
    }
    // Total reflection.
    if (refracts && !split.through && kind.reflectance == Reflectance::constant)
        split.mirrored += split.transmitted;
    return split;
}

glm::vec3 EmbreeShading::further(const Point& point, const glm::vec3& direction,
                                 const glm::vec3& share, float weight, int depth) {
    const float next = weight * largest(share);
    if (settings_.cutoff != 0.0f && !(next > settings_.cutoff)) return glm::vec3(0.0f);
    const Ray ray{point.position, direction, renderer_.gap(), kInfinity};
    return share * follow(ray, next, depth + 1);
}

glm::vec3 EmbreeShading::lit(const Point& point) {
    glm::vec3 colour =
        point.material.emissive + point.material.ambient * renderer_.source().ambient;
    for (const Lamp& lamp : renderer_.lamps())
        colour += lit_by(point, lamp);
    return colour;
}

glm::vec3 EmbreeShading::lit_by(const Point& point, const Lamp& lamp) {
    glm::vec3 direction = lamp.position;
    float distance = kInfinity;
    glm::vec3 colour = lamp.colour;
    if (!lamp.far_away) {
        direction -= point.position;
        distance = glm::length(direction);
        direction /= distance;
        colour /= lamp.fade.x + distance * (lamp.fade.y + distance * lamp.fade.z);
    }
    const float cosine = glm::dot(point.normal, direction);
    if (!(cosine > 0.0f) || !(glm::dot(point.geometric, direction) > 0.0f)) return glm::vec3(0.0f);
    if (settings_.shadows && blocked(point, direction, distance)) return glm::vec3(0.0f);
    return colour * phong_or_blinn(point.material, point.normal, direction, point.incoming, cosine);
}

bool EmbreeShading::blocked(const Point& point, const glm::vec3& direction, float distance) {
    RTCRay ray =
        embree_ray({point.position, direction, renderer_.gap(), distance - renderer_.gap()});
    rtcOccluded1(scene_, &context_, &ray);
    return ray.tfar < 0.0f;
}

}  // namespace raypick::bench

#endif
