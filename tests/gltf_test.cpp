// glTF 2.0 files: containers, accessors, the node tree, materials, cameras, lights, complaints.
#include "tracer/io/base64.h"

#include "model_files.h"

#include "tracer/error.h"
#include "tracer/io/save_scene.h"

#include <gmock/gmock.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace raypick {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;

std::string base64(std::string_view bytes) {
    constexpr std::string_view kAlphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const bool there = i + k < bytes.size();
            group = group << 8u | (there ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kAlphabet[group >> (18 - 6 * k) & 63u];
    }
    return text;
}

// A glTF file put together: JSON and one buffer.
class Model {
public:
    Json json = {{"asset", {{"version", "2.0"}}}};

    template <typename T>
    int view(const std::vector<T>& values) {
        while (buffer_.size() % 4 != 0)
            buffer_ += '\0';
        json["bufferViews"].push_back({{"buffer", 0},
                                       {"byteOffset", buffer_.size()},
                                       {"byteLength", values.size() * sizeof(T)}});
        for (const T value : values) {
            const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
            buffer_.append(raw.data(), raw.size());
        }
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }

    template <typename T>
    int accessor(const std::vector<T>& values, int component_type, const std::string& type,
                 bool normalized = false) {
        const std::size_t components = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : 3;
        json["accessors"].push_back({{"bufferView", view(values)},
                                     {"componentType", component_type},
                                     {"type", type},
                                     {"normalized", normalized},
                                     {"count", values.size() / components}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }

    int positions(const std::vector<float>& values) { return accessor(values, 5126, "VEC3"); }

    int mesh(const Json& primitives, const std::string& name = "") {
        Json mesh = {{"primitives", primitives}};
        if (!name.empty()) mesh["name"] = name;
        json["meshes"].push_back(mesh);
        return static_cast<int>(json["meshes"].size()) - 1;
    }

    int node(const Json& node) {
        json["nodes"].push_back(node);
        return static_cast<int>(json["nodes"].size()) - 1;
    }

    // With the buffer as a data URI.
    [[nodiscard]] std::string text() const {
        Json whole = json;
        whole["buffers"] = {{{"byteLength", buffer_.size()},
                             {"uri", "data:application/octet-stream;base64," + base64(buffer_)}}};
        return whole.dump();
    }

    [[nodiscard]] const std::string& buffer() const { return buffer_; }

    [[nodiscard]] std::string glb() const {
        Json whole = json;
        whole["buffers"] = {{{"byteLength", buffer_.size()}}};
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string binary = buffer_;
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        const std::size_t size = 12 + 8 + text.size() + 8 + binary.size();
        return "glTF" + word(2) + word(size) + word(text.size()) + "JSON" + text +
               word(binary.size()) + std::string("BIN\0", 4) + binary;
    }

    static std::string word(std::size_t value) {
        const auto raw = std::bit_cast<std::array<char, 4>>(static_cast<std::uint32_t>(value));
        return {raw.data(), raw.size()};
    }

private:
    std::string buffer_;
};

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

// Two triangles, mesh "sheet", no nodes yet.
Model square() {
    Model model;
    const int positions = model.positions(kSquare);
    const int indices = model.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, 5123, "SCALAR");
    model.mesh({{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}, "sheet");
    return model;
}

// The same, shown by one node.
Model placed_square() {
    Model model = square();
    model.node({{"mesh", 0}});
    return model;
}

class Gltf : public ModelFiles {
protected:
    LoadedScene load_model(const Model& model) { return load("a.gltf", model.text()); }
    std::string complaint_about(const Model& model) { return complaint("a.gltf", model.text()); }
};

// --- Containers ---------------------------------------------------------------------------------

TEST_F(Gltf, ReadsDataUrisFilesBesideItAndBinaries) {
    const Model model = placed_square();
    Json beside = model.json;
    write("sub dir/the buffer.bin", model.buffer());
    beside["buffers"] = {
        {{"byteLength", model.buffer().size()}, {"uri", "sub%20dir/the%20buffer.bin"}}};
    for (const std::filesystem::path& file :
         {write("a.gltf", model.text()), write("b.gltf", beside.dump()),
          write("c.glb", model.glb()), write("content decides", model.glb()),
          write("so it does here", model.text())}) {
        SCOPED_TRACE(file);
        const LoadedScene loaded = load_scene(file);
        EXPECT_THAT(loaded.warnings, IsEmpty());
        EXPECT_THAT(object_names(loaded.scene), ElementsAre("sheet"));
        ASSERT_EQ(placed_triangles(loaded.scene), 2u);
        EXPECT_EQ(corner(loaded.scene, 0, 1, 2), glm::dvec3(0, 1, 0));
    }
}

TEST(Base64, DecodesWhatTheStandardShows) {
    EXPECT_EQ(decode_base64("Zg=="), "f");
    EXPECT_EQ(decode_base64("Zm8="), "fo");
    EXPECT_EQ(decode_base64("Zm9vYmE"), "fooba");
    EXPECT_EQ(decode_base64("Zm9vYmFy"), "foobar");
    EXPECT_EQ(decode_base64(""), "");
    EXPECT_FALSE(decode_base64("Zm9v!mFy"));
    EXPECT_FALSE(decode_base64("Zm9vY"));
    for (std::size_t size = 0; size < 300; ++size) {
        std::string bytes;
        for (std::size_t i = 0; i < size; ++i)
            bytes += static_cast<char>(i * 37);
        EXPECT_EQ(decode_base64(base64(bytes)), bytes);
    }
}

// --- Geometry -----------------------------------------------------------------------------------

TEST_F(Gltf, PrimitivesArePartsOfOneMesh) {
    Model model;
    const int positions = model.positions(kSquare);
    const int strip = model.accessor<std::uint8_t>({0, 1, 3, 2}, 5121, "SCALAR");
    const int fan = model.accessor<std::uint32_t>({0, 1, 2, 3}, 5125, "SCALAR");
    model.json["materials"] = {{{"name", "paint"}}, Json::object()};
    const Json attributes = {{"POSITION", positions}};
    model.mesh({{{"attributes", attributes}, {"indices", strip}, {"mode", 5}, {"material", 1}},
                {{"attributes", attributes}, {"indices", fan}, {"mode", 6}, {"material", 0}},
                {{"attributes", attributes}, {"mode", 1}},
                {{"attributes", attributes}, {"mode", 4}}});
    model.node({{"mesh", 0}});
    const LoadedScene loaded = load_model(model);
    const Mesh& mesh = mesh_of(loaded.scene);
    EXPECT_EQ(loaded.scene.objects[0].name, "mesh0");
    ASSERT_EQ(mesh.parts.size(), 3u);
    EXPECT_EQ(mesh.parts[1].first, 2u);
    EXPECT_EQ(mesh.parts[1].count, 2u);
    EXPECT_EQ(loaded.scene.materials[mesh.parts[0].material].name, "material1");
    EXPECT_EQ(loaded.scene.materials[mesh.parts[1].material].name, "paint");
    EXPECT_EQ(mesh.parts[2].material, kNoMaterial);
    EXPECT_EQ(mesh.positions.size(), 4u);  // shared by all primitives
    ASSERT_EQ(mesh.triangles.size(), 5u);
    for (std::size_t t = 0; t < 5; ++t) {
        const glm::dvec3 a = corner(loaded.scene, 0, t, 0);
        const glm::dvec3 n =
            glm::cross(corner(loaded.scene, 0, t, 1) - a, corner(loaded.scene, 0, t, 2) - a);
        EXPECT_GT(n.z, 0.0) << t;
    }
    EXPECT_TRUE(any_contains(loaded.warnings, "points and lines are not shown"));
}

TEST_F(Gltf, ReadsNormalsUvsStridesAndQuantizedNumbers) {
    Model model;
    // Position (int16) and normal (int8) interleaved in 12 bytes.
    std::vector<std::int16_t> data;
    for (const glm::ivec2 p : {glm::ivec2(0, 0), glm::ivec2(32767, 0), glm::ivec2(0, -32768)}) {
        // The last two are the bytes 0 0 127 0.
        for (const int value : {p.x, p.y, 0, 0, 0, 127})
            data.push_back(static_cast<std::int16_t>(value));
    }
    const int view = model.view(data);
    model.json["bufferViews"][0]["byteStride"] = 12;
    model.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const auto accessor = [&](int offset, int type) {
        model.json["accessors"].push_back({{"bufferView", view},
                                           {"byteOffset", offset},
                                           {"componentType", type},
                                           {"type", "VEC3"},
                                           {"normalized", true},
                                           {"count", 3}});
        return static_cast<int>(model.json["accessors"].size()) - 1;
    };
    const int positions = accessor(0, 5122);
    const int normals = accessor(8, 5120);
    const int uvs = model.accessor<std::uint8_t>({0, 255, 51, 0, 255, 255}, 5121, "VEC2", true);
    model.mesh(
        {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}}}});
    model.node({{"mesh", 0}});
    const LoadedScene loaded = load_model(model);
    const Mesh& mesh = mesh_of(loaded.scene);
    EXPECT_EQ(corner(loaded.scene, 0, 0, 1), glm::dvec3(1, 0, 0));
    EXPECT_EQ(corner(loaded.scene, 0, 0, 2), glm::dvec3(0, -1, 0));
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.uvs[0], glm::vec2(0, 0));  // v grows upwards here
    EXPECT_NEAR(mesh.uvs[1].x, 0.2f, 1e-6);
    EXPECT_EQ(mesh.uvs[1].y, 1.0f);
}

