#include "tracer/shade/interior.h"

#include <algorithm>

namespace raypick {

Body body_of(const Object& object, const Hit& hit) {
    const bool is_set = std::holds_alternative<SphereSetInstance>(object.shape) ||
                        std::holds_alternative<ConeSetInstance>(object.shape);
    return {hit.object, is_set ? hit.primitive : 0u};
}

bool fills(const Material& material) {
    return material.transmits() && !material.thin_walled;
}

MaterialId Interior::medium(const Scene& scene) const {
    MaterialId highest = kNoMaterial;
    for (std::size_t i = 0; i < count_; ++i) {
        const MaterialId id = entries_[i].material;
        if (highest == kNoMaterial ||
            material(scene, id).priority >= material(scene, highest).priority) {
            highest = id;
        }
    }
    return highest;
}

bool Interior::holds(const Body& body) const {
    return std::any_of(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [&body](const Entry& entry) { return entry.body == body; });
}

void Interior::enter(const Body& body, MaterialId material) {
    if (count_ == kMost) {
        std::move(entries_.begin() + 1, entries_.end(), entries_.begin());
        --count_;
    }
    entries_[count_++] = {body, material};
}

void Interior::leave(const Body& body) {
    Entry* const end = entries_.data() + count_;
    Entry* const found = std::find_if(entries_.data(), end,
                                      [&body](const Entry& entry) { return entry.body == body; });
    if (found == end) return;
    std::move(found + 1, end, found);
    --count_;
}

void Interior::begin_inside(const Body& body, MaterialId material) {
    if (count_ == kMost) return;
    Entry* const end = entries_.data() + count_;
    std::move_backward(entries_.data(), end, end + 1);
    entries_[0] = {body, material};
    ++count_;
}

void cross_surface(const Scene& scene, const Interior& interior, const Body& body,
                   MaterialId material, bool front_face, Crossing& crossing) {
    crossing.before = interior;
    const bool inside = interior.holds(body);
    if (front_face && inside) crossing.before.leave(body);
    if (!front_face && !inside) crossing.before.begin_inside(body, material);
    crossing.after = crossing.before;
    if (front_face) {
        crossing.after.enter(body, material);
    } else {
        crossing.after.leave(body);
    }
    crossing.from = crossing.before.medium(scene);
    crossing.to = crossing.after.medium(scene);
}

bool is_there(const Scene& scene, const Crossing& crossing, MaterialId surface) {
    if (crossing.from != crossing.to) return true;
    const Material& kind = material(scene, surface);
    return crossing.from == surface && kind.ior == 1.0f && kind.absorption == glm::vec3(0.0f);
}

}  // namespace raypick
