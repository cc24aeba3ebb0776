#include "tracer/io/mtl_file.h"

#include "tracer/io/file_bytes.h"
#include "tracer/io/text_scanner.h"
#include "tracer/scene/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

namespace raypick {

namespace {

// Keywords that are known and have no meaning here.
constexpr std::array<std::string_view, 13> kPassedOver = {
    "Ka",  "sharpness", "Km",     "Pr",         "Pm",        "Ps", "Pc",
    "Pcr", "aniso",     "anisor", "bAlphatest", "bBackface", "Ms"};

class MtlParser {
public:
    MtlParser(const std::filesystem::path& file, MtlLibrary& library,
              std::vector<std::string>& warnings)
        : text_(file),
          scanner_(file.string(), text_.view()),
          library_(library),
          warnings_(warnings) {}

    void parse() {
        while (!scanner_.at_end()) {
            read_line(scanner_.word());
            scanner_.next_line();
        }
    }

private:
    void read_line(std::string_view keyword) {
        if (keyword.empty() || keyword[0] == '#') return;
        if (keyword == "newmtl") {
            begin_material();
        } else if (material_ == nullptr) {
            scanner_.fail(in_quotes(keyword) + " before the first newmtl");
        } else if (!read_colour(keyword) && !read_value(keyword)) {
            read_other(keyword);
        }
    }

    void begin_material() {
        const std::string name = clean_name(scanner_.rest());
        material_ = &library_[name];
        *material_ = MtlMaterial();
        material_->name = name;
    }

    bool read_colour(std::string_view keyword) {
        if (keyword == "Kd") {
            if (const auto rgb = colour(keyword)) material_->kd = *rgb;
        } else if (keyword == "Ks") {
            if (const auto rgb = colour(keyword)) material_->ks = *rgb;
        } else if (keyword == "Ke") {
            if (const auto rgb = colour(keyword)) material_->ke = *rgb;
        } else if (keyword == "Tf") {
            if (const auto rgb = colour(keyword)) material_->tf = *rgb;
        } else {
            return false;
        }
        return true;
    }

    bool read_value(std::string_view keyword) {
        if (keyword == "Ns") {
            material_->ns = not_negative(keyword, kMostExponent);
        } else if (keyword == "Ni") {
            material_->ni = number(keyword);
            if (!(*material_->ni >= kSmallestPositive && *material_->ni <= kMostLight))
                fail(fmt::format("{} must be positive, not {}", keyword, *material_->ni));
        } else if (keyword == "Tr") {
            material_->tr = fraction(keyword);
        } else if (keyword == "d") {
            skip_halo();
            material_->d = fraction(keyword);
        } else if (keyword == "illum") {
            const double illum = number(keyword);
            material_->illum = illum >= 0.0 && illum <= 10.0 ? static_cast<int>(illum) : 2;
        } else {
            return false;
        }
        return true;
    }

    void read_other(std::string_view keyword) {
        if (is_mtl_map(keyword)) {
            read_map(keyword);
            return;
        }
        const bool known =
            std::find(kPassedOver.begin(), kPassedOver.end(), keyword) != kPassedOver.end();
        if (known || told_unknown_) return;
        told_unknown_ = true;
        warnings_.push_back(scanner_.place(
            of_material(in_quotes(keyword) + " is no MTL keyword that we know: ignored")));
    }

    void read_map(std::string_view keyword) {
        if (const std::optional<MtlMapKind> kind = mtl_map_kind(keyword)) {
            auto map = read_mtl_map(scanner_, *kind, material_->name, warnings_);
            if (map) material_->set_map(*std::move(map));
        } else if (keyword != "map_Ka" && keyword != "map_ka" &&
                   told_maps_.insert(std::string(keyword)).second) {
            warnings_.push_back(scanner_.place(
                of_material(fmt::format("{} is not read: left out", in_quotes(keyword)))));
        }
    }

    // "-halo" may stand before the number of d.
    void skip_halo() {
        const std::size_t before = scanner_.offset();
        if (scanner_.word() != "-halo") scanner_.return_to(before);
    }

    // As all complaints do it names the material, because the line is that of a library.
    [[nodiscard]] std::string of_material(std::string_view text) const {
        return fmt::format("material \"{}\": {}", material_->name, text);
    }
    [[noreturn]] void fail(std::string_view complaint) const {
        scanner_.fail(of_material(complaint));
    }

    double number(std::string_view what) {
        const double value = scanner_.number(of_material(what));
        if (!std::isfinite(static_cast<float>(value))) fail(fmt::format("{} is not finite", what));
        return value;
    }

    double not_negative(std::string_view what, double most) {
        const double value = number(what);
        if (!(value >= 0.0)) fail(fmt::format("{} must be 0 or more, not {}", what, value));
        if (!(value <= most)) {
            fail(fmt::format("{} must be no more than {}, not {}", what, most, value));
        }
        return value;
    }

    // More than 1 is taken as 1: what is fully there can't be there more.
    double fraction(std::string_view what) {
        const double value = number(what);
        if (!(value >= 0.0)) fail(fmt::format("{} must be from 0 to 1, not {}", what, value));
        if (value > 1.0) {
            warnings_.push_back(scanner_.place(of_material(
                fmt::format("{} must be from 0 to 1, not {}: taken as 1", what, value))));
        }
        return std::min(value, 1.0);
    }

    // One number stands for all three. Spectral curves and CIE XYZ are not read.
    std::optional<glm::vec3> colour(std::string_view keyword) {
        const char first = scanner_.peek();
        if (first == 's' || first == 'x') {
            warnings_.push_back(scanner_.place(
                of_material(fmt::format("{} is only read as red, green, blue: ignored", keyword))));
            return std::nullopt;
        }
        const double most = keyword == "Ke" ? kMostLight : kMostSurfaceColour;
        const auto light = [&] { return static_cast<float>(not_negative(keyword, most)); };
        glm::vec3 rgb(light());
        const char next = scanner_.peek();
        if (next == '\n' || next == '#') return rgb;
        rgb.y = light();
        rgb.z = light();
        return rgb;
    }

    FileText text_;
    TextScanner scanner_;
    MtlLibrary& library_;
    std::vector<std::string>& warnings_;
    MtlMaterial* material_ = nullptr;
    bool told_unknown_ = false;
    std::set<std::string> told_maps_;
};

}  // namespace

void read_mtl(const std::filesystem::path& file, MtlLibrary& library,
              std::vector<std::string>& warnings) {
    MtlParser(file, library, warnings).parse();
}

MtlPaths find_mtl(const std::filesystem::path& obj_file, const std::string& names) {
    MtlPaths paths;
    const std::vector<std::filesystem::path> folder = {obj_file.parent_path()};
    if (auto whole = find_named_file(folder, names)) {
        paths.found.push_back(*std::move(whole));
        return paths;
    }
    std::istringstream words(names);
    std::string word;
    while (words >> word) {
        if (auto path = find_named_file(folder, word)) {
            paths.found.push_back(*std::move(path));
        } else {
            paths.missing.push_back(word);
        }
    }
    // "my materials.mtl" that is not there is one file, not two.
    if (paths.found.empty()) paths.missing.assign(1, names);
    return paths;
}

}  // namespace raypick
