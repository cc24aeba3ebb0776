// Shapes that OpenGL draws by casting each pixel's ray: ids, primitives, distances and looks are
// the tracer's, for turned, stretched, mirrored and sheared instances, from far and from inside.
#include "tests/look_fixture.h"
#include "viewer/gl/load_gl.h"
#include "viewer/raster/gpu_scene.h"

#include <array>
#include <cmath>

namespace raypick {
namespace {

constexpr ImageSize kSize{67, 91};
constexpr ImageSize kLookSize{101, 139};  // one pixel on a texture's edge is less of it

Transform sheared(double xy, double zy) {
    Transform map;
    map.linear[1][0] = xy;  // x grows with y
    map.linear[1][2] = zy;
    return map;
}

// Two materials in turn, three elements each.
std::vector<Part> striped(std::uint32_t count) {
    std::vector<Part> parts;
    for (std::uint32_t first = 0; first < count; first += 3)
        parts.push_back({first, std::min(3u, count - first), first / 3 % 2});
    return parts;
}

Shape add_spheres(Scene& scene, std::uint32_t count) {
    Random random(count);
    std::vector<glm::vec4> spheres;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 centre(random.point(glm::dvec3(-1.0), glm::dvec3(1.0)));
        spheres.emplace_back(centre, static_cast<float>(random.between(0.05, 0.5)));
    }
    return SphereSetInstance{
        add_sphere_set(scene, make_sphere_set("spheres", std::move(spheres), striped(count)))};
}

// Cylinders, whole and truncated cones, slim and flat.
Shape add_cones(Scene& scene, std::uint32_t count, bool capped) {
    Random random(count);
    std::vector<glm::vec4> ends;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 base = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        const glm::dvec3 apex = base + random.between(0.1, 1.2) * random.direction();
        const double base_radius = random.between(0.02, 0.4);
        const double apex_radius = i % 3 == 0   ? 0.0
                                   : i % 3 == 1 ? base_radius
                                                : random.between(0.02, 0.4);
        ends.emplace_back(glm::vec3(base), static_cast<float>(base_radius));
        ends.emplace_back(glm::vec3(apex), static_cast<float>(apex_radius));
    }
    return ConeSetInstance{
        add_cone_set(scene, make_cone_set("cones", std::move(ends), capped, striped(count)))};
}

// A shape of each kind, about 2 wide around 0.
struct NamedShape {
    const char* name;
    Shape (*add)(Scene& scene);
};

const NamedShape kShapes[] = {
    {"disk",
     [](Scene&) -> Shape {
         return Disk{{0.1, 0.05, -0.1}, {0.3, 2.0, 0.4}, 1.1, 0.0};
     }},
    {"ring",
     [](Scene&) -> Shape {
         return Disk{{0.0, 0.1, 0.1}, {-0.2, 0.5, 1.0}, 1.2, 0.55};
     }},
    {"rectangle",
     [](Scene&) -> Shape {
         return Rectangle{{-1.0, -0.4, 0.8}, {1.9, 0.3, 0.2}, {0.3, 0.9, -1.4}};
     }},
    {"cylinder",
     [](Scene&) -> Shape {
         return Cone{{-0.3, -0.8, 0.2}, {0.4, 0.9, -0.3}, 0.7, 0.7, true};
     }},
    {"pipe",
     [](Scene&) -> Shape {
         return Cone{{-0.6, 0.3, 0.2}, {0.7, 0.1, -0.5}, 0.8, 0.8, false};
     }},
    {"whole_cone",
     [](Scene&) -> Shape {
         return Cone{{0.1, -0.8, 0.3}, {-0.2, 1.3, -0.2}, 1.0, 0.0, true};
     }},
    {"open_whole_cone",
     [](Scene&) -> Shape {
         return Cone{{0.6, 0.5, 0.9}, {-0.4, -0.2, -0.3}, 0.0, 1.0, false};
     }},
    {"truncated_cone",
     [](Scene&) -> Shape {
         return Cone{{0.2, 0.7, 0.1}, {-0.1, -0.6, 0.2}, 0.5, 1.1, true};
     }},
    {"flat_lamp_shade",
     [](Scene&) -> Shape {
         return Cone{{0.0, 0.1, 0.0}, {0.05, -0.2, 0.1}, 1.2, 0.6, false};
     }},
    {"torus",
     [](Scene&) -> Shape {
         return Torus{{0.0, 0.1, 0.05}, {0.3, 1.2, 0.5}, 0.8, 0.3};
     }},
    {"thin_torus",
     [](Scene&) -> Shape {
         return Torus{{0.1, 0.0, 0.0}, {1.0, 0.4, 0.6}, 1.1, 0.03};
     }},
    {"closed_torus",
     [](Scene&) -> Shape {
         return Torus{{0.0, 0.0, 0.1}, {0.2, -0.3, 1.0}, 0.6, 0.6};
     }},
    {"spheres", [](Scene& scene) -> Shape { return add_spheres(scene, 40); }},
    {"open_cones", [](Scene& scene) -> Shape { return add_cones(scene, 30, false); }},
    {"capped_cones", [](Scene& scene) -> Shape { return add_cones(scene, 30, true); }},
};

