#include "tests/spd_scenes.h"

#include "tracer/geometry/transform.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
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

}  // namespace raypick
