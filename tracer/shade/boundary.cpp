#include "tracer/shade/boundary.h"

namespace raypick {

namespace {

float index_of(const ShadeScene& scene, MaterialId medium) {
    return medium == kNoMaterial ? 1.0f : prepared_material(scene, medium).material->ior;
}

}  // namespace

Boundary boundary_of_body(const ShadeScene& scene, const FoundHit& found, const Hit& hit,
                          const Interior* interior) {
    Boundary boundary;
    const Scene& world = *scene.scene;
    const SurfacePoint& surface = found.surface;
    const Crossing& crossing = boundary.crossing.emplace(
        cross_surface(world, interior != nullptr ? *interior : Interior{},
                      body_of(found.object, hit), surface.material, surface.front_face));
    boundary.medium = crossing.from;
    boundary.eta = index_of(scene, crossing.from) / index_of(scene, crossing.to);
    boundary.is_there = is_there(world, crossing, surface.material);
    return boundary;
}

ShadingPoint shading_point(const ShadeScene& scene, const FoundHit& found,
                           const glm::vec3& incoming, float width) {
    const SurfacePoint& surface = found.surface;
    const float side = surface.front_face ? 1.0f : -1.0f;
    ShadingPoint point;
    point.surface = surface;
    point.kind = found.material.material;
    point.geometric = side * surface.geometric_normal;
    point.incoming = incoming;
    if (found.material.has_maps) {
        const Scene& world = *scene.scene;
        point.material = textured(world, *point.kind, surface, incoming, width);
        point.normal = side * mapped_normal(world, *point.kind, surface, incoming, width);
    } else {
        point.material = found.material.plain;
        point.normal = side * surface.shading_normal;
    }
    return point;
}

}  // namespace raypick
