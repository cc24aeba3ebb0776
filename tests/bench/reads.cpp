// Reading a file, without a picture: each format against the readers that others have.
#include "tests/bench/groups.h"
#include "tests/bench/model_writers.h"
#include "tests/bench/scenes.h"
#include "tracer/io/load.h"

#include <fmt/format.h>

#ifdef RAYPICK_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#endif
#ifdef RAYPICK_HAS_TINYOBJ
#include <tiny_obj_loader.h>
#endif

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace raypick::bench {

namespace {

constexpr std::array kEndings{"obj", "ply", "stl", "glb"};
constexpr std::size_t kTriangles = 1'000'000;
constexpr std::size_t kSmokeTriangles = 20'000;

// The first triangles of a mesh with the vertices that they use.
MeshData beginning(const Mesh& mesh, std::size_t count) {
    constexpr std::uint32_t kUnused = 0xffffffffu;
    std::vector<std::uint32_t> numbers(mesh.positions.size(), kUnused);
    MeshData data;
    for (const glm::uvec3& triangle :
         mesh.triangles.first(std::min(count, mesh.triangles.size()))) {
        glm::uvec3 renumbered;
        for (int i = 0; i < 3; ++i) {
            std::uint32_t& number = numbers[triangle[i]];
            if (number == kUnused) {
                number = static_cast<std::uint32_t>(data.positions.size());
                data.positions.push_back(mesh.positions[triangle[i]]);
            }
            renumbered[i] = number;
        }
        data.triangles.push_back(renumbered);
    }
    return data;
}

void check_triangles(const std::string& who, std::size_t found, std::size_t wanted) {
    if (found == wanted) return;
    throw std::runtime_error(fmt::format("{} reads {} of {} triangles", who, found, wanted));
}

Contender ours(const std::string& name, const std::filesystem::path& file, double crease,
               std::size_t triangles) {
    return {name, [=] {
                LoadedScene loaded;
                const double seconds = seconds_of([&] {
                    LoadOptions options;
                    options.crease_degrees = crease;
                    loaded = load_scene(file, options);
                });
                check_triangles(name, loaded.scene.meshes.front().triangles.size(), triangles);
                return seconds;
            }};
}

#ifdef RAYPICK_HAS_ASSIMP
// `steps` besides making triangles.
Contender assimp(const std::string& name, const std::filesystem::path& file, unsigned steps,
                 std::size_t triangles) {
    return {name, [=] {
                Assimp::Importer importer;
                const aiScene* scene = nullptr;
                const double seconds = seconds_of([&] {
                    scene = importer.ReadFile(file.string(), aiProcess_Triangulate | steps);
                });
                if (scene == nullptr) throw std::runtime_error(importer.GetErrorString());
                std::size_t found = 0;
                for (unsigned i = 0; i < scene->mNumMeshes; ++i)
                    found += scene->mMeshes[i]->mNumFaces;
                check_triangles(name, found, triangles);
                return seconds;
            }};
}
#endif

#ifdef RAYPICK_HAS_TINYOBJ
Contender tinyobj(const std::filesystem::path& file, std::size_t triangles) {
    return {"tinyobjloader", [=] {
                tinyobj::attrib_t attributes;
                std::vector<tinyobj::shape_t> shapes;
                std::vector<tinyobj::material_t> materials;
                std::string warnings;
                std::string errors;
                const double seconds = seconds_of([&] {
                    tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &errors,
                                     file.c_str());
                });
                std::size_t found = 0;
                for (const tinyobj::shape_t& shape : shapes)
                    found += shape.mesh.num_face_vertices.size();
                check_triangles("tinyobjloader", found, triangles);
                return seconds;
            }};
}
#endif

// Ours first, then who does the same: only what the file says, or a mesh that is ready to be shown.
std::vector<Contender> bare(const std::filesystem::path& file, std::size_t triangles) {
    std::vector<Contender> contenders{ours("ours", file, 0.0, triangles)};
#ifdef RAYPICK_HAS_ASSIMP
    contenders.push_back(assimp("assimp", file, 0, triangles));
#endif
#ifdef RAYPICK_HAS_TINYOBJ
    if (file.extension() == ".obj") contenders.push_back(tinyobj(file, triangles));
#endif
    return contenders;
}

std::vector<Contender> smooth(const std::filesystem::path& file, std::size_t triangles) {
    std::vector<Contender> contenders{ours("ours", file, 30.0, triangles)};
#ifdef RAYPICK_HAS_ASSIMP
    contenders.push_back(assimp(
        "assimp", file, aiProcess_JoinIdenticalVertices | aiProcess_GenSmoothNormals, triangles));
#endif
    return contenders;
}

void measure(const std::string& name, const std::vector<Contender>& contenders, Report& report) {
    if (!report.wants(name)) return;
    for (const Contender& contender : contenders)
        contender.run();  // reading the file into the cache is nobody's work
    const std::vector<Timing> timings = alternate(contenders, report.options().rounds);
    Row row;
    row.name = name;
    row.figures = in_milliseconds(timings);
    if (const auto peer = fastest({timings.begin() + 1, timings.end()})) {
        row.result_name = peer->name + " / ours";
        row.result = ratio(*peer, timings.front());
    }
    report.add(row);
}

void name_missing_peers([[maybe_unused]] Report& report) {
#ifndef RAYPICK_HAS_ASSIMP
    report.missing("assimp (libassimp-dev), when this was built");
#endif
#ifndef RAYPICK_HAS_TINYOBJ
    report.missing("tinyobjloader (libtinyobjloader-dev), when this was built");
#endif
}

}  // namespace

void run_reads(Report& report) {
    std::vector<std::string> names;
    for (const char* ending : kEndings) {
        names.push_back(fmt::format("reads/{}/bare", ending));
        names.push_back(fmt::format("reads/{}/smooth", ending));
    }
    if (!report.wants_any(names)) return;
    name_missing_peers(report);
    const bool smoke = report.options().smoke;
    const auto file = model_file(smoke ? "bunny" : "scopia", report);
    if (!file) return;
    const LoadedScene loaded = load_scene(*file);
    const MeshData data =
        beginning(loaded.scene.meshes.front(), smoke ? kSmokeTriangles : kTriangles);
    for (std::size_t i = 0; i < kEndings.size(); ++i) {
        const std::filesystem::path model = fmt::format("reads.{}", kEndings[i]);
        write_model(data, model);
        measure(names[2 * i], bare(model, data.triangles.size()), report);
        // glTF wants meshes without normals flat.
        if (model.extension() != ".glb") {
            measure(names[2 * i + 1], smooth(model, data.triangles.size()), report);
        }
        std::filesystem::remove(model);
    }
}

}  // namespace raypick::bench