TEST_F(Gltf, ReadsSparseAccessors) {
    Model model = placed_square();
    const int indices = model.view<std::uint16_t>({2, 3});
    const int values = model.view<float>({5, 6, 7, 0, 9, 0});
    model.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    EXPECT_EQ(corner(load_model(model).scene, 0, 1, 1), glm::dvec3(5, 6, 7));
    EXPECT_EQ(corner(load_model(model).scene, 0, 1, 2), glm::dvec3(0, 9, 0));
    model.json["accessors"][0].erase("bufferView");  // all others 0
    EXPECT_EQ(corner(load_model(model).scene, 0, 0, 1), glm::dvec3(0, 0, 0));
    EXPECT_EQ(corner(load_model(model).scene, 0, 0, 2), glm::dvec3(5, 6, 7));
}

// A component type that the values claim for themselves once made the bounds check believe in 6
// bytes where 24 were read.
TEST_F(Gltf, SparseValuesHaveTheAccessorsOwnType) {
    Model model = placed_square();
    const int indices = model.view<std::uint16_t>({2, 3});
    const int values = model.view<std::uint8_t>({1, 2, 3, 4, 5, 6});
    model.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}, {"componentType", 5121}}}};
    EXPECT_EQ(complaint_about(model),
              "/accessors/0/sparse/values: 2 elements need bytes 0 to 24 of a buffer view of 6");
}

