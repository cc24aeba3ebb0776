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
                      body_of(*found.object, hit), surface.material, surface.front_face));
    boundary.medium = crossing.from;
    boundary.eta = index_of(scene, crossing.from) / index_of(scene, crossing.to);
    boundary.is_there = is_there(world, crossing, surface.material);
    return boundary;
}

ShadingPoint shading_point(const ShadeScene& scene, const FoundHit& found,
                           const glm::vec3& incoming, float width, SurfaceMaterial* with_maps) {
    const SurfacePoint& surface = found.surface;
    const Material& kind = *found.material->material;
    const float side = surface.front_face ? 1.0f : -1.0f;
    const glm::vec3 geometric = side * surface.geometric_normal;
    const glm::vec3 outside = offset_origin(surface, geometric);
    if (!found.material->has_maps) {
        return {surface,  kind,   found.material->plain, side * surface.shading_normal, geometric,
                incoming, outside};
    }
    const Scene& world = *scene.scene;
    *with_maps = textured(world, kind, surface, incoming, width);
    return {surface,    kind,
            *with_maps, side * mapped_normal(world, kind, surface, incoming, width),
            geometric,  incoming,
            outside};
}

}  // namespace raypick
