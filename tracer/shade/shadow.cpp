#include "tracer/shade/shadow.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace raypick {

namespace {

// Follows light through the surfaces that a shadow ray crosses, nearest first.
class Passage {
public:
    Passage(const ShadeScene& scene, const Ray& ray, const Interior* interior, float width)
        : scene_(scene), ray_(ray), width_(width) {
        if (interior != nullptr) interior_ = *interior;
    }

    void cross(const Hit& hit) {
        const FoundHit found = find_surface(scene_, ray_, hit);
        const Scene& world = *scene_.scene;
        bool there = true;
        MaterialId medium = interior_.medium(world);
        if (found.material->fills) {
            Crossing crossing;
            cross_surface(world, interior_, body_of(*found.object, hit), found.surface.material,
                          found.surface.front_face, crossing);
            medium = crossing.from;
            interior_ = crossing.after;
            there = is_there(world, crossing, found.surface.material);
        }
        share_ *= passed(scene_, medium, hit.t - reached_);
        reached_ = hit.t;
        if (!there) return;
        const SurfaceMaterial look =
            textured(world, *found.material->material, found.surface, ray_.direction, width_);
        share_ *= glm::vec3(1.0f - look.opacity) + look.opacity * look.transmit;
    }

    // What is left at the light.
    [[nodiscard]] glm::vec3 at_end() const {
        if (!std::isfinite(ray_.t_max)) return share_;
        return share_ * passed(scene_, interior_.medium(*scene_.scene), ray_.t_max - reached_);
    }

private:
    const ShadeScene& scene_;
    const Ray& ray_;
    float width_;
    Interior interior_;
    glm::vec3 share_{1.0f};
    float reached_ = 0.0f;
};

}  // namespace

glm::vec3 transmittance(const ShadeScene& scene, const Ray& ray, const Interior* interior,
                        float width) {
    std::vector<Hit> crossed;
    const Scene& world = *scene.scene;
    const auto opaque = [&](const Hit& hit) {
        const Object& object = world.objects[object_index(world, hit.object)];
        const MaterialId id = material_id(world, object, hit.primitive);
        const bool see_through = prepared_material(scene, id).see_through;
        if (see_through) crossed.push_back(hit);
        return !see_through;
    };
    RayQuery query;
    query.accept = opaque;
    if (scene.accel->occluded(ray, query)) return glm::vec3(0.0f);
    std::sort(crossed.begin(), crossed.end(), [](const Hit& a, const Hit& b) {
        return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
    });
    Passage passage(scene, ray, interior, width);
    for (const Hit& hit : crossed)
        passage.cross(hit);
    return passage.at_end();
}

glm::vec3 free_transmittance(const ShadeScene& scene, const Ray& ray, const Interior* interior) {
    return Passage(scene, ray, interior, 0.0f).at_end();
}

}  // namespace raypick
