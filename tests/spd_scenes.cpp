#include "tests/spd_scenes.h"

#include "tracer/geometry/transform.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace raypick {

namespace {

constexpr double kPi = std::numbers::pi;

std::string text(const glm::dvec3& v) {
    return fmt::format("{} {} {}", v.x, v.y, v.z);
}

struct Look {
    glm::dvec3 from;
    glm::dvec3 at;
    glm::dvec3 up;
    double angle;
};

std::string head(const Look& look, std::span<const glm::dvec3> lights) {
    std::string nff = fmt::format(
        "b 0.078 0.361 0.753\nv\nfrom {}\nat {}\nup {}\nangle {}\nhither 1\nresolution 512 512\n",
        text(look.from), text(look.at), text(look.up), look.angle);
    for (const glm::dvec3& light : lights)
        nff += "l " + text(light) + '\n';
    return nff;
}

// Kd, Ks, the exponent of the highlight, what is transmitted, the index of refraction.
struct Fill {
    double diffuse;
    double specular = 0.0;
    double shine = 0.0;
    double transmit = 0.0;
    double ior = 0.0;
};

std::string fill(const glm::dvec3& colour, const Fill& f) {
    return fmt::format("f {} {} {} {} {} {}\n", text(colour), f.diffuse, f.specular, f.shine,
                       f.transmit, f.ior);
}

// The exponent whose highlight has half its height at this angle.
double shine_of(double half_angle_degrees) {
    return std::log(0.5) / std::log(std::cos(glm::radians(half_angle_degrees)));
}

std::string polygon(std::span<const glm::dvec3> corners) {
    std::string nff = fmt::format("p {}\n", corners.size());
    for (const glm::dvec3& corner : corners)
        nff += text(corner) + '\n';
    return nff;
}

// A square on the ground, seen from above.
std::string ground(double half_side) {
    const std::vector<glm::dvec3> corners{{half_side, half_side, 0.0},
                                          {-half_side, half_side, 0.0},
                                          {-half_side, -half_side, 0.0},
                                          {half_side, -half_side, 0.0}};
    return polygon(corners);
}

std::string sphere(const glm::dvec3& centre, double radius) {
    return fmt::format("s {} {}\n", text(centre), radius);
}

std::string cone(const glm::dvec3& base, double base_radius, const glm::dvec3& apex,
                 double apex_radius) {
    return fmt::format("c\n{} {}\n{} {}\n", text(base), base_radius, text(apex), apex_radius);
}

double fraction(double x) {
    return x - std::floor(x);
}

// --- Gears --------------------------------------------------------------------------------------

constexpr int kTeeth = 36;
constexpr int kGears = 4;           // along each axis
constexpr double kToothPart = 0.1;  // of the radius

// The face of a gear, counter-clockwise: each tooth has two outer and two inner corners.
std::vector<glm::dvec3> gear_outline(const glm::dvec3& centre, double radius, double turned) {
    const double outer = 0.995 * radius;  // a little play between the teeth
    const double inner = (1.0 - kToothPart) * radius;
    std::vector<glm::dvec3> corners;
    for (int tooth = 0; tooth < kTeeth; ++tooth) {
        const auto add = [&](double r, double share) {
            const double angle = turned + 2.0 * kPi * (tooth + share) / kTeeth;
            corners.push_back(centre + r * glm::dvec3(std::cos(angle), std::sin(angle), 0.0));
        };
        add(outer, -0.19);
        add(outer, 0.19);
        add(inner, 0.3);
        add(inner, 0.7);
    }
    return corners;
}

std::string gear(const glm::dvec3& centre, double radius, double turned, double thickness) {
    std::vector<glm::dvec3> top = gear_outline(centre, radius, turned);
    std::string nff = polygon(top);
    const glm::dvec3 down(0.0, 0.0, -thickness);
    for (std::size_t i = 0; i < top.size(); ++i) {
        const glm::dvec3& next = top[(i + 1) % top.size()];
        const std::vector<glm::dvec3> side{top[i], top[i] + down, next + down, next};
        nff += polygon(side);
    }
    for (glm::dvec3& corner : top)
        corner += down;
    // Seen from below, and begun at a corner where the outline is convex, as the original.
    std::reverse(top.begin(), top.end());
    std::rotate(top.begin(), top.begin() + 2, top.end());
    return nff + polygon(top);
}

std::string gear_fill(int ix, int iy, int iz) {
    glm::dvec3 colour(fraction((ix * 3 + iy * 2 + iz + 1) * 5.0 / 7.0),
                      fraction((iy * 3 + iz * 2 + ix + 1) * 3.0 / 7.0),
                      fraction((iz * 3 + ix * 2 + iy + 1) * 2.0 / 7.0));
    colour += 0.01;
    colour /= std::max({colour.x, colour.y, colour.z});
    if ((ix * 4 + iy * 2 + iz) % 5 == 0) {
        return fill(colour, {.diffuse = 0.2, .transmit = 0.8, .ior = 1.1});
    }
    return fill(colour, {.diffuse = 1.0});
}

}  // namespace

