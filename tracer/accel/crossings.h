// What lets light through, and what rays cross of it on their way.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// Which of a scene's primitives let light through: those whose material does.
struct Clearness {
    enum class Of : std::uint8_t { nothing, some, all };  // of an object's primitives

    std::vector<Of> objects;              // by index
    std::vector<std::uint8_t> materials;  // by id, 0 or 1; the last one is that of no id

    [[nodiscard]] bool of_material(MaterialId id) const {
        return (id < materials.size() ? materials[id] : materials.back()) != 0;
    }
};

// `materials` as in Clearness; never empty.
Clearness clearness(const Scene& scene, std::vector<std::uint8_t> materials);

// Whether light goes through the primitive of the object at this index.
inline bool is_clear(const Scene& scene, const Clearness& clear, std::size_t object,
                     std::uint32_t primitive) {
    const Clearness::Of some = clear.objects[object];
    if (some != Clearness::Of::some) return some == Clearness::Of::all;
    return clear.of_material(material_id(scene, scene.objects[object], primitive));
}

// Of many rays. Keeps its memory from call to call.
struct Crossings {
    std::vector<std::uint8_t> blocked;  // by ray, 0 or 1: by something that is not clear
    std::vector<Hit> hits;              // of all rays
    std::vector<std::uint32_t> first;   // by ray where its hits begin, and where the last one's end

    // All that the ray hits, in the order of sort_along_ray; nothing if it is blocked.
    [[nodiscard]] std::span<const Hit> of(std::size_t ray) const {
        return std::span(hits).subspan(first[ray], first[ray + 1] - first[ray]);
    }
};

// By t, then by (object, primitive). Hits of one primitive at one t stay as they are.
void sort_along_ray(std::span<Hit> hits);

}  // namespace raypick
