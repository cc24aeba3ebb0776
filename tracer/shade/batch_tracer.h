// trace() for many eye rays at once, breadth first: all rays of one depth are followed together, so
// that those which go the same way can share the work of finding what they hit.
#pragma once

#include "tracer/parallel/large_array.h"
#include "tracer/shade/arrivals.h"
#include "tracer/shade/boundary.h"
#include "tracer/shade/branches.h"
#include "tracer/shade/eye_ray.h"
#include "tracer/shade/generation.h"
#include "tracer/shade/light_pass.h"
#include "tracer/shade/lit_points.h"
#include "tracer/shade/ray_counts.h"
#include "tracer/shade/shade_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <stop_token>
#include <vector>

namespace raypick {

// Keeps its memory from call to call; one a thread.
//
// Rays of a generation are followed in the order of their directions' octants, and what they bring
// back is added up in the order in which they left: results are those of trace() to the bit,
// whatever rays travel together. A generation goes on in portions, each with all that comes after
// it before the next one: glass spawns 2^depth rays, but only so many of each depth are there at
// the same time.
class BatchTracer {
public:
    // Sets the results, which are as many, to what trace() finds for `eyes`, and adds the rays to
    // `counts`. Once `stop` is requested no more rays are shot, and the results are worthless,
    // if they are set at all.
    void trace(const ShadeScene& scene, const EyeRays& eyes, TracedRays& results, RayCounts& counts,
               const std::stop_token& stop = {});

private:
    // What one call of trace() is about.
    struct Job {
        const ShadeScene& scene;
        const EyeRays& eyes;
        TracedRays& results;
        RayCounts& counts;
        const std::stop_token& stop;
    };
    // The generation at work and the one that it sends on.
    struct Step {
        const Job& job;
        int depth = 1;
        Generation& at;
        Generation& next;

        [[nodiscard]] bool notes_normals() const { return depth == 1 && job.results.has_hits(); }
    };

    Generation& generation(int depth);
    void begin(const EyeRays& eyes);
    // All but the share.
    static void set_begun(RayPath& path, std::uint32_t parent, const RayCone& cone, float weight,
                          std::uint64_t seed);
    void follow(const Job& job, int depth);
    void follow_portion(const Step& step, std::span<const std::uint32_t> portion);
    void find_points(const Step& step);
    void keep_hidden();
    void load_rays(const Step& step, std::span<const std::uint32_t> portion);
    void intersect_groups(const Step& step);
    void note_first_hits(const Job& job);
    void arrive(const Step& step, int hidden, const Arrivals::Block& block);
    void arrive_simply(const Step& step, RayPath& path, const PreparedMaterial& material,
                       std::size_t i, std::size_t point);
    void arrive(const Step& step, int hidden, const FoundHit& found, std::size_t i,
                std::size_t point);
    std::size_t see_sky(const Step& step, std::size_t i);
    void send_branches(const Step& step, std::uint32_t from, const ShadingPoint& point,
                       const Boundary& boundary);
    void want_mirrored(const Step& step, std::size_t point, const PreparedMaterial& material);
    void send_mirrored(const Step& step);
    void light_points(const Step& step);

    std::deque<Generation> generations_;  // by depth - 1

    // Of the portion at work: all that is resized is written before it is read.
    LargeArray<std::uint32_t> at_work_;  // rays on their way
    LargeArray<std::uint8_t> directions_;
    LargeArray<Ray> loaded_;
    std::span<const Ray> rays_;
    LargeArray<Hit> hits_;
    Arrivals arrivals_;
    std::array<FoundHit, Arrivals::kLanes> found_;  // of a block
    // A ray that goes on through a hidden surface, by its number among those at work.
    struct HiddenAt {
        std::uint32_t i = 0;
        Ray onwards;
    };
    std::vector<HiddenAt> hidden_;
    Crossing crossing_;
    Branches branches_;
    SurfaceMaterial with_maps_;  // of the ray that arrives
    LitPoints points_;
    // A point that sends on a mirrored ray and nothing else.
    struct Mirrored {
        const PreparedMaterial* material = nullptr;
        std::uint32_t point = 0;
        float weight = 0.0f;  // the ray's
    };
    std::vector<Mirrored> mirrored_;
    LightPass light_pass_;
};

}  // namespace raypick
