// The groups of rows.
#pragma once

#include "tests/bench/report.h"

namespace raypick::bench {

void run_kernels(Report& report);  // rays per second against Embree's single, packets and streams
void run_frames(Report& report);   // whole pictures against Embree, POV-Ray and Tachyon
void run_builds(Report& report);   // trees against Embree's
void run_loads(Report& report);    // from start to picture against F3D
void run_reads(Report& report);    // files against assimp and tinyobjloader
void run_picks(Report& report);    // one pick through the public call
void run_memory(Report& report);   // bytes a triangle, resident and at the peak of a build

// What the memory rows start as a process of its own: loads and builds one model by `builder`
// ("ours" or "embree") and prints what it took.
int build_and_weigh(const std::string& model, const std::string& builder, const Options& options);

}  // namespace raypick::bench
