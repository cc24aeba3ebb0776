#include "tests/bench/model_writers.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>

namespace raypick::bench {

namespace {

// The machine's bytes: all of these formats are little endian, as the machines that we measure on.
template <typename T>
void append(std::string& bytes, const T& value) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.append(raw.data(), raw.size());
}

template <typename T>
void append_all(std::string& bytes, std::span<const T> values) {
    const auto raw = std::as_bytes(values);
    bytes.append(reinterpret_cast<const char*>(raw.data()), raw.size());
}

std::string obj_text(const MeshData& mesh) {
    std::string text;
    auto out = std::back_inserter(text);
    for (const glm::vec3& p : mesh.positions)
        fmt::format_to(out, "v {} {} {}\n", p.x, p.y, p.z);
    for (const glm::uvec3& t : mesh.triangles)
        fmt::format_to(out, "f {} {} {}\n", t.x + 1, t.y + 1, t.z + 1);
    return text;
}

std::string ply_bytes(const MeshData& mesh) {
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        mesh.positions.size(), mesh.triangles.size());
    append_all(bytes, std::span(mesh.positions));
    for (const glm::uvec3& t : mesh.triangles) {
        append(bytes, std::uint8_t{3});
        append(bytes, t);
    }
    return bytes;
}

std::string stl_bytes(const MeshData& mesh) {
    std::string bytes(80, ' ');
    append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const glm::uvec3& t : mesh.triangles) {
        append(bytes, glm::vec3(0.0f));  // a normal that readers are to find themselves
        for (int corner = 0; corner < 3; ++corner)
            append(bytes, mesh.positions[t[corner]]);
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

std::string glb_json(const MeshData& mesh, std::size_t index_bytes, std::size_t point_bytes) {
    glm::vec3 least = mesh.positions.front();
    glm::vec3 most = least;
    for (const glm::vec3& p : mesh.positions) {
        least = glm::min(least, p);
        most = glm::max(most, p);
    }
    std::string json = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
        R"("nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":1}},)"
        R"("indices":0}}]}}],"accessors":[{{"bufferView":0,"componentType":5125,"count":{},)"
        R"("type":"SCALAR"}},{{"bufferView":1,"componentType":5126,"count":{},"type":"VEC3",)"
        R"("min":[{},{},{}],"max":[{},{},{}]}}],"bufferViews":[{{"buffer":0,"byteLength":{}}},)"
        R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],"buffers":[{{"byteLength":{}}}]}})",
        3 * mesh.triangles.size(), mesh.positions.size(), least.x, least.y, least.z, most.x, most.y,
        most.z, index_bytes, index_bytes, point_bytes, index_bytes + point_bytes);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    return json;
}

std::string glb_bytes(const MeshData& mesh) {
    std::string content;
    append_all(content, std::span(mesh.triangles));
    const std::size_t index_bytes = content.size();
    append_all(content, std::span(mesh.positions));
    const std::string json = glb_json(mesh, index_bytes, content.size() - index_bytes);
    std::string bytes = "glTF";
    append(bytes, std::uint32_t{2});
    append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + content.size()));
    append(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    append(bytes, static_cast<std::uint32_t>(content.size()));
    bytes.append("BIN\0", 4);
    return bytes + content;
}

std::string bytes_of(const MeshData& mesh, const std::string& ending) {
    if (ending == ".obj") return obj_text(mesh);
    if (ending == ".ply") return ply_bytes(mesh);
    if (ending == ".stl") return stl_bytes(mesh);
    if (ending == ".glb") return glb_bytes(mesh);
    throw std::runtime_error("nobody writes " + ending);
}

}  // namespace

void write_model(const MeshData& mesh, const std::filesystem::path& file) {
    std::ofstream out(file, std::ios::binary);
    out << bytes_of(mesh, file.extension().string());
    out.close();
    if (!out) throw std::runtime_error(fmt::format("can't write {}", file.string()));
}

}  // namespace raypick::bench
