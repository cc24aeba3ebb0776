// The maps of Wavefront materials made textures of the scene.
#pragma once

#include "tracer/io/imported_material.h"
#include "tracer/io/texture_library.h"

#include <filesystem>
#include <vector>

namespace raypick {

class MtlTextures {
public:
    // The scene's materials get their maps in finish(); `target` must outlive this.
    MtlTextures(LoadedScene& target, const std::filesystem::path& obj_file)
        : target_(&target), library_(target), obj_folder_(obj_file.parent_path()) {}

    // Notes what a material of the scene wants.
    void request(MaterialId material, const MtlMaterial& mtl);

    // Reads all images and gives the materials their maps. What is missing or broken is a warning
    // and a placeholder. Throws Cancelled.
    void finish(const LoadOptions& options, float progress_begin, float progress_end);

private:
    struct Wish {
        MaterialId material = kNoMaterial;
        MtlMap map;
        TextureLibrary::ImageNumber image = 0;
    };

    void grant(const Wish& wish);
    [[nodiscard]] TextureMap normals(const Wish& wish);
    [[nodiscard]] TextureMap numbers(const Wish& wish);
    void give_opacity(const Wish& wish, Material& material);
    void cut_out_by_alpha(const Wish& wish, Material& material);

    LoadedScene* target_;
    TextureLibrary library_;
    std::filesystem::path obj_folder_;
    std::vector<Wish> wishes_;
};

// The tangent-space normals (x along u, y along v, [-1, 1] as bytes) of a height map, white on top.
// A step from black to white from one texel to the next rises by `scale` texels. The image repeats.
ByteImage normals_of_heights(const ByteImage& heights, double scale);

// Does the image hold such normals already? Many programs write them as map_bump.
bool looks_like_normals(const ByteImage& image);

}  // namespace raypick
