// What check_scene refuses of lights and materials, and how it says so.
#include "tests/tracer_scenes.h"
#include "tracer/error.h"

#include <gmock/gmock.h>

#include <limits>

namespace raypick {
namespace {

using testing::HasSubstr;

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
