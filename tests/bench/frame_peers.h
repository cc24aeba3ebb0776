// Other ray tracers that make the same picture.
#pragma once

#include "tests/bench/report.h"
#include "tests/bench/scenes.h"
#include "tracer/shade/settings.h"

#include <functional>
#include <string>
#include <vector>

namespace raypick::bench {

struct FramePeer {
    std::string name;
    // Writes the scene's file; what it returns traces it with so many threads and says how many
    // seconds the program itself gives for tracing. Throws std::exception where that fails.
    std::function<std::function<double(int threads)>(const View& view, ImageSize size,
                                                     const RenderSettings& settings)>
        prepare;
};

// Those that are installed; the others are missing in the report.
std::vector<FramePeer> frame_peers(Report& report);

}  // namespace raypick::bench
