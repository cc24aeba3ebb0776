// Does the rasterised frame show what the tracer hits? Pixel by pixel.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/geometry/camera.h"
#include "tracer/render/image.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace raypick {

// The first hit of each pixel's ray; row 0 on top.
inline std::vector<Hit> first_hits(const Accel& accel, const Camera& camera, ImageSize size) {
    const RayGenerator generator(camera, size);
    std::vector<Ray> rays;
    rays.reserve(size.pixel_count());
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            rays.push_back(generator.ray(pixel_centre({row, col})));
        }
    }
    std::vector<Hit> hits(rays.size());
    accel.intersect(rays, hits);
    return hits;
}

struct Agreement {
    std::size_t pixels = 0;
    std::size_t objects = 0;         // different ids in the traced frame, background not counted
    std::size_t uniform = 0;         // pixels whose 3x3 neighbourhood is uniform in both
    std::size_t uniform_differ = 0;  // of these, with different objects: must be 0
    std::size_t edge_differ = 0;     // the other pixels with different objects, ties not counted
    std::size_t ties = 0;            // pixels that differ, but both objects are there at the same t
    double widest_tie = 0.0;         // largest relative gap of these
    double t_error = 0.0;            // largest relative difference of t where (object, primitive)
                                     // is the same, times the cosine of the angle of incidence
    std::string first_difference;

    [[nodiscard]] double edge_share() const {
        return static_cast<double>(edge_differ) / static_cast<double>(pixels);
    }
    [[nodiscard]] std::string summary() const {
        return fmt::format(
            "{} objects, {} pixels, {} uniform ({} differ), edges {} differ ({:.3f} %), {} ties "
            "(gap up to {:.1e}), t within {:.1e}{}",
            objects, pixels, uniform, uniform_differ, edge_differ, 100.0 * edge_share(), ties,
            widest_tie, t_error, first_difference);
    }
};

// Relative t within which two surfaces count as a tie when GL chose the other one: the tie gap and
// float's rounding of both t at a slanted surface.
inline constexpr double kTieProof = 1e-5;

// Whether the 3x3 neighbourhood (cut at the image's edge) shows one object.
template <typename IdAt>
bool uniform_around(ImageSize size, Pixel p, const IdAt& id_at) {
    for (int row = std::max(p.row - 1, 0); row <= std::min(p.row + 1, size.rows - 1); ++row) {
        for (int col = std::max(p.col - 1, 0); col <= std::min(p.col + 1, size.cols - 1); ++col) {
            if (id_at(Pixel{row, col}) != id_at(p)) return false;
        }
    }
    return true;
}

// The relative gap between the closest hit and a hit of `object`; infinite if there is none.
inline double gap_to(const Accel& accel, const Ray& ray, const Hit& closest, ObjectId object) {
    double gap = std::numeric_limits<double>::infinity();
    if (!closest.valid()) return gap;
    for (const Hit& hit : accel.intersect_all(ray)) {
        if (hit.object != object) continue;
        gap = std::min(gap, std::abs(static_cast<double>(hit.t) - static_cast<double>(closest.t)) /
                                static_cast<double>(closest.t));
    }
    return gap;
}

inline std::size_t count_objects(const std::vector<Hit>& hits) {
    std::vector<ObjectId> ids;
    for (const Hit& hit : hits) {
        if (hit.valid()) ids.push_back(hit.object);
    }
    std::sort(ids.begin(), ids.end());
    return static_cast<std::size_t>(std::unique(ids.begin(), ids.end()) - ids.begin());
}

// The less steeply a ray meets a surface, the farther a rounding of its direction moves the point.
inline double t_error(const Image& raster, Pixel p, const RayGenerator& generator, const Hit& hit) {
    const std::size_t i = raster.size.index(p);
    const glm::vec3 direction = generator.ray(pixel_centre(p)).direction;
    const double cosine = std::abs(static_cast<double>(glm::dot(raster.normal[i], direction)));
    const double t = hit.t;
    return std::abs(static_cast<double>(raster.depth[i]) - t) / t * cosine;
}

inline Agreement compare(const Accel& accel, const Camera& camera, const Image& raster) {
    const ImageSize size = raster.size;
    const std::vector<Hit> hits = first_hits(accel, camera, size);
    const RayGenerator generator(camera, size);
    const auto traced_id = [&](Pixel p) { return hits[size.index(p)].object; };
    const auto raster_id = [&](Pixel p) { return raster.object[size.index(p)]; };
    Agreement result;
    result.pixels = size.pixel_count();
    result.objects = count_objects(hits);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            const Pixel p{row, col};
            const Hit& hit = hits[size.index(p)];
            const bool uniform =
                uniform_around(size, p, traced_id) && uniform_around(size, p, raster_id);
            if (uniform) ++result.uniform;
            if (raster_id(p) == hit.object) {
                if (hit.valid() && raster.primitive[size.index(p)] == hit.primitive) {
                    result.t_error = std::max(result.t_error, t_error(raster, p, generator, hit));
                }
                continue;
            }
            const double gap = gap_to(accel, generator.ray(pixel_centre(p)), hit, raster_id(p));
            if (gap <= kTieProof) {
                ++result.ties;
                result.widest_tie = std::max(result.widest_tie, gap);
                continue;
            }
            ++(uniform ? result.uniform_differ : result.edge_differ);
            if (result.first_difference.empty()) {
                result.first_difference = fmt::format(
                    "; first at row {} col {}: GL object {} primitive {} t {}, tracer "
                    "object {} primitive {} t {}",
                    row, col, raster_id(p), raster.primitive[size.index(p)],
                    raster.depth[size.index(p)], hit.object, hit.primitive, hit.t);
            }
        }
    }
    return result;
}

}  // namespace raypick
