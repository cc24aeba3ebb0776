#include "tracer/io/scene_arrays.h"

#include "tracer/io/embedded_array.h"
#include "tracer/io/scene_numbers.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

// Of what there is one a position.
void check_count(const JsonValue& value, std::size_t count, std::size_t position_count) {
    if (count == position_count) return;
    value.fail(fmt::format("holds {}, but there are {} positions", count, position_count));
}

std::vector<glm::uvec3> decode_triangles(const JsonValue& value, std::size_t last) {
    std::vector<glm::uvec3> triangles = decode_array<glm::uvec3, std::uint32_t>(value);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::uvec3& t = triangles[i];
        if (std::max({t.x, t.y, t.z}) <= last) continue;
        value.fail(fmt::format("triangle {} has a corner beyond position {}", i, last));
    }
    return triangles;
}

// Unit normals, one a position.
std::vector<glm::vec3> read_normals(const JsonValue& value, std::size_t position_count) {
    std::vector<glm::vec3> normals;
    if (value.is_string()) {
        normals = decode_array<glm::vec3, float>(value);
        check_count(value, normals.size(), position_count);
        return normals;
    }
    for (const JsonValue& element :
         value.elements(position_count,
                        fmt::format("an array of {} normals, one a position", position_count))) {
        normals.emplace_back(glm::normalize(read_direction(element)));
    }
    return normals;
}

std::vector<glm::uvec3> read_triangles(const JsonValue& value, std::size_t position_count) {
    if (value.equals("")) return {};
    if (position_count == 0) value.fail("there are no positions to connect");
    const std::size_t last = position_count - 1;
    const std::string words = fmt::format("the number of a position, 0 to {}", last);
    const NumberRule rule{0.0, static_cast<double>(last), true, words};
    if (value.is_string()) return decode_triangles(value, last);
    std::vector<glm::uvec3> triangles;
    for (const JsonValue& element : value.elements()) {
        glm::uvec3 triangle{0};
        const std::vector<JsonValue> corners = element.elements(3, "three numbers of positions");
        for (std::size_t i = 0; i < 3; ++i) {
            triangle[static_cast<int>(i)] =
                static_cast<std::uint32_t>(corners[i].whole_number(rule));
        }
        triangles.push_back(triangle);
    }
    return triangles;
}

std::vector<glm::vec2> read_uvs(const JsonValue& value, std::size_t position_count) {
    std::vector<glm::vec2> uvs;
    if (value.is_string()) {
        uvs = decode_array<glm::vec2, float>(value);
        check_count(value, uvs.size(), position_count);
        return uvs;
    }
    for (const JsonValue& element :
         value.elements(position_count,
                        fmt::format("an array of {} [u, v], one a position", position_count))) {
        const std::vector<JsonValue> uv = element.elements(2, "two numbers [u, v]");
        uvs.emplace_back(read_float(uv[0], kCoordinate), read_float(uv[1], kCoordinate));
    }
    return uvs;
}

void read_positions(const JsonValue& value, InlineMesh& mesh) {
    if (value.is_string()) {
        mesh.data.positions = decode_array<glm::vec3, float>(value);
        return;
    }
    std::vector<glm::dvec3> points;
    PointBounds bounds;
    for (const JsonValue& element : value.elements()) {
        points.push_back(read_point(element));
        bounds.extend(points.back());
    }
    mesh.origin = storage_origin(bounds);
    mesh.data.positions.reserve(points.size());
    for (const glm::dvec3& p : points)
        mesh.data.positions.emplace_back(p - mesh.origin);
}

Part read_part(const JsonValue& value, std::uint32_t first, std::size_t primitive_count,
               const MaterialReader& read_material) {
    value.only_keys("a part", Keys{"first", "count", "material"});
    const JsonValue first_value = value.need("first");
    const std::string first_words =
        fmt::format("{}, where the part before ends: parts cover all primitives", first);
    const auto number = static_cast<double>(first);
    (void)first_value.whole_number({number, number, true, first_words});
    const std::size_t left = primitive_count - first;
    const std::string count_words = fmt::format("a whole number from 1 to {}", left);
    const NumberRule rule{1.0, static_cast<double>(left), true, count_words};
    Part part;
    part.first = first;
    part.count = static_cast<std::uint32_t>(value.need("count").whole_number(rule));
    if_present(value, "material", [&](const JsonValue& m) { part.material = read_material(m); });
    return part;
}

