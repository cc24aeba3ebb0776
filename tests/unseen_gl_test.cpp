// What the rasteriser leaves out because it can't be seen: the picture must be the same to the bit.
#include "tests/gl_fixture.h"
#include "tracer/geometry/transform.h"
#include "viewer/raster/needed_triangles.h"
#include "viewer/raster/rasterizer.h"

#include <glm/geometric.hpp>

#include <cstring>
#include <random>
#include <vector>

namespace raypick {
namespace {

constexpr ImageSize kSize{151, 233};  // odd and not square

// Adds to meshes what is big, slim, tiny or nothing at all.
class TriangleMaker {
public:
    explicit TriangleMaker(unsigned seed) : random_(seed) {}

    float number(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random_);
    }
    glm::vec3 point(float reach) {
        return {number(-reach, reach), number(-reach, reach), number(-reach, reach)};
    }

    void add(MeshData& data, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        const auto first = static_cast<std::uint32_t>(data.positions.size());
        data.positions.insert(data.positions.end(), {a, b, c});
        data.triangles.emplace_back(first, first + 1, first + 2);
    }
    void add_big(MeshData& data) { add(data, point(3.0f), point(3.0f), point(3.0f)); }
    void add_tiny(MeshData& data) {
        const glm::vec3 a = point(2.0f);
        add(data, a, a + point(0.03f), a + point(0.03f));
    }
    // Thinner than a pixel, as long as the picture is wide.
    void add_sliver(MeshData& data) {
        const glm::vec3 a = point(3.0f);
        add(data, a, point(3.0f), a + point(number(0.0f, 1.0f) < 0.5f ? 1e-5f : 4e-3f));
    }
    void add_line(MeshData& data) {
        const glm::vec3 a = point(2.0f);
        const glm::vec3 b = point(2.0f);
        add(data, a, b, 0.5f * (a + b));
    }

private:
    std::mt19937 random_;
};

Mesh random_mesh(TriangleMaker& maker) {
    MeshData data;
    for (int i = 0; i < 4; ++i)
        maker.add_big(data);
    for (int i = 0; i < 300; ++i)
        maker.add_tiny(data);
    for (int i = 0; i < 60; ++i)
        maker.add_sliver(data);
    for (int i = 0; i < 5; ++i)
        maker.add_line(data);
    return make_mesh("mesh", std::move(data));
}

Object placed(MeshId mesh, const Transform& place) {
    Object object;
    object.name = "object";
    object.shape = MeshInstance{mesh};
    object.world_from_object = place;
    return object;
}

Scene random_scene(TriangleMaker& maker) {
    Scene scene;
    for (int i = 0; i < 3; ++i) {
        const MeshId mesh = add_mesh(scene, random_mesh(maker));
        add_object(scene, placed(mesh, rotate(maker.number(0.0f, 90.0f), {1, 2, 3})));
        add_object(scene, placed(mesh, translate({0.3, 0.1, -0.4}) * rotate(20, {0, 1, 1}) *
                                           scale({0.2, -1.5, maker.number(0.5f, 4.0f)})));
        scene.objects.back().sides = i == 1 ? Sides::front_only : Sides::both;
    }
    Object ball;
    ball.name = "ball";
    ball.shape = Sphere{{0.5, 0.0, 0.0}, 0.6};
    add_object(scene, std::move(ball));
    scene.lights.emplace_back(DirectionalLight{"sun", {0.3, -2.0, -1.0}, glm::vec3(0.8f)});
    return scene;
}

Camera random_camera(TriangleMaker& maker, int kind) {
    Camera camera;
    camera.eye = maker.point(kind == 0 ? 1.0f : 6.0f);  // amid the triangles, or before them
    camera.at = maker.point(1.0f);
    camera.fovy = maker.number(5.0f, 120.0f);
    camera.near = 1e-2;
    if (kind == 2) {
        camera.projection = Projection::orthographic;
        camera.height = 5.0;
    }
    return camera;
}

class UnseenTest : public GlTest {
protected:
    static Image draw(Unseen unseen, const std::shared_ptr<const Scene>& scene,
                      const Camera& camera) {
        Rasterizer rasterizer(unseen);
        rasterizer.set_scene(scene);
        rasterizer.draw(camera, kSize);
        return rasterizer.read_image();
    }

    // To the bit: a triangle without area may have a normal that is no number.
    template <typename T>
    static bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
        return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
    }

    static void expect_same(const Image& a, const Image& b) {
        EXPECT_TRUE(same_bits(a.object, b.object));
        EXPECT_TRUE(same_bits(a.primitive, b.primitive));
        EXPECT_TRUE(same_bits(a.depth, b.depth));
        EXPECT_TRUE(same_bits(a.normal, b.normal));
        EXPECT_TRUE(same_bits(a.colour, b.colour));
    }
};

