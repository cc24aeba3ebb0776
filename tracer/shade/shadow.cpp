#include "tracer/shade/shadow.h"

#include "tracer/accel/crossings.h"

#include <cmath>
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
        const Scene& world = *scene_.scene;
        const Object& object = world.objects[object_index(world, hit.object)];
        const MaterialId id = material_id(world, object, hit.primitive);
        const PreparedMaterial& material = prepared_material(scene_, id);
        bool there = true;
        MaterialId medium = kNoMaterial;
        if (material.fills) {
            Crossing crossing;
            cross_surface(world, interior_, body_of(object, hit), id, hit.front_face, crossing);
            medium = crossing.from;
            interior_ = crossing.after;
            there = is_there(world, crossing, id);
        } else {
            medium = interior_.medium(world);
        }
        share_ *= passed(scene_, medium, hit.t - reached_);
        reached_ = hit.t;
        if (!there) return;
        if (material.has_maps) {
            const FoundHit found = find_surface(scene_, ray_, hit);
            pass(textured(world, *material.material, found.surface, ray_.direction, width_));
        } else {
            pass(material.plain);
        }
    }

    // What is left at the light.
    [[nodiscard]] glm::vec3 at_end() const {
        if (!std::isfinite(ray_.t_max)) return share_;
        return share_ * passed(scene_, interior_.medium(*scene_.scene), ray_.t_max - reached_);
    }

private:
    void pass(const SurfaceMaterial& look) {
        share_ *= glm::vec3(1.0f - look.opacity) + look.opacity * look.transmit;
    }

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
    sort_along_ray(crossed);
    return transmittance_through(scene, ray, crossed, interior, width);
}

glm::vec3 transmittance_through(const ShadeScene& scene, const Ray& ray,
                                std::span<const Hit> crossed, const Interior* interior,
                                float width) {
    Passage passage(scene, ray, interior, width);
    for (const Hit& hit : crossed)
        passage.cross(hit);
    return passage.at_end();
}

}  // namespace raypick
