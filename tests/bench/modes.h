// Ways to trace a list of rays, ours and Embree's, behind one shape, so that they are timed and
// checked by the same code.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/geometry/ray.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace raypick::bench {

class EmbreeScene;

// What rays met. Summed up from every answer, so that no mode gets away without giving them.
struct Tally {
    std::size_t hits = 0;
    double t = 0.0;  // sum over the hits; 0 for any-hit modes

    Tally& operator+=(const Tally& other) {
        hits += other.hits;
        t += other.t;
        return *this;
    }
};

// Threads take their rays in pieces of this many.
inline constexpr std::size_t kPiece = 4096;
inline constexpr std::size_t kMostWorkers = 64;

struct Mode {
    std::string name;
    bool ours = false;
    // The rays [begin, end), which are at most kPiece. Workers call it at the same time.
    std::function<Tally(std::size_t worker, std::size_t begin, std::size_t end)> trace;
};

// All of `count` rays.
Tally run(const Mode& mode, std::size_t count, int threads);

// The rays and what they refer to outlive the modes.
struct RayList {
    std::span<const Ray> rays;
    bool any_hit = false;  // shadow rays, which all end at `light`
    glm::dvec3 light{0.0};
    bool coherent = true;  // false: only modes for rays without order
};

std::vector<Mode> our_modes(const Accel& accel, const RayList& list);
// None where the benchmark was built without Embree.
std::vector<Mode> embree_modes(std::shared_ptr<const EmbreeScene> scene, const RayList& list);

}  // namespace raypick::bench
