#include "tracer/accel/crossings.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

namespace raypick {

namespace {

bool comes_before(const Hit& a, const Hit& b) {
    return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
}

Clearness::Of clearness_of(const Scene& scene, const Clearness& clear, const Object& object) {
    using Of = Clearness::Of;
    const auto clear_part = [&](const Part& part) { return clear.of_material(part.material); };
    const std::span<const Part> parts = parts_of(scene, object.shape);  // they cover all there is
    if (object.material != kNoMaterial || parts.empty()) {
        return clear.of_material(object.material) ? Of::all : Of::nothing;
    }
    if (std::none_of(parts.begin(), parts.end(), clear_part)) return Of::nothing;
    return std::all_of(parts.begin(), parts.end(), clear_part) ? Of::all : Of::some;
}

}  // namespace

Clearness clearness(const Scene& scene, std::vector<std::uint8_t> materials) {
    Clearness clear;
    clear.materials = std::move(materials);
    clear.objects.reserve(scene.objects.size());
    for (const Object& object : scene.objects)
        clear.objects.push_back(clearness_of(scene, clear, object));
    return clear;
}

void sort_along_ray(std::span<Hit> hits) {
    constexpr std::size_t kFew = 24;
    if (hits.size() > kFew) {
        std::stable_sort(hits.begin(), hits.end(), comes_before);
        return;
    }
    for (std::size_t i = 1; i < hits.size(); ++i) {
        const Hit hit = hits[i];
        std::size_t place = i;
        for (; place > 0 && comes_before(hit, hits[place - 1]); --place)
            hits[place] = hits[place - 1];
        hits[place] = hit;
    }
}

}  // namespace raypick
