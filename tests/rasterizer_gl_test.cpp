// The rasteriser against the tracer on scenes made here: ids, t, normals, shading, rows, clipping.
#include "viewer/raster/rasterizer.h"

#include "tests/agreement.h"
#include "tests/gl_fixture.h"
#include "tracer/error.h"
#include "tracer/render/render_job.h"
#include "tracer/shade/trace.h"
#include "viewer/gl/load_gl.h"
#include "viewer/gl/textures.h"
#include "viewer/raster/gpu_mesh.h"
#include "viewer/raster/presenter.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace raypick {
namespace {

constexpr ImageSize kSize{211, 317};  // odd and not square

Object shape_object(const char* name, const Shape& shape, const Transform& place = {},
                    MaterialId material = kNoMaterial) {
    Object object;
    object.name = name;
    object.shape = shape;
    object.world_from_object = place;
    object.material = material;
    return object;
}

Camera look(const glm::dvec3& eye, const glm::dvec3& at, double near = 1e-3) {
    Camera camera;
    camera.eye = eye;
    camera.at = at;
    camera.near = near;
    return camera;
}

Material coloured(const glm::vec3& colour, float shininess) {
    Material m;
    m.ambient = 0.5f * colour;
    m.diffuse = colour;
    m.specular = glm::vec3(0.4f);
    m.shininess = shininess;
    m.emissive = 0.05f * colour;
    return m;
}

// A bumpy sheet over [-1, 1]^2 in x and z, `cells` a side.
Mesh sheet(int cells, bool with_normals) {
    MeshData data;
    const auto height = [](float x, float z) {
        return 0.2f * std::sin(3.0f * x) * std::cos(2.0f * z);
    };
    for (int i = 0; i <= cells; ++i) {
        for (int j = 0; j <= cells; ++j) {
            const float x = -1.0f + 2.0f * static_cast<float>(i) / static_cast<float>(cells);
            const float z = -1.0f + 2.0f * static_cast<float>(j) / static_cast<float>(cells);
            data.positions.emplace_back(x, height(x, z), z);
            if (with_normals) {
                const glm::vec3 slope(-0.6f * std::cos(3.0f * x) * std::cos(2.0f * z), 1.0f,
                                      0.4f * std::sin(3.0f * x) * std::sin(2.0f * z));
                data.normals.push_back(glm::normalize(slope));
            }
        }
    }
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const auto a = static_cast<std::uint32_t>(i * (cells + 1) + j);
            const auto b = a + static_cast<std::uint32_t>(cells) + 1;
            data.triangles.emplace_back(a, a + 1, b);
            data.triangles.emplace_back(b, a + 1, b + 1);
        }
    }
    return make_mesh("sheet", std::move(data));
}

// One of each shape, nothing symmetric, with non-uniform and mirrored instances.
Scene mixed_scene() {
    Scene scene;
    const MaterialId red = add_material(scene, coloured({0.8f, 0.2f, 0.1f}, 20.0f));
    const MaterialId blue = add_material(scene, coloured({0.1f, 0.3f, 0.9f}, 60.0f));
    const MaterialId green = add_material(scene, coloured({0.2f, 0.7f, 0.2f}, 5.0f));
    Mesh flat = sheet(12, false);
    flat.parts = {{0, 100, red}, {100, 188, blue}};
    const MeshId flat_mesh = add_mesh(scene, std::move(flat));
    const MeshId smooth_mesh = add_mesh(scene, sheet(16, true));
    add_object(scene, shape_object("floor", Plane{{0.02, 1.0, 0.01}, 1.0}, {}, green));
    add_object(scene, shape_object("ball", Sphere{{-1.2, 0.1, 0.3}, 0.7}, {}, red));
    add_object(scene, shape_object("egg", Sphere{{0.0, 0.0, 0.0}, 1.0},
                                   translate({1.3, 0.4, -0.8}) * rotate(30, {1, 2, 3}) *
                                       scale({0.3, 0.9, -0.5}),
                                   blue));
    add_object(scene, shape_object("box", Box{{-0.4, -0.3, -0.2}, {0.4, 0.3, 0.2}},
                                   translate({0.2, -0.3, 1.2}) * rotate(-25, {0, 1, 0.3}), blue));
    add_object(scene,
               shape_object("corner", Triangle{{-2.0, 1.0, 0.0}, {-0.5, 1.4, 0.2}, {-1.1, 2.0, 0}},
                            {}, green));
    add_object(scene, shape_object("flat", MeshInstance{flat_mesh},
                                   translate({0.3, 1.4, -0.5}) * rotate(70, {1, 0.2, 0})));
    add_object(scene, shape_object("smooth", MeshInstance{smooth_mesh},
                                   translate({1.9, -0.2, 0.9}) * rotate(-40, {0.3, 1, 1}) *
                                       scale({-0.7, 1.1, 0.4}),
                                   red));
    scene.lights.emplace_back(PointLight{"lamp", {2.0, 4.0, 3.0}, glm::vec3(0.7f, 0.6f, 0.5f)});
    scene.lights.emplace_back(DirectionalLight{"sun", {0.3, -2.0, -1.0}, glm::vec3(0.3f)});
    return scene;
}

