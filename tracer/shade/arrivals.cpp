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

const Arrivals::Block* Arrivals::add(std::size_t& i) {
    while (i < hits_.size() && hits_[i].valid()) {
        if (parts_.empty() || !parts_.back().holds(hits_[i])) {
            parts_.push_back(part_at(*scene_, hits_[i]));
        }
        const SurfaceKind kind = parts_.back().kind;
        Gathered& gathered = gathered_[static_cast<std::size_t>(kind)];
        if (gathered.handed_on) {
            gathered.block.rows.clear();
            gathered.handed_on = false;
        }
        i = add_run(gathered.block, i);
        if (gathered.block.rows.full()) return hand_on(kind);
    }
    return nullptr;
}

// Of hits from i on, as many as the block has room for and are on the last part. Returns the number
// of the next.
std::size_t Arrivals::add_run(Block& block, std::size_t i) {
    const Scene& scene = *scene_->scene;
    const KnownPart part = parts_.back();
    const auto number = static_cast<std::uint32_t>(parts_.size() - 1);
    const auto run = [&](const auto& add_to_lane) {
        for (; i < hits_.size() && part.holds(hits_[i]) && !block.rows.full(); ++i) {
            const std::size_t lane = block.rows.add(rays_[i], hits_[i]);
            block.hit[lane] = static_cast<std::uint32_t>(i);
            block.part[lane] = number;
            add_to_lane(lane);
        }
    };
    switch (part.kind) {
        case SurfaceKind::triangle:
            run([&](std::size_t lane) { triangles_.add(lane, *part.mesh, hits_[i]); });
            break;
        case SurfaceKind::sphere:
            run([&](std::size_t lane) {
                spheres_.add(lane, scene, part.object->shape, hits_[i].primitive);
            });
            break;
        case SurfaceKind::rectangle:
            run([&](std::size_t lane) {
                rectangles_.add(lane, scene, part.object->shape, hits_[i].primitive);
            });
            break;
        case SurfaceKind::other:
            run([&](std::size_t lane) {
                set_surface_point(scene, part.at(), rays_[i], hits_[i], others_[lane]);
                block.rows.put(lane, others_[lane]);
            });
            break;
    }
    return i;
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
