// The raster view's textures against the traced image without shadows and further rays: every map,
// wrap and filter, from near and far; cut-outs by ids.
#include "tests/look_fixture.h"
#include "viewer/raster/gpu_textures.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace raypick {
namespace {

// Random bytes, in the channels' middle range unless `full`.
std::shared_ptr<const TexturePixels> noise(int rows, int cols, TexelCoding coding,
                                           std::uint64_t seed) {
    std::vector<glm::u8vec4> texels;
    Random random(seed);
    for (int i = 0; i < rows * cols; ++i) {
        texels.emplace_back(random.below(256), random.below(256), random.below(256),
                            random.below(256));
    }
    return make_texture_pixels(rows, cols, std::move(texels), coding);
}

TextureId add_image(Scene& scene, std::shared_ptr<const TexturePixels> pixels) {
    return add_texture(scene, Texture{"image", ImageTexture{std::move(pixels), {}}});
}

TextureId add_checker(Scene& scene) {
    return add_texture(
        scene, Texture{"checker", Checker{{0.9f, 0.8f, 0.7f, 1.0f}, {0.1f, 0.2f, 0.15f, 1.0f}}});
}

Material matte() {
    Material m;
    m.ambient = m.diffuse = glm::vec3(0.8f);
    m.specular = glm::vec3(0.5f);
    m.shininess = 20.0f;
    return m;
}

// A square of two triangles over [-1, 1]^2 in x and z, facing up, its uv over [0, 1]^2 sheared.
MeshData square_data() {
    MeshData data;
    data.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    data.normals = {4, {0, 1, 0}};
    data.uvs = {{0, 0}, {1, 0.1f}, {1.2f, 1}, {0.1f, 1}};
    data.triangles = {{0, 1, 2}, {0, 2, 3}};
    return data;
}

void add_lamps(Scene& scene) {
    scene.lights.emplace_back(PointLight{"", {2.0, 4.0, 3.0}, glm::vec3(0.7f)});
    scene.lights.emplace_back(DirectionalLight{"", {0.5, -1.0, 0.2}, glm::vec3(0.4f)});
}

// Textured things of each kind of surface.
Scene still_life(Scene scene, MaterialId material) {
    place(scene, Plane{{0.0, 1.0, 0.0}, 1.0}, material);
    place(scene, Sphere{{-1.0, 0.0, 0.0}, 0.9}, material, rotate(20, {1, 0.3, 0}));
    place(scene, Box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, material,
          translate({1.2, -0.2, 0.3}) * rotate(35, {0.2, 1, 0.1}) * scale({1.0, 1.4, 0.8}));
    place_mesh(scene, square_data(), material,
               translate({0.3, 1.0, -0.8}) * rotate(65, {1, 0.2, 0}) * scale({1.2, 1.0, -0.7}));
    add_lamps(scene);
    return scene;
}

const Camera kView = camera_at({0.4, 1.6, 4.5}, {0.1, 0.1, 0.0});

TextureMap map_of(TextureId texture) {
    TextureMap map;
    map.texture = texture;
    return map;
}

// --- Each map -----------------------------------------------------------------------------------

struct SlotCase {
    const char* name;
    MapSlot slot;
};

class MapSlotTest : public LookTest, public ::testing::WithParamInterface<SlotCase> {};

TEST_P(MapSlotTest, LooksAsTraced) {
    Scene scene;
    const bool colour = GetParam().slot != MapSlot::normal && GetParam().slot != MapSlot::opacity;
    TextureMap map =
        map_of(add_image(scene, noise(5, 6, colour ? TexelCoding::srgb : TexelCoding::linear, 3)));
    Material m = matte();
    m.emissive = GetParam().slot == MapSlot::emissive ? glm::vec3(0.4f) : glm::vec3(0.0f);
    m.alpha_mode = AlphaMode::blend;
    m.opacity = 0.9f;
    map.channel = 2;
    map.base = GetParam().slot == MapSlot::opacity ? 0.1f : 0.0f;
    map.gain = 0.8f;
    m.map(GetParam().slot) = map;
    const MaterialId id = add_material(scene, m);
    agree(still_life(std::move(scene), id), kView, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Slots, MapSlotTest,
                         ::testing::Values(SlotCase{"diffuse", MapSlot::diffuse},
                                           SlotCase{"ambient", MapSlot::ambient},
                                           SlotCase{"specular", MapSlot::specular},
                                           SlotCase{"shininess", MapSlot::shininess},
                                           SlotCase{"opacity", MapSlot::opacity},
                                           SlotCase{"emissive", MapSlot::emissive},
                                           SlotCase{"normal", MapSlot::normal}),
                         [](const auto& test) { return std::string(test.param.name); });

// Where a map would leave an exponent below 1 it is 1, in both.
TEST_F(LookTest, ExponentsByTheirLogarithmAndNoneBelowOne) {
    for (const TexelCoding coding : {TexelCoding::logarithmic, TexelCoding::linear}) {
        Scene scene;
        Material m = matte();
        m.diffuse = glm::vec3(0.1f);
        m.shininess = coding == TexelCoding::logarithmic ? kLogarithmicSpan : 2.0f;
        m.map(MapSlot::shininess) = map_of(add_image(scene, noise(3, 3, coding, 5)));
        const MaterialId id = add_material(scene, m);
        agree(still_life(std::move(scene), id), kView, 2e-3);
    }
}

TEST_F(LookTest, EveryMapAtOnceWithTransformsAndRanges) {
    Scene scene;
    Material m = matte();
    m.emissive = glm::vec3(0.1f);
    std::uint64_t seed = 0;
    for (const MapSlot slot : {MapSlot::diffuse, MapSlot::ambient, MapSlot::specular,
                               MapSlot::shininess, MapSlot::emissive, MapSlot::normal}) {
        TextureMap map = map_of(add_image(scene, noise(4, 7, TexelCoding::linear, ++seed)));
        map.u_row = {1.3f, 0.2f * static_cast<float>(seed), 0.3f};
        map.v_row = {-0.4f, 0.9f, -0.2f};
        map.base = 0.2f;
        map.gain = 0.6f;
        map.channel = static_cast<int>(seed % 4);
        m.map(slot) = map;
    }
    const MaterialId id = add_material(scene, m);
    agree(still_life(std::move(scene), id), kView, 2e-3);
}

// Nothing but shapes: drawing them binds no texture of their own.
TEST_F(LookTest, ShapesWithoutAnyMeshHaveTheirTexture) {
    Scene scene;
    Material m = matte();
    m.map(MapSlot::diffuse) = map_of(add_image(scene, noise(5, 6, TexelCoding::srgb, 8)));
    const MaterialId id = add_material(scene, m);
    place(scene, Plane{{0.0, 1.0, 0.0}, 1.0}, id);
    place(scene, Sphere{{-1.0, 0.0, 0.0}, 0.9}, id);
    place(scene, Rectangle{{0.2, -0.8, 0.4}, {1.4, 0.2, -0.5}, {0.1, 1.6, -0.2}}, id);
    add_lamps(scene);
    agree(std::move(scene), kView, 2e-3);
}

// --- Wraps and filters --------------------------------------------------------------------------

using SamplerCase = std::tuple<Wrap, Wrap, TextureFilter, TexelCoding>;
class SamplerTest : public LookTest, public ::testing::WithParamInterface<SamplerCase> {};

TEST_P(SamplerTest, NearAndFar) {
    const auto& [wrap_u, wrap_v, filter, coding] = GetParam();
    for (const int texels : {3, 200}) {
        Scene scene;
        TextureMap map = map_of(add_image(scene, noise(texels, texels + 2, coding, 9)));
        map.wrap_u = wrap_u;
        map.wrap_v = wrap_v;
        map.filter = filter;
        map.u_row = {2.5f, 0.0f, -0.7f};
        map.v_row = {0.0f, 2.5f, -0.6f};
        Material m = matte();
        m.map(MapSlot::diffuse) = map;
        const MaterialId id = add_material(scene, m);
        // Where the filter is `nearest` every texel has an edge.
        const bool edges = filter == TextureFilter::nearest;
        agree(still_life(std::move(scene), id), kView, edges ? 5e-3 : 3e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Samplers, SamplerTest,
    ::testing::Values(
        SamplerCase{Wrap::repeat, Wrap::repeat, TextureFilter::linear, TexelCoding::srgb},
        SamplerCase{Wrap::clamp, Wrap::mirror, TextureFilter::linear, TexelCoding::srgb},
        SamplerCase{Wrap::mirror, Wrap::clamp, TextureFilter::linear, TexelCoding::linear},
        SamplerCase{Wrap::repeat, Wrap::mirror, TextureFilter::linear, TexelCoding::logarithmic},
        SamplerCase{Wrap::repeat, Wrap::repeat, TextureFilter::nearest, TexelCoding::srgb},
        SamplerCase{Wrap::clamp, Wrap::mirror, TextureFilter::nearest, TexelCoding::linear},
        SamplerCase{Wrap::mirror, Wrap::clamp, TextureFilter::nearest, TexelCoding::srgb}));

TEST_F(LookTest, DistantCheckersAreGreyInBothPictures) {
    Scene scene;
    Material m = matte();
    m.map(MapSlot::diffuse) = map_of(add_checker(scene));
    place(scene, Plane{{0.0, 1.0, 0.0}, 1.0}, add_material(scene, m));
    scene.lights.emplace_back(DirectionalLight{"", {0.1, -1.0, 0.2}, glm::vec3(0.9f)});
    // From the squares at the feet to the horizon.
    agree(std::move(scene), camera_at({0.3, 0.2, 0.4}, {4.0, -0.2, 10.0}), 3e-3);
}

TEST_F(LookTest, CheckersOnEveryShape) {
    Scene scene;
    Material m = matte();
    TextureMap map = map_of(add_checker(scene));
    map.u_row = {4.0f, 1.0f, 0.2f};
    map.v_row = {-1.0f, 4.0f, 0.1f};
    m.map(MapSlot::diffuse) = map;
    m.map(MapSlot::specular) = map;
    const MaterialId id = add_material(scene, m);
    agree(still_life(std::move(scene), id), kView, 5e-3);
}

TEST_F(LookTest, OrthographicViewsHaveFootprintsOfOneSize) {
    for (const int texels : {4, 300}) {
        Scene scene;
        Material m = matte();
        m.map(MapSlot::diffuse) =
            map_of(add_image(scene, noise(texels, texels, TexelCoding::srgb, 4)));
        const MaterialId id = add_material(scene, m);
        Camera camera = kView;
        camera.projection = Projection::orthographic;
        camera.height = 4.0;
        agree(still_life(std::move(scene), id), camera, 5e-3);
    }
}

TEST_F(LookTest, PlainAndTexturedObjectsSideBySide) {
    Scene scene;
    Material m = matte();
    m.map(MapSlot::diffuse) = map_of(add_checker(scene));
    const MaterialId checked = add_material(scene, m);
    const MaterialId plain = add_material(scene, matte());
    scene = still_life(std::move(scene), plain);
    scene.objects[1].material = checked;
    // A mesh of two materials: only one of them has a map.
    scene.meshes[0].parts = {{0, 1, plain}, {1, 1, checked}};
    scene.objects[3].material = kNoMaterial;
    agree(std::move(scene), kView, 3e-3);
}

TEST_F(LookTest, NormalMapsNeedTextureCoordinates) {
    Scene scene;
    Material m = matte();
    m.map(MapSlot::normal) = map_of(add_image(scene, noise(4, 4, TexelCoding::linear, 5)));
    const MaterialId id = add_material(scene, m);
    MeshData data = ball_data(2);
    data.normals = data.positions;
    place_mesh(scene, std::move(data), id);  // no uv: the map is ignored
    MeshData square = square_data();
    square.uvs.assign(4, glm::vec2(0.3f));  // no plane to speak of
    place_mesh(scene, std::move(square), id, translate({0, -1, 0}) * scale(glm::dvec3(3.0)));
    add_lamps(scene);
    agree(std::move(scene), camera_at({0.4, 2.6, 3.5}, {0.0, -0.3, 0.0}), 2e-3);
}

// --- Cut-outs -----------------------------------------------------------------------------------

// A map whose holes are what the tests look through.
Scene with_holes(TextureFilter filter, AlphaMode mode) {
    Scene scene;
    std::vector<glm::u8vec4> texels;
    Random random(21);
    for (int i = 0; i < 12 * 12; ++i) {
        const auto alpha = static_cast<std::uint8_t>(random.below(2) * 255);
        texels.emplace_back(200, 120, 60, alpha);
    }
    TextureMap map =
        map_of(add_image(scene, make_texture_pixels(12, 12, std::move(texels), TexelCoding::srgb)));
    map.filter = filter;
    map.channel = 3;
    Material m = matte();
    m.alpha_mode = mode;
    m.map(MapSlot::opacity) = map;
    const MaterialId holes = add_material(scene, m);
    const MaterialId backdrop = add_material(scene, matte());
    scene = still_life(std::move(scene), holes);
    place(scene, Plane{{0.0, 0.0, 1.0}, 3.0}, backdrop);
    place(scene, Sphere{{-1.0, 0.0, 0.0}, 0.4}, backdrop);
    return scene;
}

class CutOutTest : public LookTest,
                   public ::testing::WithParamInterface<std::tuple<TextureFilter, AlphaMode>> {};

TEST_P(CutOutTest, IdsAreThePicks) {
    const auto& [filter, mode] = GetParam();
    constexpr ImageSize kSize{211, 317};
    const Scene scene = with_holes(filter, mode);
    for (const Camera& camera : {kView, camera_at({-2.0, 0.6, 2.5}, {-0.4, 0.0, 0.0})}) {
        const Pictures pictures = both(scene, camera, kSize);
        const Agreement result = compare(*accel_, camera, pictures.raster);
        fmt::print("    {}\n", result.summary());
        EXPECT_EQ(result.uniform_differ, 0u) << result.summary();
        EXPECT_LE(result.edge_share(), 0.005) << result.summary();
        EXPECT_GE(result.objects, 5u);
        // Without its holes the scene shows other things.
        Scene closed = scene;
        closed.materials[0].map(MapSlot::opacity) = {};
        const Image whole = both(closed, camera, kSize).raster;
        std::size_t through = 0;
        for (std::size_t i = 0; i < whole.object.size(); ++i) {
            if (whole.object[i] != pictures.raster.object[i]) ++through;
        }
        EXPECT_GT(through, whole.object.size() / 100);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Modes, CutOutTest,
    ::testing::Combine(::testing::Values(TextureFilter::linear, TextureFilter::nearest),
                       ::testing::Values(AlphaMode::cut_out, AlphaMode::blend)));

TEST_F(LookTest, MaterialsBelowTheirCutOffAreNotThere) {
    Scene scene;
    Material m = matte();
    m.opacity = 0.3f;
    const MaterialId hidden = add_material(scene, m);
    place(scene, Sphere{{0, 0, 0}, 1.0}, hidden);
    const ObjectId behind = place(scene, Plane{{0, 0, 1}, 2.0}, add_material(scene, matte()));
    add_lamps(scene);
    const Pictures pictures = both(std::move(scene), camera_at({0, 0, 5}, {0, 0, 0}));
    for (const ObjectId id : pictures.raster.object)
        ASSERT_EQ(id, behind);
    EXPECT_EQ(pictures.traced.object, pictures.raster.object);
}

// --- Too many texels ----------------------------------------------------------------------------

TEST_F(LookTest, TexturesBeyondTheGpusLimitLoseTheirFinestLevels) {
    const auto small = noise(8, 8, TexelCoding::srgb, 1);      // 64 + 16 + 4 + 1
    const auto large = noise(64, 64, TexelCoding::linear, 2);  // 4096 + 1024 + ...
    const std::vector<Texture> textures{{"a", ImageTexture{large, {}}},
                                        {"b", ImageTexture{small, {}}},
                                        {"c", ImageTexture{large, {}}}};
    const GpuTextures all = pack_textures(textures, 5461 + 85);
    EXPECT_EQ(all.warning, "");
    const GpuTextures fewer = pack_textures(textures, 1500);
    EXPECT_NE(fewer.warning.find("1 finest level"), std::string::npos) << fewer.warning;
    const auto bytes_of = [](const BufferTexture& texture) {
        GLint bytes = 0;
        glBindBuffer(GL_TEXTURE_BUFFER, texture.buffer());
        glGetBufferParameteriv(GL_TEXTURE_BUFFER, GL_BUFFER_SIZE, &bytes);
        glBindBuffer(GL_TEXTURE_BUFFER, 0);
        return bytes;
    };
    EXPECT_EQ(bytes_of(all.texels), 4 * (5461 + 85));  // the large image is there once
    EXPECT_EQ(bytes_of(fewer.texels), 4 * (1365 + 85));
    EXPECT_EQ(bytes_of(all.table) - bytes_of(fewer.table), 16);
}

TEST_F(LookTest, TexturesStayOnTheGpuWhenTheSceneIsEdited) {
    Scene scene;
    add_image(scene, noise(8, 8, TexelCoding::srgb, 1));
    add_checker(scene);
    const auto first = upload_textures(scene, nullptr);
    scene.lights.emplace_back(PointLight{});
    EXPECT_EQ(upload_textures(scene, first), first);
    std::get<Checker>(scene.textures[1].source).odd.x += 0.5f;
    const auto second = upload_textures(scene, first);
    EXPECT_NE(second, first);
    scene.textures[0] = Texture{"image", ImageTexture{noise(8, 8, TexelCoding::srgb, 1), {}}};
    EXPECT_NE(upload_textures(scene, second), second);
}

}  // namespace
}  // namespace raypick
