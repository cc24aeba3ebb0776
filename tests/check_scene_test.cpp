// What check_scene refuses of lights and materials, and how it says so.
#include "tests/tracer_scenes.h"
#include "tracer/error.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace raypick {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string complaint(const Scene& scene) {
    try {
        check_scene(scene);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

std::string complaint(const Light& light) {
    Scene scene;
    scene.lights = {light};
    return complaint(scene);
}

std::string complaint(Material material) {
    material.name = "pane";
    Scene scene;
    add_material(scene, std::move(material));
    return complaint(scene);
}

TEST(CheckScene, LightsAsTheyAreByDefaultPass) {
    EXPECT_EQ(complaint(PointLight{}), "");
    EXPECT_EQ(complaint(DirectionalLight{}), "");
    EXPECT_EQ(complaint(SpotLight{}), "");
    EXPECT_EQ(complaint(SphereLight{}), "");
    EXPECT_EQ(complaint(RectangleLight{}), "");
}

TEST(CheckScene, BadLightsAreNamedWithTheirKey) {
    SpotLight spot;
    spot.name = "beam";
    spot.outer_degrees = 10.0;
    EXPECT_THAT(complaint(spot), HasSubstr("light \"beam\": outer_degrees must be"));
    spot.outer_degrees = 91.0;
    EXPECT_THAT(complaint(spot), HasSubstr("not 91"));
    SphereLight ball;
    ball.name = "bulb";
    ball.radius = 0.0;
    EXPECT_THAT(complaint(ball), HasSubstr("light \"bulb\": radius must be positive"));
    RectangleLight panel;
    panel.name = "panel";
    panel.samples = 0;
    EXPECT_THAT(complaint(panel), HasSubstr("light \"panel\": samples must be from 1 to 64"));
    panel.samples = 1;
    panel.edge_v = glm::dvec3(0.0);
    EXPECT_THAT(complaint(panel), HasSubstr("edge_v must not be zero"));
    PointLight lamp;
    lamp.name = "lamp";
    lamp.colour = {1.0f, -0.5f, 1.0f};
    EXPECT_THAT(complaint(lamp), HasSubstr("light \"lamp\": colour must be 0 or more, not -0.5"));
    lamp.colour = glm::vec3(kInfinity);
    EXPECT_THAT(complaint(lamp), HasSubstr("colour must be a finite number"));
    lamp.colour = glm::vec3(1.0f);
    lamp.attenuation = {0.0, 0.0, 0.0};
    EXPECT_THAT(complaint(lamp), HasSubstr("attenuation must not be all 0"));
}

// Every number of every light and of materials, each of them spoilt in every way.
template <typename Part>
struct Number {
    std::string key;
    std::function<void(Part&, float)> set;
    bool may_be_negative = false;
};

template <typename Part>
void expect_refused(const std::string& what, const std::vector<Number<Part>>& numbers) {
    for (const Number<Part>& number : numbers) {
        for (const float bad : {kNan, kInfinity, -kInfinity, -1.0f}) {
            if (bad == -1.0f && number.may_be_negative) continue;
            Part part;
            part.name = "pane";
            number.set(part, bad);
            const std::string text = complaint(part);
            EXPECT_THAT(text, StartsWith(what + " \"pane\": " + number.key)) << bad;
            EXPECT_THAT(text, HasSubstr("not " + testing::PrintToString(bad)));
        }
    }
}

template <typename T>
std::vector<Number<T>> attenuation_numbers() {
    return {{"constant attenuation", [](T& l, float x) { l.attenuation.constant = x; }},
            {"linear attenuation", [](T& l, float x) { l.attenuation.linear = x; }},
            {"quadratic attenuation", [](T& l, float x) { l.attenuation.quadratic = x; }},
            {"colour", [](T& l, float x) { l.colour.z = x; }}};
}

template <typename T>
std::vector<Number<T>> with_attenuation(std::vector<Number<T>> numbers) {
    for (Number<T>& number : attenuation_numbers<T>())
        numbers.push_back(std::move(number));
    return numbers;
}

TEST(CheckScene, NoNumberOfALightMayBeBad) {
    expect_refused("light", with_attenuation<PointLight>(
                                {{"position", [](auto& l, float x) { l.position.y = x; }, true}}));
    expect_refused<DirectionalLight>(
        "light", {{"direction", [](auto& l, float x) { l.direction.x = x; }, true},
                  {"colour", [](auto& l, float x) { l.colour.x = x; }}});
    expect_refused("light",
                   with_attenuation<SpotLight>(
                       {{"position", [](auto& l, float x) { l.position.y = x; }, true},
                        {"direction", [](auto& l, float x) { l.direction.z = x; }, true},
                        {"inner_degrees", [](auto& l, float x) { l.inner_degrees = x; }},
                        {"outer_degrees", [](auto& l, float x) { l.outer_degrees = x; }}}));
    expect_refused("light", with_attenuation<SphereLight>(
                                {{"centre", [](auto& l, float x) { l.centre.y = x; }, true},
                                 {"radius", [](auto& l, float x) { l.radius = x; }}}));
    expect_refused("light", with_attenuation<RectangleLight>(
                                {{"corner", [](auto& l, float x) { l.corner.y = x; }, true},
                                 {"edge_u", [](auto& l, float x) { l.edge_u.y = x; }, true},
                                 {"edge_v", [](auto& l, float x) { l.edge_v.y = x; }, true}}));
}

TEST(CheckScene, NoNumberOfAMaterialMayBeBad) {
    expect_refused<Material>("material",
                             {{"ambient", [](auto& m, float x) { m.ambient.x = x; }},
                              {"diffuse", [](auto& m, float x) { m.diffuse.y = x; }},
                              {"specular", [](auto& m, float x) { m.specular.z = x; }},
                              {"shininess", [](auto& m, float x) { m.shininess = x; }},
                              {"emissive", [](auto& m, float x) { m.emissive.x = x; }},
                              {"reflect", [](auto& m, float x) { m.reflect.y = x; }},
                              {"transmit", [](auto& m, float x) { m.transmit.z = x; }},
                              {"absorption", [](auto& m, float x) { m.absorption.x = x; }},
                              {"ior", [](auto& m, float x) { m.ior = x; }},
                              {"opacity", [](auto& m, float x) { m.opacity = x; }},
                              {"alpha_cutoff", [](auto& m, float x) { m.alpha_cutoff = x; }}});
}

TEST(CheckScene, SurroundingsAreCheckedToo) {
    Scene scene;
    scene.background.y = -1.0f;
    EXPECT_EQ(complaint(scene), "the scene: background must be 0 or more, not -1");
    scene = {};
    scene.ambient.x = kNan;
    EXPECT_THAT(complaint(scene), HasSubstr("ambient must be a finite number"));
    scene = {};
    GradientSky gradient;
    gradient.horizon.z = kInfinity;
    scene.environment = gradient;
    EXPECT_THAT(complaint(scene), HasSubstr("the environment: horizon must be a finite number"));
    gradient = {};
    gradient.up = glm::dvec3(0.0);
    scene.environment = gradient;
    EXPECT_THAT(complaint(scene), HasSubstr("up must not be zero"));
    ImageSky image;
    image.forward = -3.0 * image.up;
    scene.environment = image;
    EXPECT_THAT(complaint(scene), HasSubstr("forward must not be parallel to up"));
    EXPECT_THROW(make_sky_pixels(1, 2, {glm::vec3(1.0f), glm::vec3(1.0f, kNan, 0.0f)}), Error);
    EXPECT_THROW(make_sky_pixels(1, 1, {glm::vec3(-1.0f)}), Error);
    scene = {};
    Checker checker;
    checker.odd.w = kNan;
    add_texture(scene, {"squares", checker});
    EXPECT_THAT(complaint(scene), HasSubstr("texture \"squares\": odd must be between 0 and 1"));
}

// Sums of light stay finite, also after 63 mirrors.
TEST(CheckScene, NumbersThatSumsOfLightCouldNotHoldAreRefused) {
    const auto with = [](const auto& set) {
        Material m;
        set(m);
        return complaint(m);
    };
    EXPECT_THAT(with([](Material& m) { m.reflect.x = 2.5f; }),
                HasSubstr("material \"pane\": reflect must be 2 or less, not 2.5"));
    EXPECT_THAT(with([](Material& m) { m.transmit.y = 1e18f; }), HasSubstr("transmit must be 2"));
    EXPECT_THAT(with([](Material& m) { m.diffuse.z = 2e6f; }), HasSubstr("diffuse must be 1"));
    EXPECT_THAT(with([](Material& m) { m.emissive.z = 1e19f; }), HasSubstr("emissive must be 1e"));
    EXPECT_EQ(with([](Material& m) {
                  m.reflect = m.transmit = glm::vec3(2.0f);
                  m.diffuse = m.ambient = m.specular = glm::vec3(1e6f);
                  m.emissive = m.absorption = glm::vec3(1e18f);
                  m.alpha_cutoff = 1.5f;
              }),
              "");
    PointLight lamp;
    lamp.colour = glm::vec3(1e9f);
    EXPECT_EQ(complaint(lamp), "");
    lamp.attenuation = {1e-300, 0.0, 0.0};
    EXPECT_THAT(complaint(lamp),
                HasSubstr("constant attenuation must be 0 or at least 1e-18, not 1e-300"));
}

TEST(CheckScene, WhatAMapMakesOfAColourCountsToo) {
    Scene scene;
    Material m;
    m.name = "pane";
    m.reflect = glm::vec3(1.0f);
    m.map(MapSlot::reflect).texture = add_texture(scene, {"squares", Checker{}});
    m.map(MapSlot::reflect).gain = 1.5f;
    add_material(scene, m);
    EXPECT_EQ(complaint(scene), "");
    scene.materials[0].map(MapSlot::reflect).gain = 3.0f;
    EXPECT_EQ(complaint(scene),
              "material \"pane\": reflect times its map must be 2 or less, not 3");
}

TEST(CheckScene, BadMaterialsAreNamedWithTheirKey) {
    Material material;
    material.diffuse.y = kNan;
    EXPECT_THAT(complaint(material), HasSubstr("material \"pane\": diffuse must be a finite"));
    material = {};
    material.absorption.x = -1.0f;
    EXPECT_THAT(complaint(material), HasSubstr("absorption must be 0 or more, not -1"));
    material = {};
    material.ior = 0.0f;
    EXPECT_THAT(complaint(material), HasSubstr("ior must be positive"));
    material = {};
    material.opacity = 1.5f;
    EXPECT_THAT(complaint(material), HasSubstr("opacity must be between 0 and 1, not 1.5"));
    material = {};
    material.map(MapSlot::normal).texture = 3;
    EXPECT_THAT(complaint(material), HasSubstr("texture 3 does not exist"));
}

}  // namespace
}  // namespace raypick
