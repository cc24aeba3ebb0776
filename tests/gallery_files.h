// The scenes of assets/gallery, as parameters of tests.
#pragma once

#include "needs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

namespace raypick {

// The files' names, in order.
inline std::vector<std::string> gallery_files() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(asset("gallery"))) {
        const std::string ending = entry.path().extension().string();
        if (ending == ".json" || ending == ".nff") {
            names.push_back(entry.path().filename().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

inline std::string gallery_test_name(const testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
}

}  // namespace raypick
