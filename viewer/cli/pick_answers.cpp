#include "viewer/cli/pick_answers.h"

#include "picking/json.h"
#include "viewer/cli/numbers.h"
#include "viewer/cli/open_scene.h"

#include <fmt/format.h>

#include <vector>

namespace raypick {
namespace {

// Of a line that is quoted in an error.
constexpr std::size_t kLongestQuote = 60;

PickQuestion nonsense(StreamOf about, std::string_view expected, std::string_view line) {
    PickQuestion question;
    question.about = about;
    question.error = fmt::format("expected {}, got '{}'", expected, line.substr(0, kLongestQuote));
    return question;
}

std::string error_line(const PickQuestion& question, std::uint64_t line_number) {
    std::string out = R"({"origin":null,"direction":null)";
    if (question.about == StreamOf::pixels) {
        out = question.has_place
                  ? fmt::format(R"({{"row":{},"col":{})", question.pixel.row, question.pixel.col)
                  : R"({"row":null,"col":null)";
    }
    out += fmt::format(R"(,"line":{},"error":)", line_number);
    append_json(out, std::string_view(question.error));
    out += '}';
    return out;
}

}  // namespace

PickAnswerer::PickAnswerer(std::shared_ptr<const Accel> accel, const CameraOverride& camera,
                           std::optional<ImageSize> size, bool all)
    : accel_(std::move(accel)), size_(size), all_(all) {
    if (size_) camera_.emplace(camera_for(accel_->scene(), *size_, camera), *size_);
}

PickQuestion PickAnswerer::question(Pixel pixel) const {
    PickQuestion question;
    question.pixel = pixel;
    question.has_place = true;
    if (size_->contains(pixel)) {
        question.ray = camera_->ray(pixel_centre(pixel));
    } else {
        question.error =
            fmt::format("outside the image of {} rows and {} columns", size_->rows, size_->cols);
    }
    return question;
}

PickQuestion PickAnswerer::question(const FileRay& ray) const {
    PickQuestion question;
    question.about = StreamOf::rays;
    question.file_ray = ray;
    question.ray.origin = glm::vec3(ray.origin - accel_->scene().origin);
    question.ray.direction = glm::vec3(ray.direction);
    return question;
}

PickQuestion PickAnswerer::question(StreamOf about, std::string_view line) const {
    if (about == StreamOf::pixels) {
        const auto row_col = parse_ints<2>(line, Separator::blanks);
        if (!row_col) return nonsense(about, "ROW COL", line);
        return question(Pixel{(*row_col)[0], (*row_col)[1]});
    }
    const auto numbers = parse_doubles<6>(line, Separator::blanks);
    if (!numbers) return nonsense(about, "OX OY OZ DX DY DZ", line);
    const std::optional<FileRay> ray = file_ray(*numbers);
    if (!ray) return nonsense(about, "numbers up to 1e30 and a direction other than 0 0 0", line);
    return question(*ray);
}

std::string PickAnswerer::answer_all(const PickQuestion& question) const {
    const std::vector<Pick> picks = pick_all(*accel_, question.ray);
    if (question.about == StreamOf::pixels) return to_json(question.pixel, picks);
    return to_json(question.file_ray.origin, question.file_ray.direction, picks);
}

std::string PickAnswerer::answer_first(const PickQuestion& question, const Hit& hit) const {
    std::optional<Pick> pick;
    if (hit.valid()) pick = describe(*accel_, question.ray, hit);
    if (question.about == StreamOf::pixels) {
        return to_json(PixelPick{question.pixel, std::move(pick)});
    }
    return to_json(question.file_ray.origin, question.file_ray.direction, pick);
}

std::string PickAnswerer::answer(std::span<const PickQuestion> questions,
                                 std::uint64_t first_line) const {
    std::vector<Ray> rays;
    rays.reserve(questions.size());
    for (const PickQuestion& question : questions)
        rays.push_back(question.ray);
    std::vector<Hit> hits(all_ ? 0 : rays.size());
    if (!all_) accel_->intersect(rays, hits);

    std::string out;
    for (std::size_t i = 0; i < questions.size(); ++i) {
        const PickQuestion& question = questions[i];
        if (!question.error.empty()) {
            out += error_line(question, first_line + i);
        } else {
            out += all_ ? answer_all(question) : answer_first(question, hits[i]);
        }
        out += '\n';
    }
    return out;
}

}  // namespace raypick