class RasterizerTest : public GlTest {
protected:
    Image draw(const Camera& camera, ImageSize size = kSize, std::uint32_t mask = 0xffffffffu) {
        if (!rasterizer_) rasterizer_ = std::make_unique<Rasterizer>();
        rasterizer_->set_scene(scene_);
        rasterizer_->draw(camera, size, mask);
        return rasterizer_->read_image();
    }

    void use(Scene scene) {
        check_scene(scene);
        scene_ = std::make_shared<const Scene>(std::move(scene));
        accel_ = std::make_unique<Accel>(scene_);
    }

    Agreement agree(const Camera& camera) {
        const Image image = draw(camera);
        Agreement result = compare(*accel_, camera, image);
        fmt::print("    {}\n", result.summary());
        EXPECT_EQ(result.uniform_differ, 0u) << result.summary();
        EXPECT_LE(result.edge_share(), 0.005) << result.summary();
        return result;
    }

    void TearDown() override { rasterizer_.reset(); }

    std::shared_ptr<const Scene> scene_;
    std::unique_ptr<Accel> accel_;
    std::unique_ptr<Rasterizer> rasterizer_;
};

// The same local light that the raster view has: no shadows, no further rays.
RenderSettings local_light() {
    RenderSettings settings;
    settings.shadows = settings.reflections = settings.refractions = false;
    return settings;
}

TEST_F(RasterizerTest, MixedSceneShowsWhatTheRaysHit) {
    use(mixed_scene());
    for (const auto& eye : {glm::dvec3(0.5, 1.5, 6.0), glm::dvec3(-5.0, 2.0, 2.0),
                            glm::dvec3(3.0, 3.0, -4.0), glm::dvec3(1.0, -0.8, 5.0)}) {
        const Agreement result = agree(look(eye, {0.2, 0.2, 0.1}));
        EXPECT_GE(result.objects, 4u);
        EXPECT_LT(result.t_error, 2e-6);
    }
}

TEST_F(RasterizerTest, ShadingIsTheTracersLocalLight) {
    use(mixed_scene());
    const Camera camera = look({0.5, 1.5, 6.0}, {0.2, 0.2, 0.1});
    const Image image = draw(camera);
    const auto lights = effective_lights(*scene_, camera);
    RayCounts counts;
    double colour_error = 0.0;
    double normal_error = 0.0;
    std::size_t same = 0;
    for (int row = 0; row < kSize.rows; ++row) {
        for (int col = 0; col < kSize.cols; ++col) {
            const std::size_t i = kSize.index({row, col});
            const TracedRay traced = trace(*accel_, lights, local_light(),
                                           camera_ray(camera, kSize, Pixel{row, col}), counts);
            if (traced.hit.object != image.object[i]) continue;
            if (traced.hit.valid() && traced.hit.primitive != image.primitive[i]) continue;
            ++same;
            const glm::vec3 dc = glm::abs(traced.colour - image.colour[i]);
            const glm::vec3 dn = glm::abs(traced.normal - image.normal[i]);
            colour_error += static_cast<double>(dc.x + dc.y + dc.z) / 3.0;
            normal_error += static_cast<double>(dn.x + dn.y + dn.z) / 3.0;
            // A light on the horizon of a flat face may be in on one side only; nothing else.
            EXPECT_LT(glm::length(dn), 2e-2f)
                << row << " " << col << " of object " << image.object[i];
        }
    }
    EXPECT_GT(same, kSize.pixel_count() * 99 / 100);
    EXPECT_LT(colour_error / static_cast<double>(same), 1e-4);
    EXPECT_LT(normal_error / static_cast<double>(same), 1e-4);
}

