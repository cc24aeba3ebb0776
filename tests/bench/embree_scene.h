// A scene of ours as one Embree 3 scene, as someone who uses Embree would build it.
#pragma once

#include "tests/bench/modes.h"
#include "tracer/geometry/ray.h"
#include "tracer/scene/scene.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#ifdef RAYPICK_HAS_EMBREE
#include <embree3/rtcore.h>
#endif

namespace raypick::bench {

// How Embree is asked to build.
enum class EmbreeQuality { low, medium, high };

struct EmbreeSettings {
    EmbreeQuality quality = EmbreeQuality::medium;  // Embree's default
    std::string isa;                                // "avx2"; empty: the best that the machine has
    int threads = 0;                                // of the build; 0: all
};

// What the settings come to, for the report: version, instruction set, flags.
std::string describe_embree(const EmbreeSettings& settings);

#ifdef RAYPICK_HAS_EMBREE

// One of ours as Embree takes it.
RTCRay embree_ray(const Ray& ray);

// Every object is one geometry, its id the object's index: triangles over shared buffers, sphere
// points, cone curves. What is used once is flattened to world space, which is Embree's fastest
// form; a mesh that several objects share is a scene of its own with instances. Not robust, as most
// users have it. Building (commit) is apart from filling in.
class EmbreeScene {
public:
    // Throws std::invalid_argument that names a shape which Embree has no equivalent for.
    EmbreeScene(std::shared_ptr<const Scene> scene, const EmbreeSettings& settings);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    // Builds all trees.
    void commit();

    [[nodiscard]] RTCScene handle() const { return scene_; }
    [[nodiscard]] const Scene& source() const { return *source_; }
    // What Embree says that it has allocated.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

private:
    void attach(std::uint32_t index);
    void attach_mesh(const Mesh& mesh, const Transform& world_from_object, std::uint32_t index);
    void attach_instance(const MeshInstance& instance, const Transform& world_from_object,
                         std::uint32_t index);
    void attach_balls(std::span<const glm::vec4> balls, const Transform& world_from_object,
                      std::uint32_t index);
    void attach_cones(std::span<const glm::vec4> ends, const Transform& world_from_object,
                      std::uint32_t index);
    void finish(RTCGeometry geometry, RTCScene scene, std::uint32_t index);
    RTCGeometry triangles(const Mesh& mesh, const Transform& world_from_object);
    RTCScene shared_scene(MeshId mesh);
    [[nodiscard]] RTCScene new_scene() const;

    std::shared_ptr<const Scene> source_;
    EmbreeSettings settings_;
    std::size_t bytes_ = 0;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    std::vector<RTCGeometry> geometries_;       // not yet committed
    std::vector<RTCScene> shared_;              // by mesh; null where there is none
    std::vector<std::size_t> uses_;             // of each mesh
    std::vector<std::vector<float>> vertices_;  // what the shared buffers point to
};

#endif

}  // namespace raypick::bench
