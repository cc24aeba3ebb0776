// Our material's terms worked out for every texel of a glTF material's textures.
#pragma once

#include "tracer/io/imported_material.h"

#include <memory>

namespace raypick {

// The images of a material, any of which may be missing. They cover the same square: the largest
// decides the size, the others are looked up at the nearest texel.
struct PbrImages {
    std::shared_ptr<const ByteImage> base;                // sRGB
    std::shared_ptr<const ByteImage> metallic_roughness;  // linear: g roughness, b metallic
    std::shared_ptr<const ByteImage> transmission;        // linear: r
};

enum class PbrTerm { diffuse, ambient, specular, shininess, reflect, transmit };

// One term over the whole image.
struct TermRange {
    glm::vec3 least{0.0f};
    glm::vec3 most{0.0f};

    [[nodiscard]] float largest() const;
    // Does it differ by more than a step of a byte?
    [[nodiscard]] bool varies() const;
};

class PbrBaker {
public:
    // `factors` are multiplied by the texels.
    PbrBaker(PbrImages images, const PbrValues& factors);

    [[nodiscard]] TermRange range(PbrTerm term) const;
    // The term divided by `largest`.
    [[nodiscard]] ByteImage bake(PbrTerm term, float largest, TexelCoding coding) const;

private:
    [[nodiscard]] PhongTerms at(int row, int col) const;
    [[nodiscard]] glm::vec3 value(PbrTerm term, int row, int col) const;

    PbrImages images_;
    PbrValues factors_;
    int rows_ = 1;
    int cols_ = 1;
};

}  // namespace raypick