TEST_F(RasterizerTest, RowsAndColumnsAreNotTurnedOver) {
    Scene scene;
    // Only in the top left quarter, and nothing symmetric about it.
    const ObjectId mark = add_object(scene, shape_object("mark", Sphere{{-1.0, 0.8, 0.0}, 0.3}));
    use(std::move(scene));
    const Camera camera = look({0.0, 0.0, 5.0}, {0.0, 0.0, 0.0});
    const Image image = draw(camera);
    const auto centre = project(camera, kSize, {-1.0, 0.8, 0.0});
    ASSERT_TRUE(centre);
    const Pixel at{static_cast<int>(centre->r), static_cast<int>(centre->c)};
    EXPECT_LT(at.row, kSize.rows / 2);
    EXPECT_LT(at.col, kSize.cols / 2);
    EXPECT_EQ(image.object[kSize.index(at)], mark);
    EXPECT_EQ(image.object[kSize.index({kSize.rows - 1 - at.row, at.col})], kNoObject);
    EXPECT_EQ(image.object[kSize.index({at.row, kSize.cols - 1 - at.col})], kNoObject);
    const Agreement result = agree(camera);
    EXPECT_LE(result.edge_differ, 4u) << result.summary();
}

TEST_F(RasterizerTest, BackgroundIsEmpty) {
    Scene scene;
    scene.background = {0.25f, 0.5f, 0.75f};
    use(std::move(scene));
    const Image image = draw(look({0, 0, 5}, {0, 0, 0}), {3, 5});
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        EXPECT_EQ(image.colour[i], glm::vec3(0.25f, 0.5f, 0.75f));
        EXPECT_EQ(image.depth[i], std::numeric_limits<float>::infinity());
        EXPECT_EQ(image.normal[i], glm::vec3(0.0f));
        EXPECT_EQ(image.object[i], kNoObject);
        EXPECT_EQ(image.primitive[i], 0xffffffffu);
    }
}

TEST_F(RasterizerTest, ObjectsOfAnotherMaskAreNotDrawn) {
    Scene scene;
    Object front = shape_object("front", Sphere{{0, 0, 2}, 1.0});
    front.mask = 2u;
    add_object(scene, front);
    const ObjectId back = add_object(scene, shape_object("back", Sphere{{0, 0, 0}, 1.0}));
    use(std::move(scene));
    const Image image = draw(look({0, 0, 6}, {0, 0, 0}), kSize, 1u);
    EXPECT_EQ(image.object[kSize.index({kSize.rows / 2, kSize.cols / 2})], back);
}

TEST_F(RasterizerTest, NearPlaneCutsThroughEverything) {
    use(mixed_scene());
    for (const double near : {4.0, 5.0, 5.7, 6.3}) {
        const Camera camera = look({0.5, 1.5, 6.0}, {0.2, 0.2, 0.1}, near);
        agree(camera);
        const Image image = draw(camera);
        for (int row = 0; row < kSize.rows; ++row) {
            for (int col = 0; col < kSize.cols; ++col) {
                EXPECT_GT(image.depth[kSize.index({row, col})],
                          camera_ray(camera, kSize, Pixel{row, col}).t_min * 0.999999f);
            }
        }
    }
}

