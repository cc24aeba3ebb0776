#include "picking/pick.h"

#include "picking/json.h"

namespace raypick {
namespace {

std::optional<Pick> described(const Accel& accel, const Ray& ray, const std::optional<Hit>& hit) {
    if (!hit) return std::nullopt;
    return describe(accel, ray, *hit);
}

template <typename Value>
void append_field(std::string& out, std::string_view key, const Value& value) {
    out += ",\"";
    out += key;
    out += "\":";
    append_json(out, value);
}

void append_bool(std::string& out, std::string_view key, bool value) {
    out += ",\"";
    out += key;
    out += value ? "\":true" : "\":false";
}

// ,"object":... and all that follows it.
void append_surface(std::string& out, const Pick& pick) {
    append_field(out, "object", std::string_view(pick.object));
    append_field(out, "object_id", std::int64_t{pick.hit.object});
    append_field(out, "primitive", std::int64_t{pick.hit.primitive});
    append_field(out, "t", pick.hit.t);
    append_field(out, "point", pick.point);
    append_field(out, "normal", pick.normal);
    append_field(out, "uv", pick.hit.uv);
    append_bool(out, "front_face", pick.hit.front_face);
    append_field(out, "material", std::string_view(pick.material));
}

void append_first(std::string& out, const Pick* pick) {
    append_bool(out, "hit", pick != nullptr);
    if (pick != nullptr) append_surface(out, *pick);
}

void append_hits(std::string& out, const std::vector<Pick>& picks) {
    append_first(out, picks.empty() ? nullptr : &picks.front());
    out += ",\"hits\":[";
    for (std::size_t i = 0; i < picks.size(); ++i) {
        std::string fields;
        append_surface(fields, picks[i]);
        fields.front() = '{';  // in place of the comma
        if (i > 0) out += ',';
        out += fields;
        out += '}';
    }
    out += ']';
}

std::string begin_line(Pixel pixel) {
    std::string out;
    out.reserve(320);
    out += "{\"row\":";
    append_json(out, std::int64_t{pixel.row});
    append_field(out, "col", std::int64_t{pixel.col});
    return out;
}

std::string begin_line(const glm::dvec3& origin, const glm::dvec3& direction) {
    std::string out;
    out.reserve(448);
    out += "{\"origin\":";
    append_json(out, origin);
    append_field(out, "direction", direction);
    return out;
}

std::string finished(std::string line) {
    line += '}';
    return line;
}

}  // namespace

std::optional<Pick> pick_pixel(const Accel& accel, const Camera& camera, ImageSize size,
                               Pixel pixel, const RayQuery& query) {
    return pick_ray(accel, camera_ray(camera, size, pixel), query);
}

std::optional<Pick> pick_ray(const Accel& accel, const Ray& ray, const RayQuery& query) {
    return described(accel, ray, accel.intersect(ray, query));
}

std::vector<Pick> pick_all(const Accel& accel, const Ray& ray, const RayQuery& query) {
    std::vector<Pick> picks;
    for (const Hit& hit : accel.intersect_all(ray, query)) {
        picks.push_back(describe(accel, ray, hit));
    }
    return picks;
}

Pick describe(const Accel& accel, const Ray& ray, const Hit& hit) {
    const Scene& scene = accel.scene();
    const SurfacePoint surface = surface_point(scene, ray, hit);
    Pick pick;
    pick.hit = hit;
    if (const Object* object = find_object(scene, hit.object)) {
        pick.object = object->name;
        pick.path = object->path;
    }
    if (surface.material != kNoMaterial) pick.material = material(scene, surface.material).name;
    pick.point = scene.origin + glm::dvec3(surface.position);
    pick.normal = surface.shading_normal;
    return pick;
}

std::string to_json(const PixelPick& pick) {
    std::string line = begin_line(pick.pixel);
    append_first(line, pick.pick ? &*pick.pick : nullptr);
    return finished(std::move(line));
}

std::string to_json(Pixel pixel, const std::vector<Pick>& picks) {
    std::string line = begin_line(pixel);
    append_hits(line, picks);
    return finished(std::move(line));
}

std::string to_json(const glm::dvec3& origin, const glm::dvec3& direction,
                    const std::optional<Pick>& pick) {
    std::string line = begin_line(origin, direction);
    append_first(line, pick ? &*pick : nullptr);
    return finished(std::move(line));
}

std::string to_json(const glm::dvec3& origin, const glm::dvec3& direction,
                    const std::vector<Pick>& picks) {
    std::string line = begin_line(origin, direction);
    append_hits(line, picks);
    return finished(std::move(line));
}

}  // namespace raypick
