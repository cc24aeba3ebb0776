#include "tracer/io/nff_file.h"

#include "tracer/error.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

constexpr std::size_t index_of(Sides sides) {
    return static_cast<std::size_t>(sides);
}

// Behind Kd and Ks, where a file leaves them out: the numbers of a matt, opaque surface.
constexpr double kDefaultShine = 1.0;
constexpr double kDefaultTransmittance = 0.0;
constexpr double kDefaultIor = 1.0;

Material fill_material(const std::array<double, 8>& f, std::string name) {
    const auto number = [&f](std::size_t i) { return static_cast<float>(f[i]); };
    const glm::vec3 colour(number(0), number(1), number(2));
    Material material;
    material.name = std::move(name);
    material.diffuse = number(3) * colour;
    // NFF knows no ambient light. The SPD's own converter assumes 0.1 of the colour, whatever Kd
    // is: that is the scene's ambient light.
    material.ambient = colour;
    material.specular = glm::vec3(number(4));
    material.reflect = glm::vec3(std::min(number(4), static_cast<float>(kMostBounce)));
    material.shininess = number(5);
    material.transmit = glm::vec3(std::min(number(6), static_cast<float>(kMostBounce)));
    // Opaque surfaces of the SPD have 0, which means nothing there.
    material.ior = f[7] >= kSmallestPositive ? number(7) : 1.0f;
    return material;
}

}  // namespace

void NffGroup::add(std::uint32_t count, MaterialId material) {
    if (count == 0) return;
    if (parts.empty() || parts.back().material != material) {
        parts.push_back({size(), 0, material});
    }
    parts.back().count += count;
}

std::uint32_t NffGroup::size() const {
    return parts.empty() ? 0 : parts.back().first + parts.back().count;
}

