#include "viewer/gl/shader_source.h"

#include "tracer/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace raypick {

namespace {

std::string read_from(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw Error("shader " + file.string() + " cannot be read (RAYPICK_SHADER_DIR)");
    return text.str();
}

std::string shader_text(std::string_view name) {
    if (const auto folder = shader_folder()) return read_from(*folder / name);
    for (const EmbeddedShader& shader : embedded_shaders()) {
        if (shader.name == name) return std::string(shader.text);
    }
    throw Error(fmt::format("there is no shader {}", name));
}

// The name in `#include "name"`; nothing for other lines.
std::optional<std::string> included_name(const std::string& line) {
    constexpr std::string_view kBegin = "#include \"";
    if (line.compare(0, kBegin.size(), kBegin) != 0) return std::nullopt;
    const std::size_t end = line.find('"', kBegin.size());
    if (end == std::string::npos) return std::nullopt;
    return line.substr(kBegin.size(), end - kBegin.size());
}

void append_file(ShaderSource& source, std::string_view name) {
    if (std::find(source.files.begin(), source.files.end(), name) != source.files.end()) return;
    const std::size_t number = source.files.size();
    source.files.emplace_back(name);
    source.text += fmt::format("#line 1 {}\n", number);
    std::istringstream lines(shader_text(name));
    int line_number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++line_number;
        if (const auto other = included_name(line)) {
            append_file(source, *other);
            source.text += fmt::format("#line {} {}\n", line_number + 1, number);
        } else {
            source.text += line + "\n";
        }
    }
}

}  // namespace

std::optional<std::filesystem::path> shader_folder() {
    const char* folder = std::getenv("RAYPICK_SHADER_DIR");
    if (folder == nullptr || *folder == '\0') return std::nullopt;
    return std::filesystem::path(folder);
}

ShaderSource shader_source(std::string_view name, std::span<const std::string> defines) {
    ShaderSource source;
    source.text = "#version 330 core\n";
    for (const std::string& define : defines)
        source.text += "#define " + define + "\n";
    append_file(source, name);
    return source;
}

}  // namespace raypick