std::string spd_gears() {
    const std::vector<glm::dvec3> lights{{2.0, 4.0, 4.0},
                                         {-2.0, 4.0, 3.0},
                                         {2.0, -2.5, 2.5},
                                         {-1.0, -4.0, 2.0},
                                         {-1.111, -2.121, 2.626}};
    std::string nff = head({{-1.1, -2.1, 2.6}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 45.0}, lights);
    nff += fill({1.0, 0.85, 0.7}, {.diffuse = 0.3, .specular = 0.6, .shine = shine_of(37.0)});
    nff += ground(2.0);
    const double radius = 1.0 / (kGears - (kGears - 1) * kToothPart / 2.0);
    const double apart = radius * (2.0 - kToothPart);
    const glm::dvec3 first(radius - 1.0, radius - 1.0, 1.0);
    const double thickness = std::min(0.1, 1.0 / (2.0 * kGears));
    for (int iz = 0; iz < kGears; ++iz) {
        for (int iy = 0; iy < kGears; ++iy) {
            for (int ix = 0; ix < kGears; ++ix) {
                const glm::dvec3 centre =
                    first + glm::dvec3(ix * apart, iy * apart, -static_cast<double>(iz) / kGears);
                const double turned = kPi * ((ix + iy + iz) % 2) / kTeeth;
                nff += gear_fill(ix, iy, iz) + gear(centre, radius, turned, thickness);
            }
        }
    }
    return nff;
}

// --- Tree ---------------------------------------------------------------------------------------

namespace {

constexpr double kThinner = 0.67;  // each end of a branch, compared to its beginning

// Where a twig sits on its branch: bent, turned about the branch, shorter, at the branch's end.
Transform twig(double bend, double turn, double shorter) {
    return translate({0.0, 0.0, 1.0}) * scale(glm::dvec3(shorter)) * rotate(turn, {0.0, 0.0, 1.0}) *
           rotate(bend, {1.0, 0.0, 0.0});
}

void grow(std::string& nff, const Transform& branch, double width, int generations) {
    const glm::dvec3 base = branch.point({0.0, 0.0, 0.0});
    const glm::dvec3 apex = branch.point({0.0, 0.0, 1.0});
    nff += cone(base, width, apex, width * kThinner) + sphere(apex, width * kThinner);
    if (generations == 0) return;
    grow(nff, branch * twig(40.0, 90.0, 0.65), width * kThinner, generations - 1);
    grow(nff, branch * twig(25.0, 230.0, 0.7), width * kThinner, generations - 1);
}

}  // namespace