TEST_F(RasterizerTest, EyeInsideShapes) {
    Scene scene;
    const ObjectId shell = add_object(
        scene, shape_object("shell", Sphere{{0.2, 0.1, 0.0}, 2.0}, scale({1.0, 1.5, -1.0})));
    const ObjectId room = add_object(scene, shape_object("room", Box{{-1, -1, -1}, {1, 1, 1.2}}));
    add_object(scene, shape_object("ball", Sphere{{0.4, 0.2, -0.5}, 0.2}));
    use(std::move(scene));
    const Camera camera = look({0.1, 0.2, 0.8}, {0.0, 0.0, -1.0});
    EXPECT_EQ(agree(camera).edge_differ, 0u);
    const Image image = draw(camera);
    EXPECT_EQ(image.object[0], room);
    EXPECT_EQ(std::count(image.object.begin(), image.object.end(), kNoObject), 0);
    // Farther than the room's walls but inside the shell.
    const Camera beyond = look({0.1, 0.2, 0.8}, {0.0, 0.0, -1.0}, 1.9);
    EXPECT_EQ(draw(beyond).object[kSize.index({kSize.rows / 2, kSize.cols / 2})], shell);
    agree(beyond);
}

TEST_F(RasterizerTest, FarFromTheOrigin) {
    Scene near_scene = mixed_scene();
    Scene scene = mixed_scene();
    const glm::dvec3 offset(5.0e6, -3.0e6, 2.0e6);
    for (Object& object : scene.objects) {
        object.world_from_object = translate(offset) * object.world_from_object;
    }
    use(std::move(scene));
    // Ray origins are floats: here they lie on a grid of 0.5.
    const glm::dvec3 eye = glm::dvec3(glm::vec3(offset + glm::dvec3(0.5, 1.5, 6.0)));
    const Agreement result = agree(look(eye, eye - glm::dvec3(0.3, 1.3, 5.9)));
    EXPECT_GE(result.objects, 5u);
    EXPECT_LT(result.t_error, 2e-6);
}

TEST_F(RasterizerTest, TinyAndHugeScenes) {
    for (const double size : {1e-6, 1e6}) {
        Scene scene = mixed_scene();
        for (Object& object : scene.objects) {
            object.world_from_object = scale(glm::dvec3(size)) * object.world_from_object;
        }
        for (Light& light : scene.lights) {
            if (auto* point = std::get_if<PointLight>(&light)) point->position *= size;
        }
        use(std::move(scene));
        const Camera camera =
            look(size * glm::dvec3(0.5, 1.5, 6.0), size * glm::dvec3(0.2, 0.2, 0.1), 1e-3 * size);
        const Agreement result = agree(camera);
        EXPECT_GE(result.objects, 5u);
        EXPECT_LT(result.t_error, 2e-6);
    }
}

TEST_F(RasterizerTest, DoubledSurfacesGoToTheLowestId) {
    Scene scene;
    const MeshId mesh = add_mesh(scene, sheet(10, true));
    const Transform place = rotate(35, {1, 0, 0.2});
    // Twice the same, then the same again through other triangles and corners.
    MeshData turned = *scene.meshes[mesh].storage;
    std::reverse(turned.triangles.begin(), turned.triangles.end());
    for (glm::uvec3& t : turned.triangles)
        t = {t.z, t.x, t.y};
    const MeshId other = add_mesh(scene, make_mesh("turned", std::move(turned)));
    const ObjectId first = add_object(scene, shape_object("a", MeshInstance{other}, place));
    add_object(scene, shape_object("b", MeshInstance{mesh}, place));
    add_object(scene, shape_object("c", MeshInstance{mesh}, place));
    add_object(scene, shape_object("d", MeshInstance{other}, place));
    use(std::move(scene));
    for (const auto& eye : {glm::dvec3(0.5, 2.5, 3.0), glm::dvec3(30.0, 15.0, 20.0)}) {
        const Camera camera = look(eye, {0.0, 0.0, 0.0});
        const Agreement result = agree(camera);
        EXPECT_EQ(result.ties, 0u) << result.summary();
        const Image image = draw(camera);
        for (const ObjectId id : image.object)
            EXPECT_TRUE(id == first || id == kNoObject);
    }
}

