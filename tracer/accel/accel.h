// The compiled, immutable form of a scene that rays run on.
#pragma once

#include "tracer/accel/crossings.h"
#include "tracer/accel/hit.h"
#include "tracer/geometry/ray.h"
#include "tracer/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace raypick {

// What the trees over primitives are built for; hits are the same on all.
enum class TreeQuality {
    first,      // to be there soon, for some picks: three times as fast to build
    many_rays,  // frames
};

struct BuildOptions {
    int threads = 0;         // 0: all cores. The tree is the same for any number
    std::stop_token stop{};  // building then throws Cancelled
    TreeQuality quality = TreeQuality::many_rays;
};

struct AccelStats {
    std::uint64_t triangles = 0;  // of unique meshes
    std::uint64_t spheres = 0;    // of unique sets
    std::uint64_t cones = 0;
    std::uint64_t nodes = 0;
    std::uint64_t bytes = 0;
};

// Two levels: one tree a mesh or set, shared by its instances and by later Accels of an edited
// scene, and one tree over the objects. For many rays meshes that stand where they are and nowhere
// else share one, and so do sets, if they are in each other's way. All queries are const and may
// run on many threads at once.
// A ray with a NaN hits nothing; a t_min below 0 counts as 0.
class Accel {
public:
    // Builds for a snapshot of a scene. Meshes whose arrays also stand in `reuse` keep their trees
    // from there, unless these are of a lower quality than asked for: moving an object rebuilds
    // the top level only, and the first time builds a tree for what shared one. Throws Error
    // (check_scene) or Cancelled.
    explicit Accel(std::shared_ptr<const Scene> scene, const BuildOptions& options = {},
                   const Accel* reuse = nullptr);
    ~Accel();
    Accel(Accel&&) noexcept;
    Accel& operator=(Accel&&) noexcept;
    Accel(const Accel&) = delete;
    Accel& operator=(const Accel&) = delete;

    // Closest hit; ties go to the lowest (object, primitive).
    [[nodiscard]] std::optional<Hit> intersect(const Ray& ray, const RayQuery& query = {}) const;
    // Any hit.
    [[nodiscard]] bool occluded(const Ray& ray, const RayQuery& query = {}) const;
    // Every hit along the ray, by t, then by (object, primitive).
    [[nodiscard]] std::vector<Hit> intersect_all(const Ray& ray, const RayQuery& query = {}) const;

    // Batches: the same answers as one by one. `hits` (invalid on a miss) and `blocked` (0 or 1)
    // are as long as `rays`.
    void intersect(std::span<const Ray> rays, std::span<Hit> hits,
                   const RayQuery& query = {}) const;
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                  const RayQuery& query = {}) const;
    // The same, faster for rays that end at one point or shortly before it, as shadow rays of a
    // point light do. Others get their answers as well.
    void occluded_towards(const glm::vec3& end, std::span<const Ray> rays,
                          std::span<std::uint8_t> blocked, const RayQuery& query = {}) const;
    // What the rays cross of everything that is clear, as far as nothing else blocks them. `clear`
    // is of this scene. The second is faster for rays that end at a point, see above.
    void cross(std::span<const Ray> rays, const Clearness& clear, Crossings& crossings,
               const RayQuery& query = {}) const;
    void cross_towards(const glm::vec3& end, std::span<const Ray> rays, const Clearness& clear,
                       Crossings& crossings, const RayQuery& query = {}) const;

    [[nodiscard]] const Scene& scene() const;
    [[nodiscard]] std::shared_ptr<const Scene> shared_scene() const;
    // The inverse of an object's transform, by its place in scene().objects.
    [[nodiscard]] const Transform& object_from_world(std::size_t object_index) const;
    // Of all finite objects.
    [[nodiscard]] const Bounds& bounds() const;
    [[nodiscard]] AccelStats stats() const;

private:
    struct State;
    std::unique_ptr<const State> state_;
};

}  // namespace raypick
