// Where the scene is that the program opens when it is given none.
#pragma once

#include <filesystem>

namespace raypick {

// The installed default scene, else the one of the source tree that this program was built from;
// empty if there is neither.
std::filesystem::path default_scene();

}  // namespace raypick