TEST_F(Gltf, ElementsMustNotOverlap) {
    Model model = placed_square();
    model.json["accessors"][0]["count"] = 4000000000u;
    model.json["bufferViews"][0]["byteStride"] = 0;
    EXPECT_EQ(complaint_about(model), "/bufferViews/0/byteStride: is less than an element");
}

TEST_F(Gltf, NodesDeeperThanAnyModelAreRefused) {
    Model model = square();
    for (int i = 0; i < 1500; ++i)
        model.node({{"children", {i + 1}}});
    model.node({{"mesh", 0}});
    EXPECT_EQ(complaint_about(model), "/nodes/1000: lies more than 1000 nodes deep");
}

TEST_F(Gltf, WithoutNormalsItIsFlatAndBadOnesAreRepaired) {
    EXPECT_TRUE(mesh_of(load_model(placed_square()).scene).normals.empty());
    Model model;
    const int positions = model.positions(kSquare);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const int normals = model.positions({3, 0, 4, 0, 0, 0, nan, 0, 0, 0, 0, 1});
    model.mesh({{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"mode", 6}},
                {{"attributes", {{"POSITION", positions}}}, {"mode", 6}}});
    model.node({{"mesh", 0}});
    const LoadedScene loaded = load_model(model);
    const Mesh& mesh = mesh_of(loaded.scene);
    EXPECT_NEAR(mesh.normals[mesh.triangles[0].x].x, 0.6f, 1e-6);
    EXPECT_EQ(mesh.normals[mesh.triangles[0].y], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[mesh.triangles[0].z], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[mesh.triangles[2].x], glm::vec3(0, 0, 1));
}

// --- Nodes --------------------------------------------------------------------------------------

TEST_F(Gltf, NodesArePlacedInTheirTreeAndShareMeshes) {
    Model model = square();
    model.node({{"name", "wheel"}, {"mesh", 0}, {"translation", {0, 0, 1}}});
    model.node(
        {{"mesh", 0}, {"scale", {2, 1, 1}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}});
    model.node({{"name", "car"}, {"children", {0, 1, 4}}, {"translation", {10, 0, 0}}});
    model.node({{"name", "lost"}, {"mesh", 0}});
    model.node({{"children", {5}}});
    model.node({{"name", "wheel"},
                {"mesh", 0},
                {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}}});
    model.json["scenes"] = {{{"nodes", {2}}}};
    const LoadedScene loaded = load_model(model);
    const Scene& scene = loaded.scene;
    EXPECT_THAT(object_names(scene), ElementsAre("wheel", "sheet", "wheel#2"));
    EXPECT_EQ(scene.objects[0].path, "/car/wheel");
    EXPECT_EQ(scene.objects[1].path, "/car/sheet");
    EXPECT_EQ(scene.objects[2].path, "/car/node4/wheel");
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(corner(scene, 0, 0, 2), glm::dvec3(11, 1, 1));
    // Scaled, then turned by 90 degrees about z, then moved.
    EXPECT_LT(glm::distance(corner(scene, 1, 0, 2), glm::dvec3(9, 2, 0)), 1e-12);
    EXPECT_EQ(corner(scene, 2, 0, 0), glm::dvec3(11, 2, 3));
}

TEST_F(Gltf, WithoutScenesAllTreesAreShown) {
    Model model = square();
    model.node({{"mesh", 0}, {"name", "child"}});
    model.node({{"children", {0}}, {"name", "root"}});
    model.node({{"mesh", 0}, {"name", "alone"}});
    EXPECT_EQ(load_model(model).scene.objects[0].path, "/root/child");
    EXPECT_EQ(load_model(model).scene.objects[1].path, "/alone");
}

TEST_F(Gltf, SiblingsOfOneNameHaveDifferentPaths) {
    Model model = square();
    for (int i = 0; i < 3; ++i)
        model.node({{"mesh", 0}, {"name", i == 1 ? "a#2" : "a"}});
    const LoadedScene loaded = load_model(model);
    EXPECT_EQ(loaded.scene.objects[0].path, "/a");
    EXPECT_EQ(loaded.scene.objects[1].path, "/a#2");
    EXPECT_EQ(loaded.scene.objects[2].path, "/a#3");
}

