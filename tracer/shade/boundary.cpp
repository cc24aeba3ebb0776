#include "tracer/shade/boundary.h"

namespace raypick {

namespace {

float index_of(const ShadeScene& scene, MaterialId medium) {
    return medium == kNoMaterial ? 1.0f : prepared_material(scene, medium).material->ior;
}

}  // namespace

Boundary boundary_of_body(const ShadeScene& scene, const FoundHit& found, const Hit& hit,
                          const Interior* interior, Crossing& room) {
    const Scene& world = *scene.scene;
    const SurfacePoint& surface = found.surface;
    static const Interior nowhere;
    cross_surface(world, interior != nullptr ? *interior : nowhere, body_of(*found.object, hit),
                  surface.material, surface.front_face, room);
    const Crossing& crossing = room;
    Boundary boundary;
    boundary.crossing = &room;
    boundary.medium = crossing.from;
    boundary.eta = index_of(scene, crossing.from) / index_of(scene, crossing.to);
    boundary.is_there = is_there(world, crossing, surface.material);
    return boundary;
}

}  // namespace raypick