TEST_F(RasterizerTest, CoplanarFacesOfDifferentShapes) {
    Scene scene;
    MeshData quad;
    quad.positions = {
        {-1.5f, 0.5f, -1.0f}, {1.5f, 0.5f, -1.0f}, {1.5f, 0.5f, 1.5f}, {-1.5f, 0.5f, 1.5f}};
    quad.triangles = {{0, 2, 1}, {0, 3, 2}};
    const MeshId mesh = add_mesh(scene, make_mesh("quad", std::move(quad)));
    add_object(scene, shape_object("box", Box{{-0.7, -0.5, -0.7}, {0.7, 0.5, 0.7}}));
    add_object(scene, shape_object("quad", MeshInstance{mesh}));
    add_object(scene, shape_object("plane", Plane{{0.0, 2.0, 0.0}, -1.0}));
    use(std::move(scene));
    for (const auto& eye : {glm::dvec3(0.5, 2.5, 3.0), glm::dvec3(2.0, 0.9, 4.0)}) {
        const Agreement result = agree(look(eye, {0.0, 0.5, 0.0}));
        EXPECT_EQ(result.objects, 3u);
        EXPECT_LE(result.ties, 5u) << result.summary();  // on the box's edges
    }
}

TEST_F(RasterizerTest, ColourAloneIsThatOfTheImage) {
    use(mixed_scene());
    const Image image = draw(look({0.5, 1.5, 6.0}, {0.2, 0.2, 0.1}));
    const Image colour = rasterizer_->read_colour();
    EXPECT_EQ(colour.size, image.size);
    EXPECT_EQ(colour.colour, image.colour);
    EXPECT_TRUE(colour.depth.empty());
}

TEST_F(RasterizerTest, WarmingUpLeavesNoTrace) {
    use(mixed_scene());
    const Camera camera = look({0.5, 1.5, 6.0}, {0.2, 0.2, 0.1});
    const Image image = draw(camera);
    for (const ImageSize size : {kSize, ImageSize{3, 7}}) {
        rasterizer_ = std::make_unique<Rasterizer>();
        rasterizer_->warm_up(size);
        EXPECT_THROW(rasterizer_->draw(camera, kSize), Error) << "there is no scene yet";
        const Image again = draw(camera);
        EXPECT_EQ(again.colour, image.colour);
        EXPECT_EQ(again.object, image.object);
        EXPECT_EQ(again.primitive, image.primitive);
        EXPECT_EQ(again.depth, image.depth);
        EXPECT_EQ(again.normal, image.normal);
    }
}

TEST_F(RasterizerTest, DroppingTheTieRuleChangesOnlyTies) {
    use(mixed_scene());
    const Camera camera = look({0.5, 1.5, 6.0}, {0.2, 0.2, 0.1});
    const Image kept = draw(camera);
    rasterizer_->draw(camera, kSize, 0xffffffffu, TieRule::dropped);
    const Image dropped = rasterizer_->read_image();
    EXPECT_EQ(dropped.object, kept.object);
    EXPECT_EQ(dropped.depth, kept.depth);
    // Doubled: only the other copy may show.
    Scene doubled = mixed_scene();
    for (const Object& object : mixed_scene().objects) {
        Object copy = object;
        copy.name += " again";
        add_object(doubled, copy);
    }
    use(std::move(doubled));
    EXPECT_EQ(draw(camera).object, kept.object);
    rasterizer_->draw(camera, kSize, 0xffffffffu, TieRule::dropped);
    EXPECT_EQ(rasterizer_->read_image().depth, kept.depth);
}