TEST_F(Gltf, TransformsAreComposedInDouble) {
    Model model = square();
    model.node({{"mesh", 0}, {"translation", {0.0001, 0.0002, 0}}});
    model.node({{"children", {0}}, {"translation", {5000000.25, 5000000, 100}}});
    const LoadedScene loaded = load_model(model);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 0).x, 5000000.2501, 1e-7);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 0).y, 5000000.0002, 1e-7);
}

TEST_F(Gltf, MirroredNodesMirror) {
    Model model = square();
    model.node({{"mesh", 0}, {"scale", {-1, 1, 1}}});
    const LoadedScene loaded = load_model(model);
    EXPECT_TRUE(loaded.scene.objects[0].world_from_object.mirrors());
    EXPECT_EQ(corner(loaded.scene, 0, 0, 1), glm::dvec3(-1, 0, 0));
}

TEST_F(Gltf, DeepTreesNeedNoStack) {
    Model model = square();
    constexpr int kDepth = 999;
    for (int i = 0; i < kDepth; ++i)
        model.node({{"name", "n"}, {"children", {i + 1}}, {"translation", {0, 0, 1}}});
    model.node({{"mesh", 0}, {"name", "bottom"}});
    EXPECT_EQ(corner(load_model(model).scene, 0, 0, 0).z, kDepth);
}

TEST_F(Gltf, WhatIsNotReadIsAWarning) {
    Model model = square();
    model.node({{"mesh", 0}, {"skin", 0}, {"name", "body"}});
    model.node({{"mesh", 0}, {"scale", {0, 1, 1}}, {"name", "hidden"}});
    model.json["animations"] = Json::array({Json::object()});
    model.json["textures"] = Json::array({Json::object(), Json::object()});
    model.json["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_sheen"};
    const LoadedScene loaded = load_model(model);
    EXPECT_THAT(object_names(loaded.scene), ElementsAre("body"));
    ASSERT_EQ(loaded.warnings.size(), 3u);
    for (const char* part : {"rest pose", "/hidden: scaled to nothing",
                             "the extension KHR_materials_sheen is not read"})
        EXPECT_TRUE(any_contains(loaded.warnings, part)) << part;
}

// --- Materials ----------------------------------------------------------------------------------

class GltfMaterials : public Gltf {
protected:
    Material material(const Json& json) {
        Model model = placed_square();
        model.json["materials"] = {json};
        return load_model(model).scene.materials.at(0);
    }
    static Json pbr(const Json& json) { return {{"pbrMetallicRoughness", json}}; }
};

void expect_near(const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-6f)
        << fmt::format("{} {} {} is not {} {} {}", a.x, a.y, a.z, b.x, b.y, b.z);
}

TEST_F(GltfMaterials, PlasticIsDiffuseWithAFaintHighlight) {
    const Material m = material(pbr({{"baseColorFactor", {0.2, 0.4, 0.6, 1}},
                                     {"metallicFactor", 0},
                                     {"roughnessFactor", 0.5}}));
    expect_near(m.diffuse, {0.2f, 0.4f, 0.6f});
    expect_near(m.ambient, m.diffuse);
    expect_near(m.specular, glm::vec3(0.04f));
    EXPECT_NEAR(m.shininess, 30.0f, 1e-4);  // 2 / 0.25^2 - 2
    EXPECT_FALSE(m.reflects());
    EXPECT_FALSE(m.transmits());
}

TEST_F(GltfMaterials, PolishedMetalMirrorsItsColourRoughMetalDoesNot) {
    const Material polished =
        material(pbr({{"baseColorFactor", {1, 0.8, 0.2, 1}}, {"roughnessFactor", 0}}));
    expect_near(polished.diffuse, glm::vec3(0.0f));
    expect_near(polished.reflect, {1.0f, 0.8f, 0.2f});
    expect_near(polished.specular, {1.0f, 0.8f, 0.2f});
    expect_near(polished.ambient, glm::vec3(0.0f));
    EXPECT_EQ(polished.shininess, 8192.0f);
    const Material brushed =
        material(pbr({{"baseColorFactor", {1, 0.8, 0.2, 1}}, {"roughnessFactor", 0.5}}));
    expect_near(brushed.reflect, {0.25f, 0.2f, 0.05f});
    expect_near(brushed.ambient, {0.75f, 0.6f, 0.15f});
    const Material rough = material(Json::object());  // metal of roughness 1 by default
    EXPECT_FALSE(rough.reflects());
    EXPECT_EQ(rough.shininess, 1.0f);
    expect_near(rough.ambient, glm::vec3(1.0f));
    EXPECT_THROW(material(pbr({{"metallicRoughnessTexture", {{"index", 0}}}})), FileError)
        << "there is no such texture";
}

