#include "tracer/shade/arrivals.h"

#include "tracer/accel/local_point.h"

#include <bit>

namespace raypick {

void Arrivals::begin(const ShadeScene& scene, std::span<const Ray> rays,
                     std::span<const Hit> hits) {
    scene_ = &scene;
    rays_ = rays;
    hits_ = hits;
    parts_.clear();
    derivatives_.object = nullptr;
    for (Gathered& gathered : gathered_) {
        gathered.block.rows.clear();
        gathered.handed_on = false;
    }
}

const Arrivals::Block* Arrivals::add(std::size_t i) {
    const Hit& hit = hits_[i];
    if (parts_.empty() || !parts_.back().holds(hit)) parts_.push_back(part_at(*scene_, hit));
    const KnownPart& part = parts_.back();
    Gathered& gathered = gathered_[static_cast<std::size_t>(part.kind)];
    Block& block = gathered.block;
    if (gathered.handed_on) {
        block.rows.clear();
        gathered.handed_on = false;
    }
    const Scene& scene = *scene_->scene;
    const std::size_t lane = block.rows.add(rays_[i], hit);
    block.hit[lane] = static_cast<std::uint32_t>(i);
    block.part[lane] = static_cast<std::uint32_t>(parts_.size() - 1);
    switch (part.kind) {
        case SurfaceKind::triangle:
            triangles_.add(lane, *part.mesh, hit);
            break;
        case SurfaceKind::sphere:
            spheres_.add(lane, scene, part.object->shape, hit.primitive);
            break;
        case SurfaceKind::rectangle:
            rectangles_.add(lane, scene, part.object->shape, hit.primitive);
            break;
        case SurfaceKind::other:
            set_surface_point(scene, part.at(), rays_[i], hit, others_[lane]);
            block.rows.put(lane, others_[lane]);
            break;
    }
    return block.rows.full() ? hand_on(part.kind) : nullptr;
}

const Arrivals::Block* Arrivals::rest() {
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
        const Gathered& gathered = gathered_[kind];
        if (!gathered.handed_on && gathered.block.rows.count != 0) {
            return hand_on(static_cast<SurfaceKind>(kind));
        }
    }
    return nullptr;
}

const Arrivals::Block* Arrivals::hand_on(SurfaceKind kind) {
    Gathered& gathered = gathered_[static_cast<std::size_t>(kind)];
    gathered.handed_on = true;
    Block& block = gathered.block;
    if (kind == SurfaceKind::triangle) find_triangles(block);
    if (kind == SurfaceKind::sphere) spheres_.find_spheres(block.rows);
    if (kind == SurfaceKind::rectangle) rectangles_.find_rectangles(block.rows);
    return &block;
}

void Arrivals::find_triangles(Block& block) {
    for (std::uint32_t left = triangles_.find(block.rows); left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        const std::uint32_t i = block.hit[lane];
        SurfacePoint surface;
        set_surface_point(*scene_->scene, part(block, lane).at(), rays_[i], hits_[i], surface);
        block.rows.put(lane, surface);
    }
}

void Arrivals::set_found(const Block& block, std::size_t lane, FoundHit& found) {
    const KnownPart& on = part(block, lane);
    found.object = on.object;
    found.material = on.prepared;
    if (on.kind == SurfaceKind::other) {
        found.surface = others_[lane];
        return;
    }
    const Hit& hit = hits_[block.hit[lane]];
    block.rows.take(lane, found.surface);
    set_untextured(hit, on.material, found.surface);
    if (on.kind == SurfaceKind::triangle && on.prepared->has_maps) {
        set_texture_uv(on, hit, found.surface);
    }
}

void Arrivals::set_texture_uv(const KnownPart& part, const Hit& hit, SurfacePoint& surface) {
    surface.texture_uv = texture_uv(*scene_->scene, *part.object, hit);
    Derivatives& last = derivatives_;
    if (last.object != part.object || last.primitive != hit.primitive) {
        const MeshDerivatives by_uv =
            mesh_derivatives(*part.mesh, part.mesh->triangles[hit.primitive]);
        last = {part.object, hit.primitive, glm::vec3(by_uv.dpdu), glm::vec3(by_uv.dpdv)};
    }
    surface.dpdu = last.dpdu;
    surface.dpdv = last.dpdv;
}

}  // namespace raypick