TEST_F(RasterizerTest, PrimitivesAreNumberedAsTheTracerNumbersThem) {
    use(mixed_scene());
    const Camera camera = look({0.5, 1.5, 6.0}, {0.2, 0.2, 0.1});
    const Image image = draw(camera);
    const auto hits = first_hits(*accel_, camera, kSize);
    std::size_t same = 0;
    std::size_t hit_count = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid() || hits[i].object != image.object[i]) continue;
        ++hit_count;
        if (hits[i].primitive == image.primitive[i]) ++same;
    }
    EXPECT_GT(same, hit_count * 995 / 1000);
}

TEST_F(RasterizerTest, MeshesInSeveralDrawsLookTheSame) {
    const Mesh mesh = sheet(20, true);
    const auto whole = upload_mesh(mesh, 1 << 16);
    const auto parts = upload_mesh(mesh, 64);
    EXPECT_EQ(whole->chunks().size(), 1u);
    ASSERT_GT(parts->chunks().size(), 8u);
    std::uint32_t next = 0;
    for (const GpuMesh::Chunk& chunk : parts->chunks()) {
        EXPECT_EQ(chunk.first, next);
        next += chunk.count;
    }
    EXPECT_EQ(next, mesh.triangles.size());
    EXPECT_NO_THROW(check_gl("uploading"));
}

TEST_F(RasterizerTest, MovedObjectsKeepTheirMeshesAndNewPartsAreSeen) {
    Scene scene = mixed_scene();
    use(scene);
    const Camera camera = look({0.5, 1.5, 6.0}, {0.2, 0.2, 0.1});
    const Image before = draw(camera);
    scene.objects[5].world_from_object =
        translate({0.0, -0.8, 0.0}) * scene.objects[5].world_from_object;
    scene.meshes[0].parts = {{0, 288, 2}};
    use(scene);
    agree(camera);
    const Image after = draw(camera);
    EXPECT_NE(before.object, after.object);
    const auto hits = first_hits(*accel_, camera, kSize);
    const auto lights = effective_lights(*scene_, camera);
    RayCounts counts;
    for (int row = 0; row < kSize.rows; row += 3) {
        for (int col = 0; col < kSize.cols; col += 3) {
            const std::size_t i = kSize.index({row, col});
            if (hits[i].object != scene.objects[5].id || after.object[i] != hits[i].object ||
                after.primitive[i] != hits[i].primitive) {
                continue;
            }
            const TracedRay traced = trace(*accel_, lights, local_light(),
                                           camera_ray(camera, kSize, Pixel{row, col}), counts);
            EXPECT_LT(glm::length(traced.colour - after.colour[i]), 1e-2f) << row << ' ' << col;
        }
    }
}

TEST_F(RasterizerTest, ASceneWithoutLightsHasAHeadlight) {
    Scene scene = mixed_scene();
    scene.lights.clear();
    use(std::move(scene));
    const Camera camera = look({0.5, 1.5, 6.0}, {0.2, 0.2, 0.1});
    const Image image = draw(camera);
    RayCounts counts;
    const Pixel middle{kSize.rows / 2, kSize.cols / 2};
    const TracedRay traced = trace(*accel_, effective_lights(*scene_, camera), local_light(),
                                   camera_ray(camera, kSize, middle), counts);
    ASSERT_TRUE(traced.hit.valid());
    EXPECT_LT(glm::length(traced.colour - image.colour[kSize.index(middle)]), 1e-3f);
}

TEST_F(RasterizerTest, ImpossibleSizesAreRefused) {
    use(mixed_scene());
    const Camera camera = look({0.5, 1.5, 6.0}, {0, 0, 0});
    EXPECT_THROW(draw(camera, {0, 10}), Error);
    EXPECT_THROW(draw(camera, {10, 1 << 24}), Error);
    EXPECT_NO_THROW(draw(camera, {1, 1}));
}

// A frame on a framebuffer of our own, as bytes with row 0 on top.
class PresenterTest : public GlTest {
protected:
    struct Bytes {
        std::vector<std::array<std::uint8_t, 4>> texels;
        ImageSize size;
        [[nodiscard]] std::array<std::uint8_t, 4> at(int row, int col) const {
            return texels[size.index({row, col})];
        }
    };

