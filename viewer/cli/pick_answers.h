// Questions and answers of `raypick pick`: what lies there, as a line of JSON.
#pragma once

#include "picking/pick.h"
#include "viewer/cli/options.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace raypick {

// What is asked. A line that makes no sense has an error instead of a ray.
struct PickQuestion {
    StreamOf about = StreamOf::pixels;
    Pixel pixel;
    FileRay file_ray;
    Ray ray;
    bool has_place = false;  // the pixel was understood, though it may be outside
    std::string error;
};

// A scene seen by a camera, ready to be asked from many threads.
class PickAnswerer {
public:
    // Without a size only rays can be asked about.
    PickAnswerer(std::shared_ptr<const Accel> accel, const CameraOverride& camera,
                 std::optional<ImageSize> size, bool all);

    [[nodiscard]] PickQuestion question(Pixel pixel) const;
    [[nodiscard]] PickQuestion question(const FileRay& ray) const;
    // From a line of standard input: ROW COL, or OX OY OZ DX DY DZ.
    [[nodiscard]] PickQuestion question(StreamOf about, std::string_view line) const;

    // One line of JSON each, with line ends. `first_line` is the number, in the stream, of the
    // first question, named in errors.
    [[nodiscard]] std::string answer(std::span<const PickQuestion> questions,
                                     std::uint64_t first_line) const;

private:
    [[nodiscard]] std::string answer_all(const PickQuestion& question) const;
    [[nodiscard]] std::string answer_first(const PickQuestion& question, const Hit& hit) const;

    std::shared_ptr<const Accel> accel_;
    std::optional<ImageSize> size_;
    std::optional<RayGenerator> camera_;
    bool all_;
};

}  // namespace raypick
