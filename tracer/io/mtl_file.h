// Wavefront material libraries.
#pragma once

#include "tracer/io/imported_material.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace raypick {

// By name; a later definition of a name replaces the earlier one. Throws FileError with the line.
using MtlLibrary = std::map<std::string, MtlMaterial, std::less<>>;
void read_mtl(const std::filesystem::path& file, MtlLibrary& library,
              std::vector<std::string>& warnings);

// Finds the files that an OBJ's mtllib line names, beside the OBJ (find_named_file): the whole rest
// of the line as one name, else its words. Names that lead nowhere come back as they are in
// `missing`.
struct MtlPaths {
    std::vector<std::filesystem::path> found;
    std::vector<std::string> missing;
};
MtlPaths find_mtl(const std::filesystem::path& obj_file, const std::string& names);

}  // namespace raypick
