// What the tests of the program's commands share: a small model and how they read the answers.
#pragma once

#include "program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace raypick {

// Two squares across the z axis, 2 x 2 at z = 0 and 4 x 4 at z = -1, seen from (0, 0, 5): the
// near one covers the middle, the far one stands out around it, then comes background.
inline constexpr const char* kSquares =
    "o near\n"
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
    "f 1 2 3 4\n"
    "o far\n"
    "v -2 -2 -1\nv 2 -2 -1\nv 2 2 -1\nv -2 2 -1\n"
    "f 5 6 7 8\n";

class CommandTest : public testing::Test {
protected:
    [[nodiscard]] std::vector<std::string> pick(std::vector<std::string> more) const {
        return command("pick", std::move(more));
    }
    [[nodiscard]] std::vector<std::string> render(std::vector<std::string> more) const {
        return command("render", std::move(more));
    }
    // The command on the squares, seen from the front.
    [[nodiscard]] std::vector<std::string> command(const std::string& name,
                                                   std::vector<std::string> more) const {
        std::vector<std::string> words = {name, squares_.string(), "--eye=0,0,5", "--look-at=0,0,0",
                                          "--fovy=60"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    TemporaryFolder folder_;
    std::filesystem::path squares_ = folder_.write("squares.obj", kSquares);
};

inline std::vector<nlohmann::json> json_lines(const std::string& text) {
    std::vector<nlohmann::json> values;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        values.push_back(nlohmann::json::parse(line));
    return values;
}

inline std::size_t line_count(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// One line "raypick: ..." on standard error, nothing on standard output.
inline void expect_refusal(const ProgramResult& result, int exit_code, const std::string& part) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_THAT(result.out, testing::IsEmpty());
    EXPECT_THAT(result.err, testing::StartsWith("raypick: "));
    EXPECT_THAT(result.err, testing::HasSubstr(part));
    EXPECT_EQ(line_count(result.err), 1u) << result.err;
}

}  // namespace raypick
