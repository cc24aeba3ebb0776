// No light gets into a closed room, whatever it is made of, wherever it stands and however large.
#include "tests/sanitized.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/shade/trace.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace raypick {
namespace {

// In object space, around 0 and within 2 of it.
struct Room {
    std::string name;
    std::vector<Shape> walls;  // or else:
    MeshData mesh;
    // A place where walls meet.
    std::function<glm::dvec3(Random&)> edge_point;
};

constexpr glm::dvec3 kLow{-1.0, -0.7, -1.3};
constexpr glm::dvec3 kHigh{1.0, 0.9, 1.1};

// On one of the box's twelve edges.
glm::dvec3 box_edge_point(Random& random) {
    glm::dvec3 p;
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = random.unit() < 0.5 ? kLow[axis] : kHigh[axis];
    const auto along = static_cast<int>(random.below(3));
    p[along] = random.between(kLow[along], kHigh[along]);
    return p;
}

// On an edge of a mesh, where its triangles meet.
std::function<glm::dvec3(Random&)> edge_points_of(const MeshData& mesh) {
    return [mesh](Random& random) {
        const glm::uvec3 t = mesh.triangles[random.below(mesh.triangles.size())];
        const auto corner = static_cast<int>(random.below(3));
        const glm::dvec3 a(mesh.positions[t[corner]]);
        const glm::dvec3 b(mesh.positions[t[(corner + 1) % 3]]);
        return a + random.unit() * (b - a);
    };
}

MeshData box_mesh() {
    MeshData data;
    for (int i = 0; i < 8; ++i) {
        data.positions.emplace_back((i & 1) != 0 ? kHigh.x : kLow.x,
                                    (i & 2) != 0 ? kHigh.y : kLow.y,
                                    (i & 4) != 0 ? kHigh.z : kLow.z);
    }
    data.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return data;
}

MeshData tetrahedron_mesh() {
    MeshData data;
    data.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    data.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    return data;
}

std::vector<Shape> rectangle_walls() {
    const glm::dvec3 x{kHigh.x - kLow.x, 0, 0};
    const glm::dvec3 y{0, kHigh.y - kLow.y, 0};
    const glm::dvec3 z{0, 0, kHigh.z - kLow.z};
    return {Rectangle{kLow, x, y},    Rectangle{kLow, y, z},    Rectangle{kLow, z, x},
            Rectangle{kHigh, -x, -y}, Rectangle{kHigh, -y, -z}, Rectangle{kHigh, -z, -x}};
}

// On the circle in which the side of a truncated cone around y meets a cap.
std::function<glm::dvec3(Random&)> rim_points(double base_radius, double apex_radius) {
    return [=](Random& random) {
        const bool base = random.unit() < 0.5;
        const double angle = random.between(0.0, 2.0 * std::numbers::pi);
        const double radius = base ? base_radius : apex_radius;
        return glm::dvec3(radius * std::cos(angle), base ? -0.8 : 0.8, radius * std::sin(angle));
    };
}

std::vector<Room> rooms() {
    const auto sphere_point = [](Random& random) { return random.direction(); };
    const MeshData ball = ball_data(3);
    const glm::dvec3 foot(0, -0.8, 0);
    return {{"rectangles", rectangle_walls(), {}, box_edge_point},
            {"box", {Box{kLow, kHigh}}, {}, box_edge_point},
            {"box of triangles", {}, box_mesh(), box_edge_point},
            {"tetrahedron", {}, tetrahedron_mesh(), edge_points_of(tetrahedron_mesh())},
            {"ball of triangles", {}, ball, edge_points_of(ball)},
            {"sphere", {Sphere{{0, 0, 0}, 1.0}}, {}, sphere_point},
            {"cylinder", {Cone{foot, -foot, 0.9, 0.9}}, {}, rim_points(0.9, 0.9)},
            {"truncated cone", {Cone{foot, -foot, 1.2, 0.5}}, {}, rim_points(1.2, 0.5)},
            {"disks around a pipe",
             {Cone{foot, -foot, 0.9, 0.9, false}, Disk{foot, {0, -1, 0}, 0.9},
              Disk{-foot, {0, 1, 0}, 0.9}},
             {},
             rim_points(0.9, 0.9)}};
}

Scene scene_of(const Room& room, const Transform& world_from_object) {
    Scene scene;
    scene.ambient = glm::vec3(0.0f);
    scene.background = glm::vec3(1.0f);  // what a leak would show
    Material white;
    white.ambient = glm::vec3(1.0f);
    white.diffuse = glm::vec3(1.0f);
    white.reflect = glm::vec3(0.5f);
    const MaterialId material = add_material(scene, white);
    for (const Shape& wall : room.walls)
        place(scene, wall, material, world_from_object);
    if (room.walls.empty()) place_mesh(scene, room.mesh, material, world_from_object);
    for (const glm::dvec3& p : {glm::dvec3(5, 1, 2), glm::dvec3(-3, 6, 1), glm::dvec3(0, -4, -9)}) {
        scene.lights.emplace_back(
            PointLight{"outside", world_from_object.point(p), glm::vec3(100.0f)});
    }
    return scene;
}

struct Place {
    std::string name;
    Transform world_from_object;
};

std::vector<Place> places() {
    const Transform turned = rotate(70.0, {1, 2, 3});
    return {{"as it is", {}},
            {"turned", turned},
            {"small", scale(glm::dvec3(1e-4)) * turned},
            {"large", scale(glm::dvec3(1e4))},
            {"moved", translate({20, -7, 3}) * turned},
            {"far", translate({1e3, 2e3, -3e3})},
            {"squeezed", translate({2, 9, -4}) * turned * scale({1.0, 0.2, -3.0})}};
}

TEST(NoLeak, AClosedRoomLitFromOutsideIsBlackInside) {
    const unsigned rays = is_sanitized() ? 800 : 8000;
    for (const Room& room : rooms()) {
        for (const Place& place : places()) {
            SCOPED_TRACE(room.name + ", " + place.name);
            const Transform& world_from_object = place.world_from_object;
            const Accel accel = accel_of(scene_of(room, world_from_object));
            RenderSettings settings;
            settings.depth = 4;
            RayCounts counts;
            Random random(37);
            int lit = 0;
            for (unsigned i = 0; i < rays; ++i) {
                const glm::vec3 from(
                    world_from_object.point(random.point(glm::dvec3(-0.3), glm::dvec3(0.3))));
                // All but every fourth where walls meet.
                const glm::dvec3 target = i % 4 == 0 ? random.direction() : room.edge_point(random);
                const Ray ray = ray_towards(from, world_from_object.point(target));
                const TracedRay traced = trace(accel, accel.scene().lights, settings, ray, counts);
                lit += traced.colour != glm::vec3(0.0f) ? 1 : 0;
            }
            EXPECT_EQ(lit, 0);
            EXPECT_GT(counts.reflection, rays);
        }
    }
}

}  // namespace
}  // namespace raypick
