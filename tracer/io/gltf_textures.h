// The maps of glTF materials made textures of the scene. Where a term of our material is no product
// with the base colour's texture, it is worked out texel by texel: a metallic-roughness texture
// becomes maps of diffuse, ambient, specular, shininess, reflect and transmit.
#pragma once

#include "tracer/io/gltf_bake.h"
#include "tracer/io/imported_material.h"
#include "tracer/io/texture_library.h"

#include <memory>
#include <string>
#include <vector>

namespace raypick {

class GltfTextures {
public:
    // The scene's materials get their maps in finish(); `target` must outlive this.
    explicit GltfTextures(LoadedScene& target) : target_(&target), library_(target) {}

    // Notes what a material of the scene wants.
    void request(MaterialId material, GltfMaterial gltf);

    // Decodes all images and gives the materials their maps. What is broken is a warning and a
    // placeholder. The bytes of the images must be there until then. Throws Cancelled.
    void finish(const LoadOptions& options, float progress_begin, float progress_end);

private:
    struct NamedTerm {
        PbrTerm term;
        const char* name;
    };
    // The map's image in the library.
    struct Image {
        TextureLibrary::ImageNumber number = 0;
        TextureMap use;
    };
    struct Wish {
        MaterialId material = kNoMaterial;
        GltfMaterial gltf;
        std::optional<Image> base;
        std::optional<Image> metallic_roughness;
        std::optional<Image> transmission;
        std::optional<Image> normal;
        std::optional<Image> emissive;
    };

    std::optional<Image> note(const std::optional<GltfMap>& map, TexelCoding coding);
    void grant(Wish& wish);
    void simplify(Wish& wish);
    void drop_uniform(Wish& wish) const;
    void give_terms(const Wish& wish, Material& material);
    void bake_terms(const Wish& wish, Material& material);
    void bake_term(const Wish& wish, const TextureMap& placed,
                   const std::shared_ptr<const PbrBaker>& baker, const NamedTerm& named,
                   Material& material);
    void give_alpha(const Wish& wish, Material& material);
    [[nodiscard]] TextureMap shown(const Image& image);

    LoadedScene* target_;
    TextureLibrary library_;
    std::vector<Wish> wishes_;
};

}  // namespace raypick