Material painted(const glm::vec3& colour) {
    Material m;
    m.ambient = m.diffuse = colour;
    m.specular = glm::vec3(0.4f);
    m.shininess = 25.0f;
    return m;
}

struct Paints {
    MaterialId first = kNoMaterial;
    MaterialId second = kNoMaterial;
};

// The shape as it is, turned, stretched, mirrored and sheared, over a floor.
Scene instances(Scene scene, const NamedShape& kind, const Paints& paints) {
    const Shape shape = kind.add(scene);
    place(scene, Plane{{0.0, 1.0, 0.0}, 2.2}, paints.second);
    // Sets have materials of their own.
    place(scene, shape, parts_of(scene, shape).empty() ? paints.first : kNoMaterial);
    place(scene, shape, paints.second,
          translate({2.3, 0.4, -0.8}) * rotate(70, {0.3, 1, 0.4}) * scale({1.1, 0.5, 0.8}));
    place(scene, shape, paints.second,
          translate({-2.2, -0.3, 0.4}) * rotate(-40, {1, 0.2, 0.1}) * scale({-0.7, 0.9, 1.0}));
    place(scene, shape, paints.first,
          translate({0.3, 1.4, -2.0}) * sheared(0.8, -0.3) * rotate(100, {1, 0.4, -0.2}));
    scene.lights.emplace_back(PointLight{"", {2.0, 4.0, 5.0}, glm::vec3(0.8f)});
    scene.lights.emplace_back(DirectionalLight{"", {0.5, -1.0, 0.2}, glm::vec3(0.3f)});
    return scene;
}

Scene plain_instances(const NamedShape& kind) {
    Scene scene;
    const Paints paints{add_material(scene, painted({0.8f, 0.3f, 0.2f})),
                        add_material(scene, painted({0.3f, 0.5f, 0.7f}))};
    return instances(std::move(scene), kind, paints);
}

Scene checked_instances(const NamedShape& kind) {
    Scene scene;
    const TextureId checker = add_texture(
        scene, Texture{"checker", Checker{{0.9f, 0.8f, 0.7f, 1.0f}, {0.1f, 0.2f, 0.15f, 0.0f}}});
    Material m = painted(glm::vec3(0.8f));
    m.map(MapSlot::diffuse).texture = checker;
    m.map(MapSlot::diffuse).u_row = {12.0f, 1.0f, 0.2f};
    m.map(MapSlot::diffuse).v_row = {-1.0f, 6.0f, 0.1f};
    const MaterialId fine = add_material(scene, m);
    m.map(MapSlot::diffuse).u_row.x = 5.0f;
    const MaterialId coarse = add_material(scene, m);
    return instances(std::move(scene), kind, {fine, coarse});
}

struct ViewPoint {
    const char* name;
    Camera camera;
};

Camera view_from(const glm::dvec3& eye, const glm::dvec3& at, double fovy = 45.0) {
    Camera camera = camera_at(eye, at);
    camera.fovy = fovy;
    camera.near = 0.01;
    return camera;
}

Camera parallel(Camera camera, double height) {
    camera.projection = Projection::orthographic;
    camera.height = height;
    return camera;
}

const ViewPoint kViews[] = {
    {"front", view_from({0.5, 1.4, 6.0}, {0.0, 0.1, 0.0})},
    {"above", view_from({1.0, 6.5, 1.5}, {0.0, 0.0, -0.3})},
    {"parallel", parallel(view_from({2.0, 1.5, 5.0}, {0.0, 0.2, 0.0}), 5.5)},
    {"far", view_from({90.0, 70.0, 150.0}, {0.0, 0.1, 0.0}, 1.8)},
    {"near", view_from({0.3, 0.9, 1.3}, {0.2, 0.0, 0.1}, 80.0)},
    {"inside", view_from({0.05, 0.12, 0.03}, {1.0, 0.3, -0.4}, 100.0)},
};

// For what does not depend on the distance: from the front, with parallel rays, from inside.
std::array<ViewPoint, 3> few_views() {
    return {kViews[0], kViews[2], kViews[5]};
}

