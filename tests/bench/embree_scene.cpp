#include "tests/bench/embree_scene.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <stdexcept>
#include <variant>

#ifndef RAYPICK_HAS_EMBREE

namespace raypick::bench {

std::string describe_embree(const EmbreeSettings&) {
    return "";
}

}  // namespace raypick::bench

#else

namespace raypick::bench {

namespace {

std::string config(const EmbreeSettings& settings) {
    std::string text;
    if (settings.threads > 0) text += fmt::format("threads={},", settings.threads);
    if (!settings.isa.empty()) text += fmt::format("isa={},", settings.isa);
    return text;
}

RTCBuildQuality quality_of(const EmbreeSettings& settings) {
    switch (settings.quality) {
        case EmbreeQuality::low:
            return RTC_BUILD_QUALITY_LOW;
        case EmbreeQuality::high:
            return RTC_BUILD_QUALITY_HIGH;
        case EmbreeQuality::medium:
            break;
    }
    return RTC_BUILD_QUALITY_MEDIUM;
}

[[noreturn]] void no_equivalent(const std::string& what) {
    throw std::invalid_argument("Embree has no " + what);
}

bool count_bytes(void* sum, ssize_t bytes, bool) {
    std::atomic_ref(*static_cast<std::size_t*>(sum)) += static_cast<std::size_t>(bytes);
    return true;
}

// Triangles of a shape that is few of them.
Mesh mesh_of(std::vector<glm::vec3> corners, std::vector<glm::uvec3> triangles) {
    MeshData data;
    data.positions = std::move(corners);
    data.triangles = std::move(triangles);
    return make_mesh("", std::move(data));
}

Mesh mesh_of(const Triangle& t) {
    return mesh_of({glm::vec3(t.a), glm::vec3(t.b), glm::vec3(t.c)}, {{0, 1, 2}});
}

Mesh mesh_of(const Rectangle& r) {
    return mesh_of({glm::vec3(r.corner), glm::vec3(r.corner + r.edge_u),
                    glm::vec3(r.corner + r.edge_u + r.edge_v), glm::vec3(r.corner + r.edge_v)},
                   {{0, 1, 2}, {0, 2, 3}});
}

// Radii stay what they are.
void must_be_moved_only(const Transform& transform, const char* what) {
    if (transform.linear != glm::dmat3(1.0)) no_equivalent(fmt::format("scaled {}", what));
}

}  // namespace

std::string describe_embree(const EmbreeSettings& settings) {
    RTCDevice device = rtcNewDevice(config(settings).c_str());
    const auto has = [device](RTCDeviceProperty property) {
        return rtcGetDeviceProperty(device, property) != 0 ? "yes" : "no";
    };
    const std::string text = fmt::format(
        "Embree {}: build quality medium, robust off, denormals flushed to zero, isa {}; packets "
        "of "
        "8 native: {}, of 16: {}, streams: {}",
        RTC_VERSION_STRING, settings.isa.empty() ? "the best" : settings.isa,
        has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED),
        has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED),
        has(RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED));
    rtcReleaseDevice(device);
    return text;
}

RTCRay embree_ray(const Ray& ray) {
    RTCRay r{};
    r.org_x = ray.origin.x;
    r.org_y = ray.origin.y;
    r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.tnear = ray.t_min;
    r.tfar = ray.t_max;
    r.mask = 0xffffffffu;
    return r;
}

EmbreeScene::EmbreeScene(std::shared_ptr<const Scene> scene, const EmbreeSettings& settings)
    : source_(std::move(scene)),
      settings_(settings),
      shared_(source_->meshes.size(), nullptr),
      uses_(source_->meshes.size(), 0) {
    device_ = rtcNewDevice(config(settings_).c_str());
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
    scene_ = new_scene();
    for (const Object& object : source_->objects) {
        if (const auto* instance = std::get_if<MeshInstance>(&object.shape))
            ++uses_[instance->mesh];
    }
    for (std::uint32_t i = 0; i < source_->objects.size(); ++i)
        attach(i);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree refuses");
}

EmbreeScene::~EmbreeScene() {
    for (RTCGeometry geometry : geometries_)
        rtcReleaseGeometry(geometry);
    for (RTCScene shared : shared_) {
        if (shared != nullptr) rtcReleaseScene(shared);
    }
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void EmbreeScene::commit() {
    for (RTCGeometry geometry : geometries_)
        rtcCommitGeometry(geometry);
    for (RTCScene shared : shared_) {
        if (shared != nullptr) rtcCommitScene(shared);
    }
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
        throw std::runtime_error("Embree can't build");
}

RTCScene EmbreeScene::new_scene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene, quality_of(settings_));
    return scene;
}