    static Bytes present(Presenter& presenter, ImageSize framebuffer_size, const ViewRect& view,
                         std::span<const ObjectId> selected, ObjectId hovered,
                         const OutlineStyle& style = {}) {
        const GlTexture target =
            make_texture({GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE}, framebuffer_size);
        const GLuint names[] = {target.name()};
        const Framebuffer framebuffer = make_framebuffer(names);
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT);
        presenter.present(presenter.colour_texture(), presenter.object_texture(), view,
                          framebuffer_size.rows, selected, hovered, style);
        Bytes upside_down{std::vector<std::array<std::uint8_t, 4>>(framebuffer_size.pixel_count()),
                          framebuffer_size};
        glReadPixels(0, 0, framebuffer_size.cols, framebuffer_size.rows, GL_RGBA, GL_UNSIGNED_BYTE,
                     upside_down.texels.data());
        Bytes bytes = upside_down;
        for (int row = 0; row < framebuffer_size.rows; ++row) {
            for (int col = 0; col < framebuffer_size.cols; ++col) {
                bytes.texels[framebuffer_size.index({row, col})] =
                    upside_down.at(framebuffer_size.rows - 1 - row, col);
            }
        }
        return bytes;
    }
};

constexpr std::array<std::uint8_t, 4> kSelected{255, 140, 13, 255};
constexpr std::array<std::uint8_t, 4> kHovered{255, 255, 255, 255};

TEST_F(PresenterTest, ShowsThePngsBytes) {
    const ImageSize size{7, 11};
    Image image = make_image(size);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(-0.1f, 1.3f);
    for (glm::vec3& colour : image.colour) {
        colour = {value(random), value(random), 0.01f * value(random)};
    }
    image.colour[3].x = std::numeric_limits<float>::quiet_NaN();
    Presenter presenter;
    presenter.upload(image);
    // In the middle of a larger framebuffer: nothing around it may change.
    const ViewRect view{{3, 5}, size};
    const Bytes bytes = present(presenter, {13, 19}, view, {}, kNoObject);
    for (int row = 0; row < 13; ++row) {
        for (int col = 0; col < 19; ++col) {
            const Pixel p{row - 3, col - 5};
            const auto got = bytes.at(row, col);
            if (!size.contains(p)) {
                EXPECT_EQ(got, (std::array<std::uint8_t, 4>{0, 0, 0, 0})) << row << " " << col;
                continue;
            }
            const glm::vec3 colour = image.colour[size.index(p)];
            EXPECT_NEAR(got[0], srgb_byte(colour.x), 1) << row << " " << col;
            EXPECT_NEAR(got[1], srgb_byte(colour.y), 1) << row << " " << col;
            EXPECT_NEAR(got[2], srgb_byte(colour.z), 1) << row << " " << col;
        }
    }
}

TEST_F(PresenterTest, OutlinesWhatIsSelectedAndHovered) {
    const ImageSize size{20, 30};
    Image image = make_image(size);
    for (int row = 5; row < 15; ++row) {
        for (int col = 4; col < 12; ++col)
            image.object[size.index({row, col})] = 70000;
        for (int col = 18; col < 26; ++col)
            image.object[size.index({row, col})] = 3;
    }
    Presenter presenter;
    presenter.upload(image);
    OutlineStyle style;
    style.width = 1.0f;
    const ObjectId selected[] = {70000, 5, 900000000};  // not in order, not all there
    const Bytes bytes = present(presenter, size, {{0, 0}, size}, selected, 3, style);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            const bool beside_rows = row >= 5 && row < 15;
            const auto on_rim = [&](int first, int last) {
                return (beside_rows && (col == first - 1 || col == last)) ||
                       ((row == 4 || row == 15) && col >= first && col < last);
            };
            const auto expected = on_rim(4, 12)    ? kSelected
                                  : on_rim(18, 26) ? kHovered
                                                   : std::array<std::uint8_t, 4>{0, 0, 0, 255};
            EXPECT_EQ(bytes.at(row, col), expected) << row << " " << col;
        }
    }
}

