#include "tracer/geometry/parts.h"

#include "tracer/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace raypick {

void check_parts(std::string_view kind, std::string_view name, std::string_view primitive,
                 std::span<const Part> parts, std::size_t count) {
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].first != next) {
            throw Error(fmt::format("{} \"{}\": part {} begins at {} {}, but should at {}", kind,
                                    name, i, primitive, parts[i].first, next));
        }
        next += parts[i].count;
    }
    if (!parts.empty() && next != count) {
        throw Error(fmt::format("{} \"{}\": the parts hold {} {}s, the {} has {}", kind, name, next,
                                primitive, kind, count));
    }
}

const Part* part_of(std::span<const Part> parts, std::uint32_t primitive) {
    const auto after =
        std::upper_bound(parts.begin(), parts.end(), primitive,
                         [](std::uint32_t p, const Part& part) { return p < part.first; });
    if (after == parts.begin()) return nullptr;
    const Part& part = *(after - 1);
    return primitive - part.first < part.count ? &part : nullptr;
}

const Part* part_of(const Mesh& mesh, std::uint32_t triangle) {
    return part_of(std::span(mesh.parts), triangle);
}

}  // namespace raypick