TEST_F(GltfMaterials, GlassBendsOnlyIfItHasThickness) {
    Json json =
        pbr({{"baseColorFactor", {1, 0.5, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}});
    json["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
                          {"KHR_materials_ior", {{"ior", 2.0}}}};
    const Material thin = material(json);
    expect_near(thin.transmit, {0.5f, 0.25f, 0.5f});
    expect_near(thin.diffuse, {0.5f, 0.25f, 0.5f});
    EXPECT_EQ(thin.reflectance, Reflectance::dielectric);
    expect_near(thin.reflect, glm::vec3(0.5f));
    EXPECT_TRUE(thin.thin_walled);
    json["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.1}};
    EXPECT_EQ(material(json).ior, 2.0f);
    EXPECT_FALSE(material(json).thin_walled);
}

TEST_F(GltfMaterials, EmissiveUnlitAndBlended) {
    Json lamp = {{"emissiveFactor", {1, 0.5, 0}}};
    lamp["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 4;
    expect_near(material(lamp).emissive, {4.0f, 2.0f, 0.0f});
    Json unlit = pbr({{"baseColorFactor", {0.1, 0.2, 0.3, 1}}});
    unlit["extensions"]["KHR_materials_unlit"] = Json::object();
    const Material sign = material(unlit);
    expect_near(sign.emissive, {0.1f, 0.2f, 0.3f});
    expect_near(sign.diffuse + sign.ambient + sign.specular, glm::vec3(0.0f));
    Json veil = pbr({{"baseColorFactor", {1, 1, 1, 0.25}}, {"metallicFactor", 0}});
    EXPECT_FALSE(material(veil).transmits());
    veil["alphaMode"] = "BLEND";
    EXPECT_EQ(material(veil).alpha_mode, AlphaMode::blend);
    EXPECT_EQ(material(veil).opacity, 0.25f);
    expect_near(material(veil).diffuse, glm::vec3(1.0f));
}

// One row of texels as a TGA image.
std::string tga_row(const std::vector<glm::u8vec3>& texels) {
    std::string bytes(18, '\0');
    bytes[2] = 2;  // true colour
    bytes[12] = static_cast<char>(texels.size());
    bytes[14] = 1;
    bytes[16] = 24;
    for (const glm::u8vec3& c : texels)
        bytes += {static_cast<char>(c.z), static_cast<char>(c.y), static_cast<char>(c.x)};
    return bytes;
}

// The material at the middle of texel `i` of `count` in a row.
Material at_texel(const Scene& scene, Material m, int i, std::size_t count) {
    const glm::vec2 uv((static_cast<float>(i) + 0.5f) / static_cast<float>(count), 0.5f);
    const auto texel = [&](MapSlot slot) {
        const TextureMap& map = m.map(slot);
        return map ? sample(scene.textures[map.texture], map, uv) : glm::vec4(1.0f);
    };
    const bool own = static_cast<bool>(m.map(MapSlot::ambient));
    m.ambient *= glm::vec3(texel(own ? MapSlot::ambient : MapSlot::diffuse));
    m.diffuse *= glm::vec3(texel(MapSlot::diffuse));
    m.specular *= glm::vec3(texel(MapSlot::specular));
    m.shininess *= texel(MapSlot::shininess).x;
    m.reflect *= glm::vec3(texel(MapSlot::reflect));
    m.transmit *= glm::vec3(texel(MapSlot::transmit));
    return m;
}

void expect_alike(const glm::vec3& a, const glm::vec3& b, const char* what) {
    EXPECT_LT(glm::distance(a, b), 0.01f)
        << fmt::format("{}: {} {} {}, not {} {} {}", what, a.x, a.y, a.z, b.x, b.y, b.z);
}

// Green is roughness, blue is metal: what a texture says at a texel is what factors would say.
TEST_F(GltfMaterials, ATextureOfMetalAndRoughnessIsTheFactorsOfEachTexel) {
    struct Case {
        const char* name;
        std::vector<glm::u8vec3> texels;
        double transmission = 0.0;
    };
    const std::vector<Case> cases = {
        {"metal", {{0, 255, 255}, {0, 230, 255}, {0, 210, 255}, {0, 128, 255}, {0, 20, 255}}},
        {"rough", {{0, 255, 255}, {0, 255, 0}, {0, 255, 128}, {0, 255, 30}}},
        {"mixed", {{0, 255, 0}, {0, 200, 255}, {0, 100, 128}, {0, 0, 255}}},
        {"plastic", {{0, 255, 0}, {0, 190, 0}, {0, 20, 0}}},
        {"glass", {{0, 255, 0}, {0, 190, 0}, {0, 0, 255}}, 0.75},
    };
    for (const Case& test : cases) {
        SCOPED_TRACE(test.name);
        Json factors = pbr({{"baseColorFactor", {0.8, 0.5, 0.3, 1}}});
        factors["extensions"]["KHR_materials_transmission"]["transmissionFactor"] =
            test.transmission;
        Model model = placed_square();
        model.json["textures"] = {{{"source", 0}}};
        model.json["images"] = {{{"uri", "data:image/tga;base64," + base64(tga_row(test.texels))}}};
        Json textured = factors;
        textured["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] = 0;
        model.json["materials"] = {textured};
        const LoadedScene loaded = load_model(model);
        EXPECT_THAT(loaded.warnings, IsEmpty());
        for (std::size_t i = 0; i < test.texels.size(); ++i) {
            SCOPED_TRACE(i);
            factors["pbrMetallicRoughness"]["roughnessFactor"] = test.texels[i].y / 255.0;
            factors["pbrMetallicRoughness"]["metallicFactor"] = test.texels[i].z / 255.0;
            const Material expected = material(factors);
            const Material m = at_texel(loaded.scene, loaded.scene.materials.at(0),
                                        static_cast<int>(i), test.texels.size());
            expect_alike(m.diffuse, expected.diffuse, "diffuse");
            expect_alike(m.ambient, expected.ambient, "ambient");
            expect_alike(m.specular, expected.specular, "specular");
            expect_alike(m.reflect, expected.reflect, "reflect");
            expect_alike(m.transmit, expected.transmit, "transmit");
            EXPECT_NEAR(m.shininess / expected.shininess, 1.0f, 0.02f) << expected.shininess;
            EXPECT_GE(m.shininess, 1.0f);
        }
    }
}

// What is read can be saved and loaded again.
TEST_F(GltfMaterials, ColoursThatVanishInGlassStayWithinWhatScenesHold) {
    Json json = pbr({{"metallicFactor", 0}});
    json["extensions"] = {
        {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
        {"KHR_materials_volume",
         {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {0.5, 0, 1}}}}};
    json["emissiveFactor"] = {1, 1, 1};
    json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 1e18;
    Model model = placed_square();
    model.json["materials"] = {json};
    model.json["meshes"][0]["primitives"][0]["material"] = 0;
    const LoadedScene loaded = load_model(model);
    const glm::vec3 absorption = loaded.scene.materials.at(0).absorption;
    EXPECT_NEAR(absorption.x, std::log(2.0f) / 2.0f, 1e-6f);
    EXPECT_EQ(absorption.y, 1e18f);
    save_scene(loaded.scene, folder_ / "saved.json");
    EXPECT_EQ(load_scene(folder_ / "saved.json").scene.materials.at(0).absorption, absorption);
}

TEST_F(GltfMaterials, ACutoffAboveOneLeavesNothing) {
    Json json = pbr({{"baseColorFactor", {1, 1, 1, 1}}});
    json["alphaMode"] = "MASK";
    json["alphaCutoff"] = 1.5;
    EXPECT_EQ(material(json).alpha_cutoff, 1.5f);
}

// --- Cameras and lights -------------------------------------------------------------------------

TEST_F(Gltf, CamerasLookAlongMinusZOfTheirNode) {
    Model model = square();
    model.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}},
        {{"type", "orthographic"}, {"name", "plan"}, {"orthographic", {{"xmag", 1}, {"ymag", 3}}}}};
    // Turned by 90 degrees about y: -z becomes -x. Scaled, which must not matter.
    model.node({{"camera", 0},
                {"name", "eye"},
                {"translation", {5, 6, 7}},
                {"scale", {3, 3, 3}},
                {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}});
    model.node({{"camera", 1}});
    model.node({{"camera", 0}});
    const LoadedScene loaded = load_model(model);
    ASSERT_EQ(loaded.scene.cameras.size(), 3u);
    const NamedCamera& named = loaded.scene.cameras[0];
    EXPECT_EQ(named.name, "eye");
    EXPECT_EQ(named.camera.eye, glm::dvec3(5, 6, 7));
    EXPECT_LT(glm::distance(named.camera.at, glm::dvec3(4, 6, 7)), 1e-12);
    EXPECT_LT(glm::distance(named.camera.up, glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_NEAR(named.camera.fovy, 28.64788975654116, 1e-9);
    EXPECT_EQ(loaded.scene.cameras[1].name, "plan");
    EXPECT_EQ(loaded.scene.cameras[1].camera.projection, Projection::orthographic);
    EXPECT_EQ(loaded.scene.cameras[1].camera.height, 6.0);  // ymag is half of it
    EXPECT_EQ(loaded.scene.cameras[2].name, "camera0");
}

TEST_F(Gltf, LightsAreScaledSoThatTheBrightestGivesOneInTheMiddle) {
    Model model = placed_square();
    model.json["extensionsRequired"] = {"KHR_lights_punctual"};
    model.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 200}, {"color", {1, 0.5, 0}}, {"name", "bulb"}},
        {{"type", "directional"}, {"intensity", 50}},
        {{"type", "spot"}, {"intensity", 100}, {"name", "torch"}}};
    const auto lamp = [&](int light, const Json& translation) {
        Json node = {{"translation", translation}};
        node["extensions"]["KHR_lights_punctual"]["light"] = light;
        model.node(node);
    };
    lamp(0, {1, 2, 3});
    lamp(1, {0, 0, 0});
    lamp(2, {4, 5, 6});
    const LoadedScene loaded = load_model(model);
    ASSERT_EQ(loaded.scene.lights.size(), 3u);
    const auto& bulb = std::get<PointLight>(loaded.scene.lights[0]);
    EXPECT_EQ(bulb.name, "bulb");
    EXPECT_EQ(bulb.position, glm::dvec3(1, 2, 3));
    expect_near(bulb.colour, {4.0f, 2.0f, 0.0f});
    EXPECT_EQ(bulb.attenuation, (Attenuation{0.0, 0.0, 1.0}));
    const auto& sun = std::get<DirectionalLight>(loaded.scene.lights[1]);
    EXPECT_EQ(sun.direction, glm::dvec3(0, 0, -1));
    expect_near(sun.colour, glm::vec3(1.0f));  // 50 lux are more than the lamps give there
    const auto& torch = std::get<SpotLight>(loaded.scene.lights[2]);
    expect_near(torch.colour, glm::vec3(2.0f));
    EXPECT_EQ(torch.direction, glm::dvec3(0, 0, -1));
}

