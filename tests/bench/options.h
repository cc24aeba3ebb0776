// What a run of the benchmarks is asked for.
#pragma once

#include "tracer/geometry/pixel.h"

#include <filesystem>
#include <string>
#include <vector>

namespace raypick::bench {

struct Options {
    bool smoke = false;  // everything once and small: does it still run?
    std::string only;    // rows whose name holds this; empty: all
    std::vector<int> threads{1, 2};
    int rounds = 5;
    std::filesystem::path json;  // empty: none
    std::filesystem::path models = RAYPICK_MODELS;
    std::filesystem::path program = RAYPICK_PROGRAM;      // raypick itself; empty: was not built
    std::filesystem::path folder = RAYPICK_BENCH_FOLDER;  // what a run writes goes there
    ImageSize size{1080, 1920};
    std::string isa;  // "avx2": both sides leave AVX-512 alone
};

// Throws std::invalid_argument that names the word it doesn't understand.
Options parse_options(const std::vector<std::string>& words);

// What --help prints.
std::string usage();

}  // namespace raypick::bench
