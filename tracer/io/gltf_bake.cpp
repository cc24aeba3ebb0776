#include "tracer/io/gltf_bake.h"

#include "tracer/scene/texel_coding.h"

#include <glm/common.hpp>

#include <algorithm>
#include <utility>

namespace raypick {

namespace {

// The texel of an image at a place of a larger one.
const glm::u8vec4& texel_at(const ByteImage& image, int row, int col, int rows, int cols) {
    const auto scaled = [](int i, int from, int to) {
        return static_cast<std::size_t>(static_cast<long long>(i) * to / from);
    };
    return image.texels[scaled(row, rows, image.rows) * static_cast<std::size_t>(image.cols) +
                        scaled(col, cols, image.cols)];
}

}  // namespace

float TermRange::largest() const {
    return std::max({most.x, most.y, most.z});
}

bool TermRange::varies() const {
    const glm::vec3 width = most - least;
    return std::max({width.x, width.y, width.z}) > largest() / 255.0f;
}

PbrBaker::PbrBaker(PbrImages images, const PbrValues& factors)
    : images_(std::move(images)), factors_(factors) {
    for (const auto* image : {&images_.base, &images_.metallic_roughness, &images_.transmission}) {
        if (!*image) continue;
        rows_ = std::max(rows_, (*image)->rows);
        cols_ = std::max(cols_, (*image)->cols);
    }
}

PhongTerms PbrBaker::at(int row, int col) const {
    PbrValues pbr = factors_;
    if (images_.base) {
        const std::array<float, 256>& linear = srgb_to_linear_table();
        const glm::u8vec4& c = texel_at(*images_.base, row, col, rows_, cols_);
        pbr.base *= glm::vec3(linear[c.x], linear[c.y], linear[c.z]);
    }
    if (images_.metallic_roughness) {
        const glm::u8vec4& c = texel_at(*images_.metallic_roughness, row, col, rows_, cols_);
        pbr.roughness *= static_cast<float>(c.y) / 255.0f;
        pbr.metallic *= static_cast<float>(c.z) / 255.0f;
    }
    if (images_.transmission) {
        const glm::u8vec4& c = texel_at(*images_.transmission, row, col, rows_, cols_);
        pbr.transmission *= static_cast<float>(c.x) / 255.0f;
    }
    return phong_terms(pbr);
}

glm::vec3 PbrBaker::value(PbrTerm term, int row, int col) const {
    const PhongTerms terms = at(row, col);
    switch (term) {
        case PbrTerm::diffuse:
            return terms.diffuse;
        case PbrTerm::ambient:
            return terms.ambient;
        case PbrTerm::specular:
            return terms.specular;
        case PbrTerm::shininess:
            return glm::vec3(terms.shininess);
        case PbrTerm::reflect:
            return terms.reflect;
        case PbrTerm::transmit:
            break;
    }
    return terms.transmit;
}

TermRange PbrBaker::range(PbrTerm term) const {
    const glm::vec3 first = value(term, 0, 0);
    TermRange range{first, first};
    for (int row = 0; row < rows_; ++row) {
        for (int col = 0; col < cols_; ++col) {
            const glm::vec3 x = value(term, row, col);
            range.least = glm::min(range.least, x);
            range.most = glm::max(range.most, x);
        }
    }
    return range;
}

ByteImage PbrBaker::bake(PbrTerm term, float largest, TexelCoding coding) const {
    const TexelEncoder coded(coding);
    ByteImage image{rows_, cols_, {}};
    image.texels.reserve(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_));
    for (int row = 0; row < rows_; ++row) {
        for (int col = 0; col < cols_; ++col) {
            const glm::vec3 x = value(term, row, col) / largest;
            image.texels.emplace_back(coded.byte(x.x), coded.byte(x.y), coded.byte(x.z), 255);
        }
    }
    return image;
}

}  // namespace raypick
