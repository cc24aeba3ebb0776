#include "tracer/io/gltf_textures.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace raypick {

namespace {

// Do both put an image onto the surface in the same way?
bool same_place(const TextureMap& a, const TextureMap& b) {
    return a.u_row == b.u_row && a.v_row == b.v_row && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v;
}

float first_fraction(const ByteImage& image, int channel) {
    return static_cast<float>(image.texels.front()[channel]) / 255.0f;
}

// Where a term of the material is kept, and which map multiplies it.
void set_term(Material& material, PbrTerm term, const glm::vec3& value, const TextureMap& map) {
    switch (term) {
        case PbrTerm::diffuse:
            material.diffuse = value;
            material.map(MapSlot::diffuse) = map;
            break;
        case PbrTerm::ambient:
            material.ambient = value;
            material.map(MapSlot::ambient) = map;
            break;
        case PbrTerm::specular:
            material.specular = value;
            material.map(MapSlot::specular) = map;
            break;
        case PbrTerm::shininess:
            material.shininess = value.x;
            material.map(MapSlot::shininess) = map;
            break;
        case PbrTerm::reflect:
            material.reflect = value;
            material.map(MapSlot::reflect) = map;
            break;
        case PbrTerm::transmit:
            material.transmit = value;
            material.map(MapSlot::transmit) = map;
            break;
    }
}

}  // namespace

std::optional<GltfTextures::Image> GltfTextures::note(const std::optional<GltfMap>& map,
                                                      TexelCoding coding) {
    if (!map) return std::nullopt;
    return Image{library_.image(map->image, coding), map->use};
}

void GltfTextures::request(MaterialId material, GltfMaterial gltf) {
    Wish wish;
    wish.material = material;
    wish.base = note(gltf.base_map, TexelCoding::srgb);
    if (!gltf.unlit) {
        wish.metallic_roughness = note(gltf.metallic_roughness_map, TexelCoding::linear);
        wish.transmission = note(gltf.transmission_map, TexelCoding::linear);
        wish.normal = note(gltf.normal_map, TexelCoding::linear);
        // A factor of 0 puts it out.
        if (gltf.emissive != glm::vec3(0.0f)) {
            wish.emissive = note(gltf.emissive_map, TexelCoding::srgb);
        }
    }
    wish.gltf = std::move(gltf);
    wishes_.push_back(std::move(wish));
}

void GltfTextures::finish(const LoadOptions& options, float progress_begin, float progress_end) {
    const float middle = 0.5f * (progress_begin + progress_end);
    library_.decode(options, progress_begin, middle);
    for (Wish& wish : wishes_)
        grant(wish);
    library_.make(options, middle, progress_end);
    wishes_.clear();
}

void GltfTextures::grant(Wish& wish) {
    simplify(wish);
    Material material = material_from(wish.gltf);
    if (wish.gltf.unlit) {
        if (wish.base) material.map(MapSlot::emissive) = shown(*wish.base);
    } else {
        give_terms(wish, material);
        if (wish.emissive) material.map(MapSlot::emissive) = shown(*wish.emissive);
        if (wish.normal && !library_.broken(wish.normal->number)) {
            material.map(MapSlot::normal) = shown(*wish.normal);
        }
    }
    give_alpha(wish, material);
    target_->scene.materials[wish.material] = std::move(material);
}

// Leaves only textures that vary and lie on the surface as the base colour's does.
void GltfTextures::simplify(Wish& wish) {
    const std::optional<Image>& first = wish.base ? wish.base : wish.metallic_roughness;
    const auto fits = [&](const Image& image) { return same_place(image.use, first->use); };
    const auto warn = [&](const std::optional<GltfMap>& map, const char* what) {
        target_->warnings.push_back(fmt::format(
            "{}: material \"{}\": the {} texture does not lie as the base colour's does: left out",
            map->image.place, wish.gltf.name, what));
    };
    drop_uniform(wish);
    if (wish.metallic_roughness &&
        (library_.broken(wish.metallic_roughness->number) || !fits(*wish.metallic_roughness))) {
        if (!library_.broken(wish.metallic_roughness->number))
            warn(wish.gltf.metallic_roughness_map, "metallic-roughness");
        wish.metallic_roughness.reset();
        wish.gltf.pbr.metallic = 0.0f;  // where there is metal is not known
    }
    if (wish.transmission &&
        (library_.broken(wish.transmission->number) || (first && !fits(*wish.transmission)))) {
        if (!library_.broken(wish.transmission->number))
            warn(wish.gltf.transmission_map, "transmission");
        wish.transmission.reset();
        wish.gltf.pbr.transmission = 0.0f;
    }
}