void EmbreeScene::attach(std::uint32_t index) {
    const Object& object = source_->objects[index];
    const Transform& place = object.world_from_object;
    if (const auto* instance = std::get_if<MeshInstance>(&object.shape)) {
        attach_instance(*instance, place, index);
    } else if (const auto* spheres = std::get_if<SphereSetInstance>(&object.shape)) {
        attach_balls(source_->sphere_sets[spheres->set].spheres, place, index);
    } else if (const auto* cones = std::get_if<ConeSetInstance>(&object.shape)) {
        const ConeSet& set = source_->cone_sets[cones->set];
        if (!set.capped) no_equivalent("open cones");
        attach_cones(set.ends, place, index);
    } else if (const auto* sphere = std::get_if<Sphere>(&object.shape)) {
        const glm::vec4 ball(glm::dvec4(sphere->centre, sphere->radius));
        attach_balls({&ball, 1}, place, index);
    } else if (const auto* triangle = std::get_if<Triangle>(&object.shape)) {
        attach_mesh(mesh_of(*triangle), place, index);
    } else if (const auto* rectangle = std::get_if<Rectangle>(&object.shape)) {
        attach_mesh(mesh_of(*rectangle), place, index);
    } else {
        no_equivalent(fmt::format("shape of object {}", object.name));
    }
}

void EmbreeScene::attach_instance(const MeshInstance& instance, const Transform& world_from_object,
                                  std::uint32_t index) {
    const Mesh& mesh = source_->meshes[instance.mesh];
    if (mesh.triangles.empty()) return;
    if (uses_[instance.mesh] == 1) {
        attach_mesh(mesh, world_from_object, index);
        return;
    }
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, shared_scene(instance.mesh));
    std::array<float, 12> columns{};
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 column =
            i < 3 ? world_from_object.linear[i] : world_from_object.translation;
        for (int k = 0; k < 3; ++k)
            columns[static_cast<std::size_t>(3 * i + k)] = static_cast<float>(column[k]);
    }
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    finish(geometry, scene_, index);
}

RTCScene EmbreeScene::shared_scene(MeshId mesh) {
    if (shared_[mesh] == nullptr) {
        shared_[mesh] = new_scene();
        finish(triangles(source_->meshes[mesh], {}), shared_[mesh], 0);
    }
    return shared_[mesh];
}

void EmbreeScene::attach_mesh(const Mesh& mesh, const Transform& world_from_object,
                              std::uint32_t index) {
    finish(triangles(mesh, world_from_object), scene_, index);
}

// Embree reads 16 bytes of the last vertex, so that it can't share an array which ends there.
RTCGeometry EmbreeScene::triangles(const Mesh& mesh, const Transform& world_from_object) {
    std::vector<float>& vertices = vertices_.emplace_back();
    vertices.reserve(3 * mesh.positions.size() + 1);
    for (const glm::vec3& position : mesh.positions) {
        const glm::vec3 p(world_from_object.point(glm::dvec3(position)));
        vertices.insert(vertices.end(), {p.x, p.y, p.z});
    }
    vertices.push_back(0.0f);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               vertices.data(), 0, sizeof(glm::vec3), mesh.positions.size());
    auto* first = static_cast<glm::uvec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(glm::uvec3), mesh.triangles.size()));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), first);
    return geometry;
}

void EmbreeScene::attach_balls(std::span<const glm::vec4> balls, const Transform& world_from_object,
                               std::uint32_t index) {
    must_be_moved_only(world_from_object, "spheres");
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* ball = static_cast<glm::vec4*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(glm::vec4), balls.size()));
    for (const glm::vec4& b : balls)
        *ball++ = glm::vec4(glm::vec3(world_from_object.point(glm::dvec3(b))), b.w);
    finish(geometry, scene_, index);
}

// Each a curve of its own, which Embree closes at both ends.
void EmbreeScene::attach_cones(std::span<const glm::vec4> ends, const Transform& world_from_object,
                               std::uint32_t index) {
    must_be_moved_only(world_from_object, "cones");
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE);
    auto* end = static_cast<glm::vec4*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(glm::vec4), ends.size()));
    for (const glm::vec4& e : ends)
        *end++ = glm::vec4(glm::vec3(world_from_object.point(glm::dvec3(e))), e.w);
    auto* first = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                                sizeof(std::uint32_t), ends.size() / 2));
    for (std::uint32_t i = 0; i < ends.size() / 2; ++i)
        *first++ = 2 * i;
    finish(geometry, scene_, index);
}

void EmbreeScene::finish(RTCGeometry geometry, RTCScene scene, std::uint32_t index) {
    rtcSetGeometryBuildQuality(geometry, quality_of(settings_));
    rtcAttachGeometryByID(scene, geometry, index);
    geometries_.push_back(geometry);
}

}  // namespace raypick::bench

#endif
