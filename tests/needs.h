// What a test needs from its surroundings. At home a test without it skips and says why; in CI
// (environment variable CI=true) it fails, so that nothing is skipped unseen.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace raypick {

inline bool in_ci() {
    const char* ci = std::getenv("CI");
    return ci != nullptr && std::string(ci) == "true";
}

// A real model by its path below the models folder, e.g. "stanford/bunny_binary.ply".
inline std::filesystem::path model(const std::string& relative) {
    return std::filesystem::path(RAYPICK_MODELS) / relative;
}

// One of our own scenes, e.g. "default.json".
inline std::filesystem::path asset(const std::string& relative) {
    return std::filesystem::path(RAYPICK_ASSETS) / relative;
}

}  // namespace raypick

// Skips (in CI: fails) the running test, with the reason, unless `condition` holds.
#define RAYPICK_REQUIRE(condition, reason)                            \
    if (!(condition)) {                                               \
        if (raypick::in_ci()) FAIL() << "needed in CI: " << (reason); \
        GTEST_SKIP() << (reason);                                     \
    }                                                                 \
    static_assert(true)

// The same for a real model.
#define RAYPICK_REQUIRE_MODEL(relative)                                \
    RAYPICK_REQUIRE(std::filesystem::exists(raypick::model(relative)), \
                    raypick::model(relative).string() + " is not there")