std::vector<Part> read_parts(const JsonValue& object, std::size_t primitive_count,
                             const MaterialReader& read_material) {
    std::vector<Part> parts;
    const std::optional<JsonValue> value = object.find("parts");
    if (!value) return parts;
    std::uint32_t first = 0;
    for (const JsonValue& element : value->elements()) {
        parts.push_back(read_part(element, first, primitive_count, read_material));
        first += parts.back().count;
    }
    if (first != primitive_count && !parts.empty()) {
        value->fail(fmt::format("cover {} of {} primitives", first, primitive_count));
    }
    return parts;
}

// Rows of numbers, each a sequence of N spheres [x, y, z, r]. The rule is for r.
template <std::size_t N>
InlineSet read_rows(const JsonValue& value, std::string_view row_words, const NumberRule& rule) {
    InlineSet set;
    if (value.is_string()) {
        set.elements = decode_array<glm::vec4, float>(value);
        if (set.elements.size() % N != 0) value.fail("ends within a cone");
        return set;
    }
    std::vector<glm::dvec4> spheres;
    PointBounds bounds;
    for (const JsonValue& row : value.elements()) {
        const std::vector<JsonValue> numbers = row.elements(4 * N, row_words);
        for (std::size_t i = 0; i < 4 * N; i += 4) {
            spheres.emplace_back(numbers[i].number(kCoordinate), numbers[i + 1].number(kCoordinate),
                                 numbers[i + 2].number(kCoordinate), numbers[i + 3].number(rule));
            bounds.extend(glm::dvec3(spheres.back()) - spheres.back().w);
            bounds.extend(glm::dvec3(spheres.back()) + spheres.back().w);
        }
    }
    set.origin = storage_origin(bounds);
    set.elements.reserve(spheres.size());
    for (const glm::dvec4& sphere : spheres)
        set.elements.emplace_back(sphere - glm::dvec4(set.origin, 0.0));
    return set;
}

void check_spheres(const JsonValue& value, const std::vector<glm::vec4>& spheres) {
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const glm::vec4& s = spheres[i];
        if (s.w > 0.0f && std::isfinite(s.x + s.y + s.z + s.w)) continue;
        value.fail(
            fmt::format("sphere {} is ({}, {}, {}) with radius {}: its numbers must be "
                        "finite, its radius positive",
                        i, s.x, s.y, s.z, s.w));
    }
}

void check_cones(const JsonValue& value, const std::vector<glm::vec4>& ends) {
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
        const glm::vec4& base = ends[i];
        const glm::vec4& apex = ends[i + 1];
        const glm::vec4 sum = base + apex;
        const bool finite = std::isfinite(sum.x + sum.y + sum.z + sum.w);
        const bool has_radius = base.w >= 0.0f && apex.w >= 0.0f && base.w + apex.w > 0.0f;
        if (finite && has_radius && glm::vec3(base) != glm::vec3(apex)) continue;
        value.fail(
            fmt::format("cone {} has no size: its ends must be two points, its radii not "
                        "negative and not both 0",
                        i / 2));
    }
}

}  // namespace

InlineMesh read_inline_mesh(const JsonValue& object, const MaterialReader& read_material) {
    InlineMesh mesh;
    read_positions(object.need("positions"), mesh);
    const std::size_t count = mesh.data.positions.size();
    mesh.data.triangles = read_triangles(object.need("triangles"), count);
    if_present(object, "normals",
               [&](const JsonValue& normals) { mesh.data.normals = read_normals(normals, count); });
    if_present(object, "uvs", [&](const JsonValue& uvs) { mesh.data.uvs = read_uvs(uvs, count); });
    mesh.parts = read_parts(object, mesh.data.triangles.size(), read_material);
    return mesh;
}

InlineSet read_inline_spheres(const JsonValue& object, const MaterialReader& read_material) {
    const JsonValue spheres = object.need("spheres");
    InlineSet set = read_rows<1>(spheres, "a sphere [x, y, z, radius]", kPositive);
    check_spheres(spheres, set.elements);
    set.parts = read_parts(object, set.elements.size(), read_material);
    return set;
}

InlineSet read_inline_cones(const JsonValue& object, const MaterialReader& read_material) {
    const JsonValue cones = object.need("cones");
    InlineSet set = read_rows<2>(cones, "a cone: base and apex, [x, y, z, radius, x, y, z, radius]",
                                 kNotNegative);
    check_cones(cones, set.elements);
    set.parts = read_parts(object, set.elements.size() / 2, read_material);
    return set;
}

}  // namespace raypick
