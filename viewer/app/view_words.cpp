#include "viewer/app/view_words.h"

#include <fmt/format.h>

namespace raypick {

namespace {

std::string words(const glm::dvec3& v) {
    return fmt::format("{},{},{}", v.x, v.y, v.z);
}

}  // namespace

std::string view_words(const Camera& camera, const glm::dvec3& origin, ImageSize size) {
    const std::string projection = camera.projection == Projection::orthographic
                                       ? fmt::format("--orthographic={}", camera.height)
                                       : fmt::format("--fovy={}", camera.fovy);
    return fmt::format("--eye={} --look-at={} --up={} {} --resolution={},{}",
                       words(origin + camera.eye), words(origin + camera.at), words(camera.up),
                       projection, size.cols, size.rows);
}

}  // namespace raypick
