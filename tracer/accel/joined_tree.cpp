#include "tracer/accel/joined_tree.h"

#include "tracer/accel/triangle_box.h"
#include "tracer/error.h"
#include "tracer/geometry/finite.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <variant>

namespace raypick {

JoinedMember member_of(const Mesh& mesh) {
    return {JoinedMember::Kind::mesh, arrays_of(mesh), mesh.triangles.size()};
}
JoinedMember member_of(const SphereSet& set) {
    return {JoinedMember::Kind::spheres, arrays_of(set), set.spheres.size()};
}
JoinedMember member_of(const ConeSet& set) {
    const auto kind =
        set.capped ? JoinedMember::Kind::capped_cones : JoinedMember::Kind::open_cones;
    return {kind, arrays_of(set), set.size()};
}

Uses::Uses(const Scene& scene)
    : meshes(scene.meshes.size()),
      sphere_sets(scene.sphere_sets.size()),
      cone_sets(scene.cone_sets.size()) {
    for (const Object& object : scene.objects) {
        if (std::uint32_t* uses = of(object.shape)) ++*uses;
    }
}

std::uint32_t* Uses::of(const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshInstance>(&shape)) return &meshes[mesh->mesh];
    if (const auto* set = std::get_if<SphereSetInstance>(&shape)) return &sphere_sets[set->set];
    if (const auto* set = std::get_if<ConeSetInstance>(&shape)) return &cone_sets[set->set];
    return nullptr;
}

namespace {

// Whether the object has its shape as it is, and no other has that.
bool stands_alone(const Object& object, Uses& uses) {
    const std::uint32_t* of_shape = uses.of(object.shape);
    return of_shape != nullptr && *of_shape == 1 && object.world_from_object.is_identity();
}

// With triangles, where one object has them as they are and no other has them.
std::vector<JoinableMesh> meshes_in_place(const Scene& scene) {
    Uses uses(scene);
    std::vector<JoinableMesh> meshes;
    for (const Object& object : scene.objects) {
        const auto* instance = std::get_if<MeshInstance>(&object.shape);
        if (instance == nullptr || !stands_alone(object, uses)) continue;
        const Mesh& mesh = scene.meshes[instance->mesh];
        if (!mesh.triangles.empty()) meshes.push_back({&mesh, {}});
    }
    return meshes;
}

// The same of sets: those of spheres, then those of cones.
std::vector<JoinableSet> sets_in_place(const Scene& scene) {
    Uses uses(scene);
    std::vector<JoinableSet> spheres;
    std::array<std::vector<JoinableSet>, 2> cones;  // open ones, capped ones
    std::array<std::size_t, 2> cone_count{};
    for (const Object& object : scene.objects) {
        if (!stands_alone(object, uses)) continue;
        if (const auto* of_spheres = std::get_if<SphereSetInstance>(&object.shape)) {
            const SphereSet& set = scene.sphere_sets[of_spheres->set];
            if (!set.spheres.empty()) spheres.push_back({&set, nullptr, {}});
        } else if (const auto* of_cones = std::get_if<ConeSetInstance>(&object.shape)) {
            const ConeSet& set = scene.cone_sets[of_cones->set];
            const std::size_t kind = set.capped ? 1 : 0;
            if (set.size() != 0) cones[kind].push_back({nullptr, &set, {}});
            cone_count[kind] += set.size();
        }
    }
    const std::vector<JoinableSet>& more = cones[cone_count[1] > cone_count[0] ? 1 : 0];
    spheres.insert(spheres.end(), more.begin(), more.end());
    return spheres;
}

Bounds primitive_box(const JoinableMesh& joinable, std::size_t i) {
    return triangle_box(*joinable.mesh, i);
}
Bounds primitive_box(const JoinableSet& joinable, std::size_t i) {
    return joinable.element_bounds(i);
}

std::size_t size_of(const JoinableMesh& joinable) {
    return joinable.mesh->triangles.size();
}
std::size_t size_of(const JoinableSet& joinable) {
    return joinable.size();
}

// What has no finite box is in no tree.
template <typename Joinable>
void measure(std::vector<Joinable>& things, const BuildOptions& options) {
    constexpr std::size_t kChunk = 1u << 16;  // primitives of one thing
    struct Chunk {
        std::size_t thing, first;
        Bounds bounds{};
    };
    std::vector<Chunk> chunks;
    for (std::size_t i = 0; i < things.size(); ++i) {
        for (std::size_t first = 0; first < size_of(things[i]); first += kChunk)
            chunks.push_back({i, first});
    }
    parallel_for(chunks.size(), options.threads, options.stop, [&](std::size_t i) {
        Chunk& chunk = chunks[i];
        const Joinable& thing = things[chunk.thing];
        const std::size_t end = std::min(size_of(thing), chunk.first + kChunk);
        for (std::size_t k = chunk.first; k < end; ++k) {
            const Bounds box = primitive_box(thing, k);
            if (all_finite(glm::dvec3(box.min)) && all_finite(glm::dvec3(box.max))) {
                chunk.bounds.extend(box);
            }
        }
    });
    if (options.stop.stop_requested()) throw Cancelled();
    for (const Chunk& chunk : chunks)
        things[chunk.thing].bounds.extend(chunk.bounds);
}

// Whether a ray through everything would enter so many boxes of the things on average, and there
// are no more primitives than can be joined.
template <typename Joinable>
bool worth_joining(const std::vector<Joinable>& things, float boxes, std::size_t most) {
    Bounds all;
    float area = 0.0f;
    std::size_t primitives = 0;
    for (const Joinable& joinable : things) {
        all.extend(joinable.bounds);
        area += joinable.bounds.half_area();
        primitives += size_of(joinable);
    }
    return area >= boxes * all.half_area() && primitives <= most;
}

// Gone: the shape has neither a mesh nor a set.
JoinedMember member_of(const Scene& scene, const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshInstance>(&shape)) {
        return member_of(scene.meshes[mesh->mesh]);
    }
    if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
        return member_of(scene.sphere_sets[spheres->set]);
    }
    if (const auto* cones = std::get_if<ConeSetInstance>(&shape)) {
        return member_of(scene.cone_sets[cones->set]);
    }
    return {};
}

}  // namespace