// Pixels that show another primitive of the right object although no edge is near.
std::size_t wrong_primitives(const Image& traced, const Image& raster) {
    const auto ids_of = [](const Image& image) {
        return [&image](Pixel p) {
            const std::size_t i = image.size.index(p);
            return std::pair(image.object[i], image.primitive[i]);
        };
    };
    std::size_t wrong = 0;
    for (int row = 0; row < traced.size.rows; ++row) {
        for (int col = 0; col < traced.size.cols; ++col) {
            const Pixel p{row, col};
            if (ids_of(traced)(p) != ids_of(raster)(p) &&
                uniform_around(traced.size, p, ids_of(traced)) &&
                uniform_around(traced.size, p, ids_of(raster))) {
                ++wrong;
            }
        }
    }
    return wrong;
}

class ShapeTest : public LookTest, public ::testing::WithParamInterface<NamedShape> {
protected:
    Pictures expect_ids(const Scene& scene, const Camera& camera) {
        Pictures pictures = both(scene, camera, kSize);
        const Agreement result = compare(*accel_, camera, pictures.raster);
        EXPECT_EQ(result.uniform_differ, 0u) << result.summary();
        EXPECT_LE(result.edge_share(), 0.005) << result.summary();
        const std::size_t off = wrong_distances(camera, pictures.raster);
        EXPECT_LE(off, kSize.pixel_count() / 2000) << result.summary();
        EXPECT_EQ(wrong_primitives(pictures.traced, pictures.raster), 0u);
        return pictures;
    }

    // Pixels with the right ids at another distance: an open shape's rim may hide its other wall.
    [[nodiscard]] std::size_t wrong_distances(const Camera& camera, const Image& raster) const {
        const std::vector<Hit> hits = first_hits(*accel_, camera, kSize);
        const RayGenerator generator(camera, kSize);
        std::size_t wrong = 0;
        for (int row = 0; row < kSize.rows; ++row) {
            for (int col = 0; col < kSize.cols; ++col) {
                const std::size_t i = kSize.index({row, col});
                const Hit& hit = hits[i];
                if (!hit.valid() || raster.object[i] != hit.object ||
                    raster.primitive[i] != hit.primitive) {
                    continue;
                }
                // A parallel ray begins where rounding to float put it.
                const Ray ray = generator.ray(pixel_centre({row, col}));
                const bool is_parallel = camera.projection == Projection::orthographic;
                const float reach = hit.t + (is_parallel ? glm::length(ray.origin) : 0.0f);
                const double tolerance = 1e-5 * static_cast<double>(reach / hit.t);
                if (!(t_error(raster, {row, col}, generator, hit) < tolerance)) ++wrong;
            }
        }
        return wrong;
    }
};

TEST_P(ShapeTest, IdsArePicks) {
    const Scene scene = plain_instances(GetParam());
    for (const ViewPoint& view : kViews) {
        SCOPED_TRACE(view.name);
        const Pictures pictures = expect_ids(scene, view.camera);
        const std::vector<ObjectId>& shown = pictures.raster.object;
        EXPECT_GT(std::count(shown.begin(), shown.end(), 1u), 40);
    }
}

// Any map, any camera: also between the elements of a set, close to a surface, with a wide angle.
TEST_P(ShapeTest, IdsArePicksFromAnywhere) {
    for (int round = 0; round < 6; ++round) {
        SCOPED_TRACE(round);
        Random random(static_cast<std::uint64_t>(round));
        Scene scene;
        add_material(scene, painted({0.8f, 0.3f, 0.2f}));
        add_material(scene, painted({0.3f, 0.5f, 0.7f}));
        const Shape shape = GetParam().add(scene);
        const double size = std::exp2(random.between(-20.0, 20.0));
        for (int i = 0; i < 4; ++i) {
            const Transform map = translate(2.0 * random.point(glm::dvec3(-1.0), glm::dvec3(1.0))) *
                                  rotate(random.between(0.0, 360.0), random.direction()) *
                                  scale(random.point(glm::dvec3(-1.5), glm::dvec3(1.5))) *
                                  sheared(random.between(-1.0, 1.0), random.between(-1.0, 1.0));
            place(scene, shape, 0, scale(glm::dvec3(size)) * map);
        }
        const double distance = std::exp2(random.between(-4.0, 4.0));
        Camera camera = view_from(size * distance * random.direction(),
                                  size * random.point(glm::dvec3(-1.0), glm::dvec3(1.0)),
                                  random.between(20.0, 150.0));
        if (round % 3 == 2) camera = parallel(camera, size * random.between(0.3, 6.0));
        camera.near = size * (round % 2 == 0 ? 1e-3 : 0.3);
        expect_ids(scene, camera);
    }
}