std::string spd_tree() {
    const std::vector<glm::dvec3> lights{
        {-5.0, 5.0, 50.0},   {30.0, -30.0, 30.0}, {-40.0, -30.0, 20.0}, {10.0, 30.0, 40.0},
        {-30.0, 40.0, 10.0}, {50.0, 25.0, 20.0},  {-10.0, -60.0, 30.0}};
    std::string nff = head({{4.5, 0.4, 2.0}, {0.0, 0.0, 1.5}, {0.0, 0.0, 1.0}, 45.0}, lights);
    nff += fill({0.2, 0.7, 0.2}, {.diffuse = 1.0}) + ground(50.0);
    nff += fill({0.55, 0.4, 0.2}, {.diffuse = 1.0});
    grow(nff, Transform{}, 0.15, 11);
    return nff;
}

// --- Lattice ------------------------------------------------------------------------------------

std::string spd_lattice() {
    constexpr int kCells = 12;
    constexpr double kCell = 1.0 / kCells;
    constexpr double kSphere = kCell / 4.0;
    constexpr double kCylinder = kCell / 16.0;
    // The cylinders begin a little inside of the spheres.
    constexpr double kGap = 0.99 * kSphere * 0.5;
    const std::vector<glm::dvec3> lights{{2.0, 0.5, 0.5},  {-1.0, 0.5, 0.5}, {0.5, 2.0, 0.5},
                                         {0.5, -1.0, 0.5}, {0.5, 0.5, 2.0},  {0.5, 0.5, -1.0}};
    const double middle = 6.5 * kCell;  // of the cell behind the middle
    std::string nff = head({{middle, 1.0, 1.0 - kCell / 2.0},
                            {middle, -1.0, -1.0 - kCell / 2.0},
                            {0.2, 1.0, 0.0},
                            60.0},
                           lights);
    const std::string mirror =
        fill(glm::dvec3(0.9), {.diffuse = 0.5, .specular = 0.5, .shine = shine_of(37.0)});
    for (int i = 0; i < (kCells + 1) * (kCells + 1) * (kCells + 1); ++i) {
        const glm::ivec3 node(i % (kCells + 1), i / (kCells + 1) % (kCells + 1),
                              i / ((kCells + 1) * (kCells + 1)));
        const glm::dvec3 centre = glm::dvec3(node) * kCell;
        nff += mirror + sphere(centre, kSphere);
        for (int axis = 0; axis < 3; ++axis) {
            if (node[axis] == kCells) continue;
            glm::dvec3 colour(0.1);
            colour[axis] = 0.9;
            glm::dvec3 base = centre;
            glm::dvec3 apex = centre;
            base[axis] += kGap;
            apex[axis] += kCell - kGap;
            nff += fill(colour, {.diffuse = 0.99}) + cone(base, kCylinder, apex, kCylinder);
        }
    }
    return nff;
}

// --- Teapot -------------------------------------------------------------------------------------

namespace {

constexpr int kCuts = 12;  // of a patch and of the floor, along each edge

// Control points: patch[row][column]; s runs along the rows, t along the columns.
using Patch = std::array<std::array<glm::dvec3, 4>, 4>;

// A quarter of a ring around the z axis, as the control points of an arc. `side`: the arm that
// makes the arc round.
struct Ring {
    double radius;
    double z;
    double side;
};
Ring ring(double radius, double z) {
    return {radius, z, 0.56 * radius};
}

// Four quarters of the body of revolution of a profile; `turn` -1: clockwise seen from above.
void add_revolved(std::vector<Patch>& patches, const std::array<Ring, 4>& profile, double turn) {
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Transform place = rotate(turn * 90.0 * quarter, {0.0, 0.0, 1.0});
        Patch patch;
        for (std::size_t row = 0; row < 4; ++row) {
            const auto [r, z, side] = profile[row];
            patch[row] = {place.point({r, 0.0, z}), place.point({r, turn * side, z}),
                          place.point({side, turn * r, z}), place.point({0.0, turn * r, z})};
        }
        patches.push_back(patch);
    }
}