std::vector<JoinableMesh> joinable_meshes(const Scene& scene, const BuildOptions& options) {
    // Sponza, cut into 34 by material, has 7.5, and a kitchen of 299 things 3.7: there trees of
    // their own are as good.
    constexpr float kInEachOthersWay = 5.0f;
    std::vector<JoinableMesh> meshes = meshes_in_place(scene);
    if (static_cast<float>(meshes.size()) < kInEachOthersWay) return {};
    measure(meshes, options);
    if (meshes.size() > JoinedMeshes::kMostMeshes ||
        !worth_joining(meshes, kInEachOthersWay, JoinedMeshes::kMostTriangles)) {
        meshes.clear();
    }
    return meshes;
}

std::vector<JoinableSet> joinable_sets(const Scene& scene, const BuildOptions& options) {
    // Two that fill the same space have 2.
    constexpr float kInEachOthersWay = 1.5f;
    std::vector<JoinableSet> sets = sets_in_place(scene);
    if (sets.size() < 2) return {};
    measure(sets, options);
    if (!worth_joining(sets, kInEachOthersWay, JoinedSets::kMostElements)) sets.clear();
    return sets;
}

std::vector<std::uint32_t> objects_of_members(const Scene& scene,
                                              const std::vector<JoinedMember>& members) {
    std::map<JoinedMember, std::size_t> numbers;
    for (std::size_t i = 0; i < members.size(); ++i)
        numbers.emplace(members[i], i);
    std::vector<std::uint32_t> objects(members.size(), kNobody);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const JoinedMember member = member_of(scene, object.shape);
        if (member.kind == JoinedMember::Kind::gone) continue;
        if (!object.world_from_object.is_identity()) continue;
        const auto found = numbers.find(member);
        if (found == numbers.end() || objects[found->second] != kNobody) continue;
        objects[found->second] = static_cast<std::uint32_t>(i);
    }
    return objects;
}

std::vector<JoinedMember> members_left(const Scene& scene, std::vector<JoinedMember> members) {
    std::set<JoinedMember> there;
    for (const Mesh& mesh : scene.meshes)
        there.insert(member_of(mesh));
    for (const SphereSet& set : scene.sphere_sets)
        there.insert(member_of(set));
    for (const ConeSet& set : scene.cone_sets)
        there.insert(member_of(set));
    for (JoinedMember& member : members) {
        if (!there.contains(member)) member = {};
    }
    return members;
}

}  // namespace raypick