TEST_P(ShapeTest, OnlySeenSidesAreThere) {
    Scene scene = plain_instances(GetParam());
    for (const Sides sides : {Sides::front_only, Sides::back_only}) {
        for (Object& object : scene.objects)
            object.sides = object.id == 0 ? Sides::both : sides;
        for (const ViewPoint& view : few_views()) {
            SCOPED_TRACE(view.name);
            expect_ids(scene, view.camera);
        }
    }
}

TEST_P(ShapeTest, HolesAreLookedThrough) {
    Scene scene = checked_instances(GetParam());
    scene.materials[0].map(MapSlot::opacity) = scene.materials[0].map(MapSlot::diffuse);
    scene.materials[0].map(MapSlot::opacity).channel = 3;
    scene.objects[0].material = add_material(scene, painted(glm::vec3(0.5f)));
    for (const ViewPoint& view : few_views()) {
        SCOPED_TRACE(view.name);
        expect_ids(scene, view.camera);
    }
}

// The bytes of a buffer, as elements.
template <typename T>
std::vector<T> read_buffer(const BufferTexture& texture) {
    GLint bytes = 0;
    glBindBuffer(GL_TEXTURE_BUFFER, texture.buffer());
    glGetBufferParameteriv(GL_TEXTURE_BUFFER, GL_BUFFER_SIZE, &bytes);
    std::vector<T> values(static_cast<std::size_t>(bytes) / sizeof(T));
    glGetBufferSubData(GL_TEXTURE_BUFFER, 0, bytes, values.data());
    glBindBuffer(GL_TEXTURE_BUFFER, 0);
    return values;
}

TEST_F(LookTest, SetsBeyondTheGpusLimitAreSpreadOverDraws) {
    Scene scene;
    add_cones(scene, 30, true);
    const GpuConeSet gpu = upload_cone_set(scene, 0, 9);  // four cones a draw
    ASSERT_EQ(gpu.chunks.size(), 8u);
    std::uint32_t next = 0;
    for (const SetChunk& chunk : gpu.chunks) {
        EXPECT_EQ(chunk.first, next);
        const auto ends = read_buffer<glm::vec4>(chunk.elements);
        const auto materials = read_buffer<MaterialId>(chunk.materials);
        ASSERT_EQ(ends.size(), std::size_t{2} * chunk.count);
        ASSERT_EQ(materials.size(), chunk.count);
        for (std::uint32_t i = 0; i < chunk.count; ++i, ++next) {
            EXPECT_EQ(ends[2 * i], scene.cone_sets[0].ends[2 * next]);
            EXPECT_EQ(ends[2 * i + 1], scene.cone_sets[0].ends[2 * next + 1]);
            EXPECT_EQ(materials[i], next / 3 % 2);
        }
    }
    EXPECT_EQ(next, 30u);
}

TEST_F(LookTest, SetsStayOnTheGpuWhenTheSceneIsEdited) {
    Scene scene;
    place(scene, add_spheres(scene, 5), add_material(scene, painted(glm::vec3(0.5f))));
    add_material(scene, painted(glm::vec3(0.4f)));
    const GpuScene first = upload_scene(std::make_shared<const Scene>(scene), {});
    scene.materials[0].diffuse = glm::vec3(0.9f);
    const GpuScene second = upload_scene(std::make_shared<const Scene>(scene), first);
    EXPECT_EQ(second.sphere_sets[0], first.sphere_sets[0]);
    scene.sphere_sets[0].parts[0].material = 1;
    const GpuScene third = upload_scene(std::make_shared<const Scene>(scene), second);
    EXPECT_NE(third.sphere_sets[0], second.sphere_sets[0]);
}

TEST_P(ShapeTest, LooksAsTraced) {
    for (const ViewPoint& view : few_views()) {
        SCOPED_TRACE(view.name);
        agree(plain_instances(GetParam()), view.camera, 2e-3, kLookSize);
    }
    for (const ViewPoint& view : kViews) {
        SCOPED_TRACE(view.name);
        agree(checked_instances(GetParam()), view.camera, 5e-3, kLookSize);
    }
}

// Normal maps follow the derivatives by u and v.
TEST_P(ShapeTest, NormalMapsLeanAsTraced) {
    Scene scene = checked_instances(GetParam());
    const TextureId slopes = add_texture(
        scene, Texture{"slopes", Checker{{0.7f, 0.4f, 0.9f, 1.0f}, {0.4f, 0.65f, 0.8f, 1.0f}}});
    for (Material& m : scene.materials) {
        m.map(MapSlot::normal) = m.map(MapSlot::diffuse);
        m.map(MapSlot::normal).texture = slopes;
        m.map(MapSlot::diffuse) = {};
    }
    for (const ViewPoint& view : few_views()) {
        SCOPED_TRACE(view.name);
        agree(scene, view.camera, 5e-3, kLookSize);
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, ShapeTest, ::testing::ValuesIn(kShapes),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace raypick