// A tube's cross-section in the plane y = 0: from the inner to the outer point, `half` as wide.
struct Section {
    glm::dvec2 inner;  // x, z
    glm::dvec2 outer;
    double half;
};

// The two halves of a tube, on either side of the plane y = 0.
void add_tube(std::vector<Patch>& patches, std::span<const Section, 4> sections) {
    Patch right;
    Patch left;
    for (std::size_t row = 0; row < 4; ++row) {
        const Section& s = sections[row];
        const auto inner = [&s](double y) { return glm::dvec3(s.inner.x, y, s.inner.y); };
        const auto outer = [&s](double y) { return glm::dvec3(s.outer.x, y, s.outer.y); };
        right[row] = {inner(0.0), inner(-s.half), outer(-s.half), outer(0.0)};
        left[row] = {outer(0.0), outer(s.half), inner(s.half), inner(0.0)};
    }
    patches.push_back(right);
    patches.push_back(left);
}

std::vector<Patch> teapot_patches() {
    constexpr double kHandle = 0.3;
    constexpr double kSpout = 0.66;
    constexpr double kLip = 0.25;
    constexpr double kMouth = 0.15;
    const std::array<Section, 7> handle{{{{-1.6, 2.025}, {-1.5, 2.25}, kHandle},
                                         {{-2.3, 2.025}, {-2.5, 2.25}, kHandle},
                                         {{-2.7, 2.025}, {-3.0, 2.25}, kHandle},
                                         {{-2.7, 1.8}, {-3.0, 1.8}, kHandle},
                                         {{-2.7, 1.575}, {-3.0, 1.35}, kHandle},
                                         {{-2.5, 1.125}, {-2.65, 0.9375}, kHandle},
                                         {{-2.0, 0.9}, {-1.9, 0.6}, kHandle}}};
    const std::array<Section, 7> spout{{{{1.7, 1.425}, {1.7, 0.6}, kSpout},
                                        {{2.6, 1.425}, {3.1, 0.825}, kSpout},
                                        {{2.3, 2.1}, {2.4, 2.025}, kLip},
                                        {{2.7, 2.4}, {3.3, 2.4}, kLip},
                                        {{2.8, 2.475}, {3.525, 2.49375}, kLip},
                                        {{2.9, 2.475}, {3.45, 2.5125}, kMouth},
                                        {{2.8, 2.4}, {3.2, 2.4}, kMouth}}};
    std::vector<Patch> patches;
    add_revolved(patches,
                 {ring(1.4, 2.4), ring(1.3375, 2.53125), ring(1.4375, 2.53125), ring(1.5, 2.4)},
                 -1.0);
    add_revolved(patches, {ring(1.5, 2.4), ring(1.75, 1.875), ring(2.0, 1.35), ring(2.0, 0.9)},
                 -1.0);
    add_revolved(patches, {ring(2.0, 0.9), ring(2.0, 0.45), ring(1.5, 0.225), ring(1.5, 0.15)},
                 -1.0);
    for (const auto* tube : {&handle, &spout}) {
        add_tube(patches, std::span(*tube).first<4>());
        add_tube(patches, std::span(*tube).last<4>());
    }
    add_revolved(patches, {ring(0.0, 3.15), {0.8, 3.15, 0.45}, ring(0.0, 2.85), ring(0.2, 2.7)},
                 -1.0);
    add_revolved(patches, {ring(0.2, 2.7), ring(0.4, 2.55), ring(1.3, 2.55), ring(1.3, 2.4)}, -1.0);
    add_revolved(patches, {ring(0.0, 0.0), ring(1.425, 0.0), ring(1.5, 0.075), ring(1.5, 0.15)},
                 1.0);
    return patches;
}

// Bernstein's polynomials of degree 3 and their derivatives.
std::array<double, 4> bernstein(double t) {
    const double u = 1.0 - t;
    return {u * u * u, 3.0 * t * u * u, 3.0 * t * t * u, t * t * t};
}
std::array<double, 4> bernstein_slope(double t) {
    const double u = 1.0 - t;
    return {-3.0 * u * u, 3.0 * u * u - 6.0 * t * u, 6.0 * t * u - 3.0 * t * t, 3.0 * t * t};
}