std::string without_nff_comments(std::string_view text) {
    std::string result(text);
    for (std::size_t at = result.find('#'); at != std::string::npos; at = result.find('#', at)) {
        const std::size_t end = std::min(result.find('\n', at), result.size());
        std::fill(result.begin() + static_cast<std::ptrdiff_t>(at),
                  result.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    }
    return result;
}

NffReader::NffReader(const std::string& file, std::string_view text, const LoadOptions& options,
                     std::vector<std::string>& warnings)
    : scanner_(file, text), options_(options), warnings_(warnings), text_size_(text.size()) {}

NffContent NffReader::read() {
    std::size_t entities = 0;
    for (std::string_view keyword = scanner_.word_anywhere(); !keyword.empty();
         keyword = scanner_.word_anywhere()) {
        if ((entities++ & 0xfffu) == 0) {
            load_step(options_, 0.9f * static_cast<float>(scanner_.offset()) /
                                    static_cast<float>(text_size_));
        }
        read_entity(keyword);
    }
    return std::move(content_);
}

void NffReader::read_entity(std::string_view keyword) {
    if (keyword == "s") {
        read_sphere();
    } else if (keyword == "c") {
        read_cone();
    } else if (keyword == "p") {
        read_polygon(false);
    } else if (keyword == "pp") {
        read_polygon(true);
    } else if (keyword == "f") {
        read_fill();
    } else if (keyword == "v") {
        read_view();
    } else if (keyword == "l") {
        read_light();
    } else if (keyword == "b") {
        content_.background = colour("the background's colour");
    } else if (keyword == "pl") {
        read_plane();
    } else if (keyword == "tess") {
        scanner_.next_line();  // how finely to tessellate: we don't
    } else if (parse_number(keyword)) {
        scanner_.fail(fmt::format("{} where a keyword should stand", in_quotes(keyword)));
    } else {
        scanner_.fail(fmt::format("unknown keyword {}: v, b, l, f, c, s, p or pp should stand here",
                                  in_quotes(keyword)));
    }
}

// "hither" and "resolution" are read and not used: the near plane follows from the scene, the size
// of the image from who asks for it.
void NffReader::read_view() {
    const std::size_t begin = scanner_.offset() - 1;
    std::optional<glm::dvec3> eye;
    std::optional<glm::dvec3> at;
    Camera camera;
    while (true) {
        const std::size_t before = scanner_.offset();
        const std::string_view word = scanner_.word_anywhere();
        if (word == "from") {
            eye = point("from");
        } else if (word == "at") {
            at = point("at");
        } else if (word == "up") {
            camera.up = point("up");
        } else if (word == "angle") {
            camera.fovy = number("angle");
        } else if (word == "hither") {
            number("hither");
        } else if (word == "resolution") {
            number("resolution");
            number("resolution");
        } else {
            scanner_.return_to(before);
            break;
        }
    }
    if (!eye) scanner_.fail_at(begin, "the view has no \"from\"");
    if (!at) scanner_.fail_at(begin, "the view has no \"at\"");
    camera.eye = *eye;
    camera.at = *at;
    try {
        check_camera(camera);
    } catch (const Error& error) {
        scanner_.fail_at(begin, fmt::format("the view: {}", error.what()));
    }
    content_.camera = camera;
}

void NffReader::read_light() {
    NffLight light;
    light.position = point("a light's position");
    if (const std::optional<double> red = optional_number()) {
        const double green = not_negative("a light's green");
        const double blue = not_negative("a light's blue");
        if (!(*red >= 0.0 && *red <= kLargestCoordinate))
            scanner_.fail(fmt::format("a light's red must be 0 or more, not {}", *red));
        light.colour = glm::vec3(glm::dvec3(*red, green, blue));
    }
    content_.lights.push_back(light);
}

void NffReader::read_fill() {
    std::array<double, 8> f{0, 0, 0, 0, 0, kDefaultShine, kDefaultTransmittance, kDefaultIor};
    for (std::size_t i = 0; i < 3; ++i)
        f[i] = not_negative("a colour", kMostSurfaceColour);
    const double brightest = std::max({f[0], f[1], f[2], 1.0});
    f[3] = not_negative("Kd", kMostSurfaceColour / brightest);
    f[4] = not_negative("Ks", kMostSurfaceColour);
    constexpr std::array<std::string_view, 3> kNames{"Shine", "T", "the index of refraction"};
    for (std::size_t i = 5; i < 8; ++i) {
        const std::optional<double> value = optional_number();
        if (!value) break;
        if (!(*value >= 0.0 && *value <= kLargestCoordinate))
            scanner_.fail(fmt::format("{} must be 0 or more, not {}", kNames[i - 5], *value));
        f[i] = *value;
    }
    if (f[6] > 0.0 && !(f[7] >= kSmallestPositive)) {
        scanner_.fail(fmt::format(
            "the index of refraction of what transmits light must be positive, not {}", f[7]));
    }
    if (!scanner_.at_line_end() && !optional_number()) skip_rest_of_line("f");
    material_ = material_of(f);
    transmits_ = f[6] > 0.0;
}

MaterialId NffReader::material_of(const std::array<double, 8>& numbers) {
    const auto next = static_cast<MaterialId>(content_.materials.size());
    const auto [known, is_new] = known_fills_.emplace(numbers, next);
    if (is_new) {
        content_.materials.push_back(fill_material(numbers, fmt::format("f{}", next + 1)));
    }
    return known->second;
}

// "Transmitting objects are considered to have two sides."
Sides NffReader::outer_sides() const {
    return transmits_ ? Sides::both : Sides::front_only;
}

void NffReader::read_sphere() {
    const glm::dvec3 centre = point("a sphere's centre");
    const double radius = number("a sphere's radius");
    // What is denormal as a float has no size either.
    if (!(std::abs(radius) >= kSmallestPositive && std::abs(radius) <= kLargestCoordinate))
        scanner_.fail(
            fmt::format("a sphere's radius must be a number other than 0, not {}", radius));
    if (!scanner_.at_line_end()) skip_rest_of_line("s");
    const Sides sides = radius < 0.0 ? Sides::back_only : outer_sides();
    NffSpheres& group = content_.spheres[index_of(sides)];
    group.spheres.emplace_back(centre, std::abs(radius));
    group.add(1, material_);
}

void NffReader::read_cone() {
    const glm::dvec3 base = point("a cone's base");
    const double base_radius = number("a cone's base radius");
    const glm::dvec3 apex = point("a cone's apex");
    const double apex_radius = number("a cone's apex radius");
    const double largest = std::max(std::abs(base_radius), std::abs(apex_radius));
    if (!(largest <= kLargestCoordinate) || std::isnan(base_radius))
        scanner_.fail("a cone's radii must be numbers");
    if (!(largest >= kSmallestPositive)) scanner_.fail("both radii of a cone are 0");
    if (base_radius * apex_radius < 0.0) {
        scanner_.fail(
            fmt::format("a cone's radii {} and {} have different signs", base_radius, apex_radius));
    }
    if (base == apex) scanner_.fail("a cone's base and apex are the same point");
    const bool inside = base_radius < 0.0 || apex_radius < 0.0;
    NffCones& group = content_.cones[index_of(inside ? Sides::back_only : outer_sides())];
    group.ends.emplace_back(base, std::abs(base_radius));
    group.ends.emplace_back(apex, std::abs(apex_radius));
    group.add(1, material_);
}

std::size_t NffReader::corner_count(std::size_t numbers_a_corner) {
    const double count = number("the number of corners");
    if (!(count >= 3.0)) {
        scanner_.fail(fmt::format("a polygon needs at least three corners, not {}", count));
    }
    if (count != std::floor(count))
        scanner_.fail(fmt::format("the number of corners must be a whole number, not {}", count));
    // A number takes at least two bytes, with the blank before it.
    const std::size_t most = scanner_.bytes_left() / (2 * numbers_a_corner);
    if (count > static_cast<double>(most)) {
        scanner_.fail(fmt::format("promises {} corners, but the file ends before that", count));
    }
    return static_cast<std::size_t>(count);
}

// A patch is drawn from both sides, against the letter of the format: patches stand for open curved
// sheets such as the SPD's teapot, whose published ray counts are those of a double-sided one.
void NffReader::read_polygon(bool is_patch) {
    const std::size_t count = corner_count(is_patch ? 6 : 3);
    corners_.clear();
    normals_.clear();
    for (std::size_t i = 0; i < count; ++i) {
        corners_.push_back(point("a corner"));
        if (is_patch) normals_.push_back(point("a normal"));
    }
    NffTriangles& group = is_patch ? content_.patches[index_of(Sides::both)]
                                   : content_.polygons[index_of(outer_sides())];
    const auto first = static_cast<std::uint32_t>(group.positions.size());
    group.positions.insert(group.positions.end(), corners_.begin(), corners_.end());
    group.normals.insert(group.normals.end(), normals_.begin(), normals_.end());
    const std::span<const glm::uvec3> triangles = splitter_.split(corners_);
    for (const glm::uvec3& triangle : triangles)
        group.triangles.push_back(triangle + first);
    group.add(static_cast<std::uint32_t>(triangles.size()), material_);
}

void NffReader::read_plane() {
    const glm::dvec3 a = point("a point of a plane");
    const glm::dvec3 b = point("a point of a plane");
    const glm::dvec3 c = point("a point of a plane");
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    if (!(length > 0.0)) scanner_.fail("the three points of a plane lie on one line");
    const glm::dvec3 unit = normal / length;
    content_.planes.push_back({{unit, -glm::dot(unit, a)}, material_, outer_sides()});
}

void NffReader::skip_rest_of_line(std::string_view of) {
    const std::string rest = in_quotes(scanner_.rest());
    warnings_.push_back(scanner_.place(fmt::format("{} behind {} is left out", rest, of)));
}

double NffReader::number(std::string_view what) {
    while (scanner_.at_line_end() && !scanner_.at_end())
        scanner_.next_line();
    return scanner_.number(what);
}

std::optional<double> NffReader::optional_number() {
    const std::size_t before = scanner_.offset();
    while (scanner_.at_line_end() && !scanner_.at_end())
        scanner_.next_line();
    const std::optional<double> value = scanner_.try_number();
    if (!value) scanner_.return_to(before);
    return value;
}

double NffReader::not_negative(std::string_view what, double most) {
    const double value = number(what);
    if (!(value >= 0.0)) scanner_.fail(fmt::format("{} must be 0 or more, not {}", what, value));
    if (!(value <= most)) {
        scanner_.fail(fmt::format("{} must be no more than {}, not {}", what, most, value));
    }
    return value;
}

glm::dvec3 NffReader::point(std::string_view what) {
    const double x = number(what);
    const double y = number(what);
    const glm::dvec3 p(x, y, number(what));
    if (!is_coordinate(p)) scanner_.fail(fmt::format("{}: {}", what, coordinate_complaint(p)));
    return p;
}

glm::vec3 NffReader::colour(std::string_view what) {
    const double red = not_negative(what);
    const double green = not_negative(what);
    const glm::vec3 rgb(glm::dvec3(red, green, not_negative(what)));
    return rgb;
}

}  // namespace raypick
