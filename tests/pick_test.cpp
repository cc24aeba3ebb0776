#include "picking/pick.h"

#include "picking/json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <memory>

namespace raypick {
namespace {

using testing::ElementsAre;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <typename Value>
std::string json_of(const Value& value) {
    std::string out;
    append_json(out, value);
    return out;
}

// Two unit spheres one behind the other on the z axis, seen from z = 10, in a scene whose files
// coordinates begin at (1000, 0, 0); a plane below them; nothing above.
std::shared_ptr<const Scene> two_spheres() {
    auto scene = std::make_shared<Scene>();
    scene->origin = {1000.0, 0.0, 0.0};
    Material red;
    red.name = "red \"matt\"";
    const MaterialId material = add_material(*scene, red);
    const auto add = [&](const std::string& name, Shape shape, MaterialId m) {
        Object object;
        object.name = name;
        object.path = "/" + name;
        object.shape = shape;
        object.material = m;
        add_object(*scene, object);
    };
    add("front", Sphere{{0, 0, 0}, 1.0}, material);
    add("back", Sphere{{0, 0, -5}, 1.0}, kNoMaterial);
    add("floor", Plane{{0, 1, 0}, 1.5}, kNoMaterial);
    return scene;
}

constexpr ImageSize kSize{101, 151};

Camera from_the_front() {
    Camera camera;
    camera.eye = {0, 0, 10};
    camera.at = {0, 0, 0};
    return camera;
}

class PickTest : public testing::Test {
protected:
    Accel accel_{two_spheres()};
    Camera camera_ = from_the_front();
};

TEST_F(PickTest, NamesTheFirstObjectInFileCoordinates) {
    const auto pick = pick_pixel(accel_, camera_, kSize, {50, 75});
    ASSERT_TRUE(pick);
    EXPECT_EQ(pick->object, "front");
    EXPECT_EQ(pick->path, "/front");
    EXPECT_EQ(pick->material, "red \"matt\"");
    EXPECT_EQ(pick->hit.object, 0u);
    EXPECT_NEAR(pick->hit.t, 9.0f, 1e-5f);
    EXPECT_NEAR(pick->point.x, 1000.0, 1e-5);
    EXPECT_NEAR(pick->point.z, 1.0, 1e-5);
    EXPECT_NEAR(pick->normal.z, 1.0f, 1e-5f);
    EXPECT_TRUE(pick->hit.front_face);
}

TEST_F(PickTest, TheBackgroundIsNothing) {
    EXPECT_FALSE(pick_pixel(accel_, camera_, kSize, {0, 75}));
}

TEST_F(PickTest, TheFloorLiesBelow) {
    const auto pick = pick_pixel(accel_, camera_, kSize, {100, 75});
    ASSERT_TRUE(pick);
    EXPECT_EQ(pick->object, "floor");
    EXPECT_EQ(pick->material, "");
}

TEST_F(PickTest, AllGoesThroughInOrder) {
    const auto picks = pick_all(accel_, camera_ray(camera_, kSize, Pixel{50, 75}));
    std::vector<std::string> names;
    std::vector<bool> fronts;
    for (const Pick& pick : picks) {
        names.push_back(pick.object);
        fronts.push_back(pick.hit.front_face);
    }
    EXPECT_THAT(names, ElementsAre("front", "front", "back", "back"));
    EXPECT_THAT(fronts, ElementsAre(true, false, true, false));
}

TEST_F(PickTest, TheQueryReachesTheTracer) {
    const auto not_the_front = [](const Hit& hit) { return hit.object != 0; };
    RayQuery query;
    query.accept = AcceptHit(not_the_front);
    const auto pick = pick_pixel(accel_, camera_, kSize, {50, 75}, query);
    ASSERT_TRUE(pick);
    EXPECT_EQ(pick->object, "back");
}

TEST_F(PickTest, JsonHasTheDocumentedKeysInOrder) {
    const PixelPick hit{{50, 75}, pick_pixel(accel_, camera_, kSize, {50, 75})};
    const auto json = nlohmann::ordered_json::parse(to_json(hit));
    std::vector<std::string> keys;
    for (const auto& [key, value] : json.items())
        keys.push_back(key);
    EXPECT_THAT(keys, ElementsAre("row", "col", "hit", "object", "object_id", "primitive", "t",
                                  "point", "normal", "uv", "front_face", "material"));
    EXPECT_EQ(json["row"], 50);
    EXPECT_EQ(json["col"], 75);
    EXPECT_EQ(json["hit"], true);
    EXPECT_EQ(json["material"], "red \"matt\"");
    EXPECT_EQ(json["t"].get<float>(), hit.pick->hit.t) << "reads back as the same float";
    EXPECT_EQ(json["point"][0].get<double>(), hit.pick->point.x);
    EXPECT_EQ(to_json(PixelPick{{0, 75}, std::nullopt}), R"({"row":0,"col":75,"hit":false})");
}

TEST_F(PickTest, JsonOfAllHits) {
    const Ray ray = camera_ray(camera_, kSize, Pixel{50, 75});
    const auto json = nlohmann::json::parse(to_json(Pixel{50, 75}, pick_all(accel_, ray)));
    EXPECT_EQ(json["object"], "front");
    ASSERT_EQ(json["hits"].size(), 4u);
    EXPECT_EQ(json["hits"][3]["object"], "back");
    EXPECT_EQ(json["hits"][3]["front_face"], false);
    EXPECT_EQ(to_json(Pixel{0, 1}, std::vector<Pick>{}),
              R"({"row":0,"col":1,"hit":false,"hits":[]})");
}

TEST_F(PickTest, JsonOfARay) {
    const Ray ray{{0, 0, 10}, {0, 0, -1}};
    const auto json = nlohmann::json::parse(
        to_json(glm::dvec3(1000, 0, 10), glm::dvec3(0, 0, -1), pick_ray(accel_, ray)));
    EXPECT_EQ(json["origin"], nlohmann::json::parse("[1000,0,10]"));
    EXPECT_EQ(json["direction"], nlohmann::json::parse("[0,0,-1]"));
    EXPECT_EQ(json["object"], "front");
    EXPECT_EQ(to_json(glm::dvec3(0.1, 0, 0), glm::dvec3(0, 1, 0), std::optional<Pick>()),
              R"({"origin":[0.1,0,0],"direction":[0,1,0],"hit":false})");
    EXPECT_EQ(to_json(glm::dvec3(0.0), glm::dvec3(0, 1, 0), std::vector<Pick>()),
              R"({"origin":[0,0,0],"direction":[0,1,0],"hit":false,"hits":[]})");
}

TEST(Json, NumbersAreShortestAndReadBackTheSame) {
    EXPECT_EQ(json_of(0.1f), "0.1");
    EXPECT_EQ(json_of(0.1), "0.1");
    EXPECT_EQ(json_of(1.0 / 3.0), "0.3333333333333333");
    EXPECT_EQ(json_of(5000000.123), "5000000.123");
    EXPECT_EQ(json_of(std::int64_t{4294967295}), "4294967295");
    for (const double value : {1e300, -2.5e-310, 1.7976931348623157e308, -0.0, 123456789.0}) {
        const double back = nlohmann::json::parse(json_of(value)).get<double>();
        EXPECT_EQ(back, value) << json_of(value);
    }
}

TEST(Json, WhatIsNotFiniteBecomesNull) {
    EXPECT_EQ(json_of(kNaN), "null");
    EXPECT_EQ(json_of(-kInfinity), "null");
    EXPECT_EQ(json_of(std::numeric_limits<double>::infinity()), "null");
    EXPECT_EQ(json_of(glm::vec3(1.0f, kNaN, 2.5f)), "[1,null,2.5]");
}

TEST(Json, TextIsEscaped) {
    EXPECT_EQ(json_of(std::string_view("wheel")), "\"wheel\"");
    EXPECT_EQ(json_of(std::string_view("a\"b\\c")), R"("a\"b\\c")");
    EXPECT_EQ(json_of(std::string_view("\n\r\t")), R"("\n\r\t")");
    EXPECT_EQ(json_of(std::string_view("\x01\x1f\0", 3)), R"("\u0001\u001f\u0000")");
    EXPECT_EQ(json_of(std::string_view("R\xc3\xa4"
                                       "der \xe2\x82\xac \xf0\x9f\x9a\x9a")),
              "\"R\xc3\xa4"
              "der \xe2\x82\xac \xf0\x9f\x9a\x9a\"");
}

TEST(Json, InvalidUtf8IsReplaced) {
    const std::string mark = "\xef\xbf\xbd";
    EXPECT_EQ(json_of(std::string_view("a\xffz")), "\"a" + mark + "z\"");
    EXPECT_EQ(json_of(std::string_view("\xc3")), '"' + mark + '"') << "cut short";
    EXPECT_EQ(json_of(std::string_view("\xc0\xaf")), '"' + mark + mark + '"') << "overlong";
    EXPECT_EQ(json_of(std::string_view("\xed\xa0\x80")), '"' + mark + mark + mark + '"')
        << "a surrogate";
    EXPECT_EQ(json_of(std::string_view("\xf4\x90\x80\x80")), '"' + mark + mark + mark + mark + '"')
        << "above U+10FFFF";
}

// Every string of two bytes gives JSON that a strict parser accepts.
TEST(Json, AnyTwoBytesGiveValidJson) {
    for (int first = 0; first < 256; ++first) {
        for (int second = 0; second < 256; ++second) {
            const char bytes[] = {static_cast<char>(first), static_cast<char>(second)};
            const std::string json = json_of(std::string_view(bytes, 2));
            ASSERT_TRUE(nlohmann::json::accept(json)) << first << ' ' << second;
        }
    }
}

}  // namespace
}  // namespace raypick