glm::dvec3 weighted(const Patch& patch, const std::array<double, 4>& s,
                    const std::array<double, 4>& t) {
    glm::dvec3 sum(0.0);
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t col = 0; col < 4; ++col)
            sum += s[row] * t[col] * patch[row][col];
    }
    return sum;
}

struct PatchPoint {
    glm::dvec3 position;
    glm::dvec3 normal;
};

PatchPoint patch_point(const Patch& patch, double s, double t) {
    const glm::dvec3 p = weighted(patch, bernstein(s), bernstein(t));
    const glm::dvec3 along_s = weighted(patch, bernstein_slope(s), bernstein(t));
    const glm::dvec3 along_t = weighted(patch, bernstein(s), bernstein_slope(t));
    const glm::dvec3 normal = glm::cross(along_t, along_s);
    const double length = glm::length(normal);
    if (length > 1e-12) return {p, normal / length};
    return {p, {0.0, 0.0, p.z > 1.5 ? 1.0 : -1.0}};  // the middle of the lid or of the bottom
}

bool is_on_the_axis(const PatchPoint& point) {
    return std::abs(point.position.x) < 1e-4 && std::abs(point.position.y) < 1e-4;
}

std::string patch_triangles(const Patch& patch) {
    std::string nff;
    for (int i = 0; i < kCuts * kCuts; ++i) {
        const int row = i / kCuts;
        const int col = i % kCuts;
        const auto at = [&](int ds, int dt) {
            return patch_point(patch, static_cast<double>(row + ds) / kCuts,
                               static_cast<double>(col + dt) / kCuts);
        };
        const std::array<PatchPoint, 4> corners{at(0, 0), at(0, 1), at(1, 1), at(1, 0)};
        for (const std::size_t first : {0u, 2u}) {
            const std::array<PatchPoint, 3> triangle{corners[first], corners[first + 1],
                                                     corners[(first + 2) % 4]};
            // Two corners in the middle of lid or bottom: no triangle.
            if (std::count_if(triangle.begin(), triangle.end(), is_on_the_axis) > 1) continue;
            nff += "pp 3\n";
            for (const PatchPoint& corner : triangle)
                nff += text(corner.position) + ' ' + text(corner.normal) + '\n';
        }
    }
    return nff;
}

std::string board_squares(int odd) {
    std::string nff;
    const double side = 8.0 / kCuts;
    for (int i = 0; i < kCuts * kCuts; ++i) {
        const int x = i / kCuts;
        const int y = i % kCuts;
        if ((x + y) % 2 != odd) continue;
        const glm::dvec3 corner(x * side - 4.0, y * side - 4.0, 0.0);
        const std::vector<glm::dvec3> square{corner, corner + glm::dvec3(side, 0.0, 0.0),
                                             corner + glm::dvec3(side, side, 0.0),
                                             corner + glm::dvec3(0.0, side, 0.0)};
        nff += polygon(square);
    }
    return nff;
}

}  // namespace

std::string spd_teapot() {
    const std::vector<glm::dvec3> lights{{-3.1, 9.8, 12.1}, {11.3, 5.1, 8.8}};
    std::string nff = head({{4.86, 7.2, 5.4}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 45.0}, lights);
    const Fill board{.diffuse = 0.5, .specular = 0.5, .shine = shine_of(30.0)};
    nff += fill(glm::dvec3(1.0), board) + board_squares(1);
    nff += fill(glm::dvec3(0.5), board) + board_squares(0);
    nff += fill({1.0, 0.5, 0.1}, {.diffuse = 0.75, .specular = 0.25, .shine = shine_of(37.0)});
    for (const Patch& patch : teapot_patches())
        nff += patch_triangles(patch);
    return nff;
}

}  // namespace raypick
