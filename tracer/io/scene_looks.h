// What a scene file says about looks: textures, materials, the environment. Each reader throws
// FileError that names the place of what is wrong; an image that can't be read is a warning, and
// something that strikes the eye is shown in its place.
#pragma once

#include "tracer/io/json_value.h"
#include "tracer/io/references.h"
#include "tracer/scene/environment.h"
#include "tracer/scene/material.h"
#include "tracer/scene/texture.h"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

// By MapSlot.
inline constexpr std::array<std::string_view, kMapSlots> kSlotNames{
    "diffuse", "specular", "shininess", "reflect", "transmit",
    "opacity", "emissive", "normal",    "ambient"};

// Where image files are looked for, and where it is said that they are missing.
struct ImageFolder {
    std::filesystem::path folder;
    std::string scene_file;  // for the warnings
    std::vector<std::string>* warnings = nullptr;
};

Texture read_scene_texture(const JsonValue& value, std::string name, const ImageFolder& images);
Material read_material(const JsonValue& value, std::string name, const References& textures);
Environment read_environment(const JsonValue& value, const ImageFolder& images);

}  // namespace raypick