TEST_F(PresenterTest, OutlinesEndAtTheViewsEdge) {
    const ImageSize size{9, 9};
    Image image = make_image(size);
    for (int row = 0; row < 5; ++row) {
        for (int col = 0; col < 5; ++col)
            image.object[size.index({row, col})] = 1;
    }
    Presenter presenter;
    presenter.upload(image);
    const ObjectId selected[] = {1};
    OutlineStyle style;
    style.width = 2.0f;
    const Bytes bytes = present(presenter, {15, 15}, {{3, 3}, size}, selected, kNoObject, style);
    for (int row = 0; row < 15; ++row) {
        for (int col = 0; col < 15; ++col) {
            const Pixel p{row - 3, col - 3};
            if (!size.contains(p)) {
                EXPECT_EQ(bytes.at(row, col)[3], 0) << row << " " << col;
            }
        }
    }
    EXPECT_EQ(bytes.at(3, 3 + 5), kSelected);
    EXPECT_EQ(bytes.at(3, 3 + 6), kSelected);
    EXPECT_NE(bytes.at(3, 3 + 7), kSelected);
    EXPECT_NE(bytes.at(3, 3 + 8), kSelected);  // not wrapped around
    EXPECT_NE(bytes.at(3 + 8, 3), kSelected);
    EXPECT_EQ(bytes.at(3 + 5, 3), kSelected);
}

TEST_F(PresenterTest, CoarseFramesFillTheView) {
    Image image = make_image({2, 2});
    image.colour = {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(1, 1, 1)};
    Presenter presenter;
    presenter.upload(image);
    const Bytes bytes = present(presenter, {10, 6}, {{0, 0}, {10, 6}}, {}, kNoObject);
    EXPECT_EQ(bytes.at(0, 0), (std::array<std::uint8_t, 4>{255, 0, 0, 255}));
    EXPECT_EQ(bytes.at(4, 5), (std::array<std::uint8_t, 4>{0, 255, 0, 255}));
    EXPECT_EQ(bytes.at(5, 2), (std::array<std::uint8_t, 4>{0, 0, 255, 255}));
    EXPECT_EQ(bytes.at(9, 3), (std::array<std::uint8_t, 4>{255, 255, 255, 255}));
}

TEST_F(PresenterTest, BlocksLookLikeTheSameImageInFull) {
    for (const ImageSize size : {ImageSize{10, 6}, ImageSize{23, 31}, ImageSize{5, 64}}) {
        for (const int step : {1, 2, 3, 7, 16}) {
            SCOPED_TRACE(testing::Message() << size.rows << " x " << size.cols << " by " << step);
            FrameSnapshot frame;
            frame.size = size;
            frame.step = step;
            frame.image =
                make_image({(size.rows + step - 1) / step, (size.cols + step - 1) / step});
            for (std::size_t i = 0; i < frame.image.colour.size(); ++i) {
                frame.image.colour[i] = glm::vec3(0.001f * static_cast<float>(i), 0.5f, 0.1f);
                frame.image.object[i] = static_cast<ObjectId>(i % 3);
            }
            Presenter presenter;
            const ObjectId selected[] = {1};
            const ViewRect view{{2, 3}, size};
            const ImageSize framebuffer{size.rows + 4, size.cols + 5};
            presenter.upload(frame.image, step);
            const Bytes blocks = present(presenter, framebuffer, view, selected, kNoObject);
            const Bytes plain_blocks = present(presenter, framebuffer, view, {}, kNoObject);
            presenter.upload(frame.whole());
            EXPECT_EQ(blocks.texels,
                      present(presenter, framebuffer, view, selected, kNoObject).texels);
            EXPECT_EQ(plain_blocks.texels,
                      present(presenter, framebuffer, view, {}, kNoObject).texels);
            EXPECT_NE(plain_blocks.at(2, 3), plain_blocks.at(1, 3)) << "nothing was drawn";
        }
    }
}

}  // namespace
}  // namespace raypick
