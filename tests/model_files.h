// What the tests of the model readers share: files written for one test, and questions to what was
// loaded from them.
#pragma once

#include "tracer/error.h"
#include "tracer/io/load.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace raypick {

// A folder of its own for each test, gone afterwards.
class ModelFiles : public testing::Test {
protected:
    void SetUp() override {
        const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
        std::string name =
            fmt::format("raypick-{}-{}-{}", test->test_suite_name(), test->name(), getpid());
        std::replace(name.begin(), name.end(), '/', '-');  // of tests with parameters
        folder_ = std::filesystem::temp_directory_path() / name;
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, std::string_view text) {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }

    LoadedScene load(const std::string& name, std::string_view text,
                     const LoadOptions& options = {}) {
        return load_scene(write(name, text), options);
    }

    // What load_scene complains about, without the file's name; "" if it doesn't.
    std::string complaint(const std::string& name, std::string_view text) {
        const std::filesystem::path file = write(name, text);
        try {
            load_scene(file);
            return "";
        } catch (const FileError& error) {
            EXPECT_EQ(error.file(), file.string());
            return std::string(error.what()).substr(error.file().size() + 2);
        }
    }

    // Every beginning of a file, and the file with a few bytes changed, either loads or is refused
    // with a FileError; nothing else is thrown and nothing crashes.
    void expect_no_crash(const std::string& name, const std::string& text) {
        for (std::size_t size = 1; size < text.size(); ++size)
            try_to_load(name, text.substr(0, size), fmt::format("the first {} bytes", size));
        for (unsigned seed = 0; seed < 500; ++seed) {
            std::mt19937 random(seed);
            std::string changed = text;
            for (int i = 0; i < 1 + static_cast<int>(random() % 4); ++i)
                changed[random() % changed.size()] = static_cast<char>(random());
            try_to_load(name, changed, fmt::format("changed by seed {}", seed));
        }
    }

    std::filesystem::path folder_;

private:
    void try_to_load(const std::string& name, const std::string& text, const std::string& what) {
        try {
            load_scene(write(name, text));
        } catch (const FileError& error) {
            EXPECT_NE(std::string(error.what()), "") << what;
        } catch (const std::exception& error) {
            ADD_FAILURE() << what << ": " << error.what();
        }
    }
};

inline const Mesh& mesh_of(const Scene& scene, std::size_t object = 0) {
    return scene.meshes[std::get<MeshInstance>(scene.objects[object].shape).mesh];
}

// A corner of a triangle of an object, in file coordinates.
inline glm::dvec3 corner(const Scene& scene, std::size_t object, std::size_t triangle, int corner) {
    const Mesh& mesh = mesh_of(scene, object);
    const glm::dvec3 p = mesh.positions[mesh.triangles[triangle][corner]];
    return scene.origin + scene.objects[object].world_from_object.point(p);
}

inline std::vector<std::string> object_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const Object& object : scene.objects)
        names.push_back(object.name);
    return names;
}

// Of all objects, as they are placed.
inline std::size_t placed_triangles(const Scene& scene) {
    std::size_t count = 0;
    for (const Object& object : scene.objects)
        count += primitive_count(scene, object);
    return count;
}

inline bool any_contains(const std::vector<std::string>& texts, std::string_view part) {
    return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
        return text.find(part) != std::string::npos;
    });
}

}  // namespace raypick
