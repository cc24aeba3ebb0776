#include "tracer/shade/generation.h"

#include <array>
#include <numeric>

namespace raypick {

void Generation::clear() {
    paths.clear();
    rays.clear();
    directions.clear();
    interiors.clear();
}

void Generation::add(std::size_t count) {
    paths.resize(paths.size() + count);
    rays.resize(paths.size());
    directions.resize(paths.size());
}

void Generation::put_inside(RayPath& path, const Interior& interior) {
    if (path.interior != kNoInterior) {
        interiors[path.interior] = interior;
    } else if (!interior.empty()) {
        path.interior = static_cast<std::uint32_t>(interiors.size());
        interiors.push_back(interior);
    }
}

void Generation::keep_order() {
    order.resize(paths.size());
    std::iota(order.begin(), order.end(), 0u);
}

void Generation::order_by_direction() {
    order.resize(paths.size());
    std::array<std::uint32_t, kDirections + 1> place{};
    for (const std::uint8_t direction : directions)
        ++place[direction + std::size_t{1}];
    std::partial_sum(place.begin(), place.end(), place.begin());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[place[directions[i]]++] = i;
}

}  // namespace raypick
