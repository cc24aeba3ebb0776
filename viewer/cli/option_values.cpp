#include "viewer/cli/option_values.h"

#include "viewer/cli/numbers.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace raypick {
namespace {

// Sides of an image; also what a 16-bit texture coordinate and a PNG reader can be expected to
// take.
constexpr int kMaxSide = 65535;

// Of places that a person may name: rays are traced in float, which ends at 3.4e38.
constexpr double kMostCoordinate = 1e30;

template <std::size_t N>
bool all_moderate(const std::array<double, N>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(),
                       [](double number) { return std::abs(number) <= kMostCoordinate; });
}

}  // namespace

void refuse(const std::string& option, const std::string& expected, const std::string& given) {
    throw CLI::ValidationError(option, fmt::format("expected {}, got '{}'", expected, given));
}

double number_in(const std::string& option, const std::string& text, double low, double high,
                 const std::string& expected) {
    const std::optional<double> number = parse_double(text);
    if (!number || *number < low || *number > high) refuse(option, expected, text);
    return *number;
}

int whole_number_in(const std::string& option, const std::string& text, int low, int high) {
    const std::optional<int> number = parse_int(text);
    if (!number || *number < low || *number > high) {
        refuse(option, fmt::format("a whole number from {} to {}", low, high), text);
    }
    return *number;
}

std::uint64_t natural_number(const std::string& option, const std::string& text) {
    std::uint64_t number = 0;
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, number);
    if (read.ec != std::errc() || read.ptr != end) {
        refuse(option, "a whole number from 0 to 18446744073709551615", text);
    }
    return number;
}

glm::dvec3 point_of(const std::string& option, const std::string& text) {
    const auto xyz = parse_doubles<3>(text, Separator::comma);
    if (!xyz || !all_moderate(*xyz)) refuse(option, "X,Y,Z (numbers up to 1e30)", text);
    return {(*xyz)[0], (*xyz)[1], (*xyz)[2]};
}

ImageSize size_of(const std::string& text) {
    const auto wh = parse_ints<2>(text, Separator::comma);
    const auto allowed = [](int side) { return side >= 1 && side <= kMaxSide; };
    if (!wh || !allowed((*wh)[0]) || !allowed((*wh)[1])) {
        refuse("--resolution", fmt::format("W,H (each from 1 to {})", kMaxSide), text);
    }
    return {(*wh)[1], (*wh)[0]};
}

Pixel pixel_of(const std::string& text) {
    const auto row_col = parse_ints<2>(text, Separator::comma);
    if (!row_col) refuse("--pixel", "ROW,COL (whole numbers) or -", text);
    return {(*row_col)[0], (*row_col)[1]};
}

FileRay ray_of(const std::string& text) {
    const auto numbers = parse_doubles<6>(text, Separator::comma);
    if (!numbers) refuse("--ray", "OX,OY,OZ,DX,DY,DZ or -", text);
    const std::optional<FileRay> ray = file_ray(*numbers);
    if (!ray) refuse("--ray", "numbers up to 1e30 and a direction other than 0,0,0", text);
    return *ray;
}

std::optional<FileRay> file_ray(const std::array<double, 6>& numbers) {
    const glm::dvec3 origin(numbers[0], numbers[1], numbers[2]);
    const glm::dvec3 direction(numbers[3], numbers[4], numbers[5]);
    const glm::dvec3 sizes = glm::abs(direction);
    const double largest = std::max({sizes.x, sizes.y, sizes.z});
    if (!(largest > 0.0) || !all_moderate(numbers)) return std::nullopt;
    // First by the largest part, so that squares neither overflow nor vanish.
    return FileRay{origin, glm::normalize(direction / largest)};
}

void add_off_switch(CLI::App& app, const std::string& name, const std::string& description,
                    bool& setting) {
    app.add_flag_callback(
        name, [&setting] { setting = false; }, description);
}

}  // namespace raypick
