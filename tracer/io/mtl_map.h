// The map lines of a Wavefront material library: map_Kd -s 2 2 1 -clamp on wood.png
//
// Source: Wavefront, "MTL material format", 1995, section "Texture map statements".
#pragma once

#include "tracer/io/text_scanner.h"
#include "tracer/scene/texture.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

enum class MtlMapKind {
    diffuse,
    specular,
    shininess,
    opacity,
    transparency,
    emissive,
    bump,
    normal
};

// `use` has everything but the texture: the affine rows of -s and -o, wraps of -clamp, filter of
// -blendu and -blendv, base and gain of -mm.
struct MtlMap {
    MtlMapKind kind = MtlMapKind::diffuse;
    TextureMap use;
    double bump = 1.0;             // -bm
    char channel = '\0';           // -imfchan: r g b m l z; 0: not said
    std::string file;              // as the line spells it
    std::filesystem::path folder;  // of the library
    std::string place;             // "a.mtl: line 3: material "wood""
};

// The kind of a map keyword, in any case; nothing if it is none that is read.
std::optional<MtlMapKind> mtl_map_kind(std::string_view keyword);
// Is it the keyword of a texture at all: map_*, bump, disp, decal, refl, norm?
bool is_mtl_map(std::string_view keyword);

// Reads the rest of the line. Nothing, and a warning, if it names no file.
std::optional<MtlMap> read_mtl_map(TextScanner& scanner, MtlMapKind kind, std::string_view material,
                                   std::vector<std::string>& warnings);

// Finds a file that an MTL or OBJ names: as it is named, relative to one of the folders, else (an
// absolute path from another machine) by its last name in them; backslashes are folders too and the
// case of the last name does not matter.
std::optional<std::filesystem::path> find_named_file(
    const std::vector<std::filesystem::path>& folders, const std::string& name);

}  // namespace raypick