// --- Complaints ---------------------------------------------------------------------------------

TEST_F(Gltf, ALightFromVeryFarIsBrightHereAndCanBeSaved) {
    Model model = placed_square();
    model.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    Json lamp = {{"translation", {0, 0, 1e11}}};
    lamp["extensions"]["KHR_lights_punctual"]["light"] = 0;
    model.node(lamp);
    const LoadedScene loaded = load_model(model);
    const auto& light = std::get<PointLight>(loaded.scene.lights.at(0));
    EXPECT_NEAR(static_cast<double>(light.colour.x) / (light.attenuation.quadratic * 1e22), 1.0,
                1e-3);
    save_scene(loaded.scene, folder_ / "saved.json");
    EXPECT_EQ(load_scene(folder_ / "saved.json").scene.lights.size(), 1u);
}

TEST_F(Gltf, ComplaintsNameTheJsonPath) {
    const auto changed = [&](const char* pointer, const Json& value) {
        Model model = placed_square();
        model.json[Json::json_pointer(pointer)] = value;
        return complaint_about(model);
    };
    EXPECT_EQ(changed("/asset/version", "1.0"), "/asset/version: must be \"2.0\", not \"1.0\"");
    EXPECT_EQ(changed("/extensionsRequired", {"KHR_lights_punctual", "KHR_draco_mesh_compression"}),
              "/extensionsRequired/1: the file requires the extension KHR_draco_mesh_compression, "
              "which is not read");
    EXPECT_THAT(changed("/nodes/0/mesh", 1), HasSubstr("/nodes/0/mesh: meshes/1 does not exist"));
    EXPECT_THAT(changed("/nodes/0/mesh", -1), HasSubstr("/nodes/0/mesh: must be a whole number"));
    EXPECT_THAT(changed("/nodes/0/mesh", 0.5), HasSubstr("/nodes/0/mesh: must be a whole number"));
    EXPECT_EQ(changed("/nodes/0/children", {0}),
              "/nodes: every node is a child: they must form trees");
    EXPECT_THAT(changed("/nodes/0/scale", {1, 2}), HasSubstr("/nodes/0/scale: must be three"));
    EXPECT_THAT(changed("/nodes/0/rotation", {0, 0, 0, 0}), HasSubstr("/nodes/0/rotation: "));
    EXPECT_THAT(changed("/nodes/0/matrix", {1, 2}), HasSubstr("/nodes/0/matrix: must be 16"));
    EXPECT_THAT(changed("/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
                HasSubstr("/nodes/0/matrix: the bottom row"));
    EXPECT_THAT(changed("/nodes/0/translation", {"a", 0, 0}),
                HasSubstr("/nodes/0/translation/0: must be a number"));
    EXPECT_EQ(changed("/scene", 3), "/scene: scene 3 does not exist");
    EXPECT_THAT(changed("/meshes/0/primitives/0/mode", 7),
                HasSubstr("/meshes/0/primitives/0/mode"));
    EXPECT_THAT(changed("/meshes/0/primitives/0/attributes", Json::object()),
                HasSubstr("/meshes/0/primitives/0/attributes: \"POSITION\" is missing"));
    EXPECT_THAT(changed("/meshes/0/primitives/0/indices", 0),
                HasSubstr("/accessors/0/type: must be \"SCALAR\" here, not \"VEC3\""));
    EXPECT_THAT(changed("/accessors/0/componentType", 5124),
                HasSubstr("/accessors/0/componentType: must be one of"));
    EXPECT_EQ(changed("/accessors/0/count", 5),
              "/accessors/0: 5 elements need bytes 0 to 60 of a buffer view of 48");
    EXPECT_THAT(changed("/accessors/0/count", 4000000000), HasSubstr("/accessors/0: "));
    EXPECT_THAT(changed("/accessors/0/byteOffset", 9e15), HasSubstr("/accessors/0: "));
    EXPECT_EQ(changed("/accessors/1/byteOffset", 4),
              "/accessors/1: 6 elements need bytes 4 to 16 of a buffer view of 12");
    EXPECT_THAT(changed("/bufferViews/0/byteLength", 1000),
                HasSubstr("/bufferViews/0: bytes 0 to"));
    EXPECT_THAT(changed("/bufferViews/0/byteOffset", 9007199254740992.0),
                HasSubstr("/bufferViews/0: bytes"));
    EXPECT_THAT(changed("/materials", {{{"pbrMetallicRoughness", {{"metallicFactor", 2}}}}}),
                HasSubstr("/materials/0/pbrMetallicRoughness/metallicFactor: must be"));
    EXPECT_THAT(changed("/meshes", 5), HasSubstr("/meshes: must be an array"));
}

TEST_F(Gltf, ComplaintsNameTheElement) {
    Model model;
    const int positions =
        model.positions({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::infinity(), 0});
    model.mesh({{{"attributes", {{"POSITION", positions}}}}});
    model.node({{"mesh", 0}});
    EXPECT_EQ(complaint_about(model), "/accessors/0: element 2: y is inf: beyond 1e+18");
    Model other;
    const int square = other.positions(kSquare);
    const int indices = other.accessor<std::uint16_t>({0, 1, 4}, 5123, "SCALAR");
    other.mesh({{{"attributes", {{"POSITION", square}}}, {"indices", indices}}});
    other.node({{"mesh", 0}});
    EXPECT_EQ(complaint_about(other),
              "/accessors/1: element 2: there is no vertex 4 (there are 4)");
}

TEST_F(Gltf, ComplaintsAboutNodesBeyondAllCoordinates) {
    Model wide = placed_square();
    wide.json["cameras"] = {{{"orthographic", {{"ymag", 9e17}}}}};
    wide.node({{"camera", 0}});
    EXPECT_THAT(complaint_about(wide), HasSubstr("ymag: must be a positive number"));
    Model far = square();
    far.node({{"mesh", 0}, {"translation", {1e25, 0, 0}}});
    EXPECT_EQ(complaint_about(far), "/nodes/0: its place: x is 1e+25: beyond 1e+18");
    Model large = square();
    large.node({{"children", {1}}, {"scale", {1e10, 1, 1}}});
    large.node({{"mesh", 0}, {"scale", {1e10, 1, 1}}});
    large.json["scenes"] = {{{"nodes", {0}}}};
    EXPECT_EQ(complaint_about(large), "/nodes/1: its scale: x is 1e+20: beyond 1e+18");
}

TEST_F(Gltf, ComplaintsAboutTheTree) {
    Model twice = square();
    twice.node({{"mesh", 0}});
    twice.json["scenes"] = {{{"nodes", {0, 0}}}};
    EXPECT_EQ(complaint_about(twice), "/nodes/0: is reached twice: the nodes must form trees");
    Model ring = square();
    ring.node({{"children", {1}}});
    ring.node({{"children", {0}}});
    ring.json["scenes"] = {{{"nodes", {0}}}};
    EXPECT_EQ(complaint_about(ring), "/nodes/0: is reached twice: the nodes must form trees");
}

TEST_F(Gltf, ComplaintsAboutBuffers) {
    const auto with_uri = [&](const std::string& uri, int length) {
        Json json = placed_square().json;
        json["buffers"] = {{{"byteLength", length}, {"uri", uri}}};
        return complaint("a.gltf", json.dump());
    };
    EXPECT_THAT(with_uri("gone.bin", 60), HasSubstr("/buffers/0/uri: "));
    EXPECT_THAT(with_uri("gone.bin", 60), HasSubstr("gone.bin: no such file"));
    EXPECT_EQ(with_uri("http://example.org/a.bin", 60),
              "/buffers/0/uri: must be a path relative to this file");
    EXPECT_EQ(with_uri("data:application/octet-stream;base64,a?", 60),
              "/buffers/0/uri: the data are not base64");
    EXPECT_EQ(with_uri("data:,abc", 60), "/buffers/0/uri: a data URI must be base64");
    EXPECT_EQ(with_uri("data:a/b;base64,AAAA", 60),
              "/buffers/0/byteLength: promises 60 bytes, but there are 3");
    Json json = placed_square().json;
    json["buffers"] = {{{"byteLength", 60}}};
    EXPECT_EQ(complaint("a.gltf", json.dump()),
              "/buffers/0: has no uri, and the file has no binary chunk for it");
}

TEST_F(Gltf, ComplaintsAboutTheContainerNameTheByte) {
    const std::string glb = placed_square().glb();
    EXPECT_EQ(complaint("a.glb", glb.substr(0, 10)), "byte 10: the file ends in the GLB header");
    EXPECT_EQ(
        complaint("a.glb", glb.substr(0, 100)),
        fmt::format("byte 8: the header promises {} bytes, but the file has 100", glb.size()));
    EXPECT_EQ(complaint("a.glb", "glTF" + Model::word(1) + glb.substr(8)),
              "byte 4: GLB version 1 is not read: only 2");
    EXPECT_EQ(complaint("a.glb", glb.substr(0, 12) + Model::word(99999) + glb.substr(16)),
              fmt::format("byte 12: a chunk of 99999 bytes, but only {} follow", glb.size() - 20));
    EXPECT_EQ(complaint("a.glb", "glTF" + Model::word(2) + Model::word(12)),
              "byte 12: the file has no JSON chunk");
    EXPECT_THAT(complaint("a.gltf", "{\"asset\": {\"version\": \"2.0\"},\n \"nodes\": [1,]}"),
                HasSubstr("line 2, column"));
    EXPECT_EQ(complaint("a.gltf", "{}"), "/: \"asset\" is missing");
    EXPECT_THAT(complaint("a.gltf", "[]"), HasSubstr("must be an object"));
}

TEST_F(Gltf, BrokenFilesNeverCrash) {
    expect_no_crash("a.gltf", placed_square().text());
    expect_no_crash("b.glb", placed_square().glb());
}

}  // namespace
}  // namespace raypick