TEST_F(UnseenTest, LeavingItOutChangesNoBitOfThePicture) {
    for (unsigned seed = 0; seed < 40; ++seed) {
        SCOPED_TRACE(seed);
        TriangleMaker maker(seed);
        const auto scene = std::make_shared<const Scene>(random_scene(maker));
        const Camera camera = random_camera(maker, static_cast<int>(seed % 3));
        expect_same(draw(Unseen::left_out, scene, camera), draw(Unseen::drawn, scene, camera));
    }
}

// A wall at z = 0 before a sheet of small triangles at z = -1, seen from z = 3.
struct WallAndSheet {
    MeshData wall;
    MeshData sheet;
    Camera camera;
    ViewNumbers view;

    WallAndSheet() {
        TriangleMaker maker(1);
        maker.add(wall, {-4, -3, 0}, {4, -4, 0}, {4, 4.2f, 0});
        maker.add(wall, {-4, -3, 0}, {4, 4.2f, 0}, {-4, 4, 0});
        for (int i = 0; i < 400; ++i) {
            const glm::vec3 a(maker.number(-0.5f, 0.5f), maker.number(-0.5f, 0.5f), -1.0f);
            maker.add(sheet, a, a + glm::vec3(0.1f, 0.0f, 0.0f), a + glm::vec3(0.0f, 0.1f, 0.0f));
        }
        look_from({0.0, 0.0, 3.0});
    }

    void look_from(const glm::dvec3& eye, double near = 1e-2) {
        camera.eye = eye;
        camera.at = eye - glm::dvec3(0.0, 0.0, 1.0);
        camera.near = near;
        view = view_numbers(camera, kSize);
    }

    [[nodiscard]] std::vector<NeededTriangles> needed(bool wall_hides) const {
        const MeshNumbers numbers = mesh_numbers(view, Transform(), Transform());
        const std::vector<MeshInView> meshes{{wall.positions, wall.triangles, numbers, wall_hides},
                                             {sheet.positions, sheet.triangles, numbers, true}};
        return needed_triangles(view, kSize, meshes);
    }
};

TEST(NeededTriangles, NothingBehindAWallIsNeeded) {
    const WallAndSheet scene;
    const auto needed = scene.needed(true);
    EXPECT_TRUE(needed[0].all);
    EXPECT_FALSE(needed[1].all);
    // But at its diagonal, where neither half surely takes the pixels.
    EXPECT_LT(needed[1].triangles.size(), 10u);
}

TEST(NeededTriangles, WhatDoesNotHideLeavesAllBehindIt) {
    const WallAndSheet scene;
    const auto needed = scene.needed(false);
    EXPECT_TRUE(needed[0].all);
    EXPECT_TRUE(needed[1].all);
}

TEST(NeededTriangles, ParallelViewsKeepWhatIsHidden) {
    WallAndSheet scene;
    scene.camera.projection = Projection::orthographic;
    scene.camera.height = 4.0;
    scene.view = view_numbers(scene.camera, kSize);
    EXPECT_TRUE(scene.needed(true)[1].all);
}

TEST(NeededTriangles, WhatTheEyeHasPassedIsNotNeeded) {
    WallAndSheet scene;
    scene.look_from({0.0, 0.0, -0.1});  // between wall and sheet
    auto needed = scene.needed(true);
    EXPECT_TRUE(needed[0].triangles.empty());
    EXPECT_FALSE(needed[0].all);
    EXPECT_FALSE(needed[1].triangles.empty());
    scene.look_from({0.0, 0.0, 3.0}, 3.5);  // the near plane is
    needed = scene.needed(true);
    EXPECT_TRUE(needed[0].triangles.empty());
    EXPECT_TRUE(needed[1].all);
}

TEST(NeededTriangles, WhatMeetsTheNearPlaneIsNeededAndHidesNothing) {
    WallAndSheet scene;
    for (glm::vec3& p : scene.wall.positions)
        p.z = p.x > 0.0f ? 3.5f : -0.5f;
    const auto needed = scene.needed(true);
    EXPECT_TRUE(needed[0].all);
    EXPECT_TRUE(needed[1].all);
}

TEST(NeededTriangles, WhatLiesBetweenPixelCentresIsNotNeeded) {
    WallAndSheet scene;
    // Pixels are 3 * 2 tan(fovy / 2) / rows large there: about 0.02.
    for (std::size_t i = 0; i < scene.sheet.positions.size(); ++i)
        scene.sheet.positions[i] = scene.sheet.positions[i / 3 * 3];
    for (glm::uvec3& triangle : scene.sheet.triangles) {
        scene.sheet.positions[triangle.y].x += 1e-4f;
        scene.sheet.positions[triangle.z].y += 1e-4f;
    }
    const auto needed = scene.needed(false);
    EXPECT_LT(needed[1].triangles.size(), 40u);  // of 400, by where they happen to lie
}

}  // namespace
}  // namespace raypick