// Textures of one value are factors.
void GltfTextures::drop_uniform(Wish& wish) const {
    if (wish.metallic_roughness && !library_.broken(wish.metallic_roughness->number)) {
        const ByteImage& image = *library_.pixels(wish.metallic_roughness->number);
        if (is_uniform(image, 1) && is_uniform(image, 2)) {
            wish.gltf.pbr.roughness *= first_fraction(image, 1);
            wish.gltf.pbr.metallic *= first_fraction(image, 2);
            wish.metallic_roughness.reset();
        } else if (wish.gltf.pbr.metallic == 0.0f && wish.gltf.pbr.roughness == 0.0f) {
            wish.metallic_roughness.reset();
        }
    }
    if (wish.transmission && !library_.broken(wish.transmission->number)) {
        const ByteImage& image = *library_.pixels(wish.transmission->number);
        if (is_uniform(image, 0) || wish.gltf.pbr.transmission == 0.0f) {
            wish.gltf.pbr.transmission *= first_fraction(image, 0);
            wish.transmission.reset();
        }
    }
}

void GltfTextures::give_terms(const Wish& wish, Material& material) {
    const bool metal_under_colour = wish.base && wish.gltf.pbr.metallic > 0.0f;
    if (wish.metallic_roughness || wish.transmission || metal_under_colour) {
        bake_terms(wish, material);
    }
    // Where metalness and transmission are the same all over, these are products with the base.
    if (!wish.base || wish.metallic_roughness || wish.transmission) return;
    const TextureMap base = shown(*wish.base);
    material.map(MapSlot::diffuse) = base;
    if (material.transmits()) material.map(MapSlot::transmit) = base;
}

void GltfTextures::bake_terms(const Wish& wish, Material& material) {
    const auto pixels = [&](const std::optional<Image>& image) {
        return image ? library_.pixels(image->number) : nullptr;
    };
    const auto baker = std::make_shared<const PbrBaker>(
        PbrImages{pixels(wish.base), pixels(wish.metallic_roughness), pixels(wish.transmission)},
        wish.gltf.pbr);
    const bool only_colour = !wish.metallic_roughness && !wish.transmission;
    const Image& placed = wish.base                 ? *wish.base
                          : wish.metallic_roughness ? *wish.metallic_roughness
                                                    : *wish.transmission;
    constexpr std::array<NamedTerm, 6> kTerms = {{{PbrTerm::diffuse, "diffuse"},
                                                  {PbrTerm::ambient, "ambient"},
                                                  {PbrTerm::specular, "specular"},
                                                  {PbrTerm::shininess, "shininess"},
                                                  {PbrTerm::reflect, "reflect"},
                                                  {PbrTerm::transmit, "transmit"}}};
    for (const NamedTerm& named : kTerms) {
        if (only_colour && named.term != PbrTerm::specular && named.term != PbrTerm::reflect) {
            continue;
        }
        bake_term(wish, placed.use, baker, named, material);
    }
    if (material.reflectance == Reflectance::constant && material.reflects()) {
        material.reflectance = Reflectance::conductor;
    }
}

// A term that is the same all over needs no map: but where diffuse has one, ambient must have its
// own, so as not to be multiplied by that.
void GltfTextures::bake_term(const Wish& wish, const TextureMap& placed,
                             const std::shared_ptr<const PbrBaker>& baker, const NamedTerm& named,
                             Material& material) {
    const TermRange range = baker->range(named.term);
    const bool under_diffuse =
        named.term == PbrTerm::ambient && material.map(MapSlot::diffuse) && range.largest() > 0.0f;
    if (!range.varies() && !under_diffuse) {
        set_term(material, named.term, range.most, {});
        return;
    }
    const bool exponents = named.term == PbrTerm::shininess;
    const TexelCoding coding = exponents ? TexelCoding::logarithmic : TexelCoding::srgb;
    // From 1 to 8192 whatever the image has of it, so that a texel is never less than 1.
    const float largest = exponents ? kLogarithmicSpan : range.largest();
    TextureMap map = placed;
    map.texture = library_.baked(
        fmt::format("{} {} of material {}", wish.gltf.name, named.name, wish.material), coding,
        [baker, term = named.term, largest, coding] { return baker->bake(term, largest, coding); });
    set_term(material, named.term, glm::vec3(largest), map);
}

// The alpha of the base colour.
void GltfTextures::give_alpha(const Wish& wish, Material& material) {
    if (!wish.base || !(wish.gltf.masked || wish.gltf.blend)) return;
    if (library_.broken(wish.base->number)) return;
    const ByteImage& image = *library_.pixels(wish.base->number);
    if (is_uniform(image, 3)) {
        material.opacity *= first_fraction(image, 3);
        return;
    }
    material.map(MapSlot::opacity) = shown(*wish.base);
    material.map(MapSlot::opacity).channel = 3;
}

TextureMap GltfTextures::shown(const Image& image) {
    TextureMap map = image.use;
    map.texture = library_.texture(image.number);
    return map;
}

}  // namespace raypick
