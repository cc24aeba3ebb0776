#include "tracer/io/mtl_map.h"

#include "tracer/scene/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <system_error>
#include <utility>

namespace raypick {

namespace {

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

// The words of a map line up to the file's name.
class MapLine {
public:
    MapLine(std::string_view text, TextScanner& scanner, std::string_view material,
            std::vector<std::string>& warnings)
        : left_(text), scanner_(scanner), material_(material), warnings_(warnings) {}

    std::optional<MtlMap> read(MtlMapKind kind) {
        map_.kind = kind;
        map_.place = fmt::format("{}: line {}: material \"{}\"", scanner_.file(),
                                 scanner_.line(scanner_.offset()), material_);
        map_.folder = std::filesystem::path(scanner_.file()).parent_path();
        while (!left_.empty() && left_[0] == '-' && read_option()) {
        }
        if (left_.size() >= 2 && left_.front() == '"' && left_.back() == '"') {
            left_ = left_.substr(1, left_.size() - 2);
        }
        if (left_.empty()) {
            warn("names no file: ignored");
            return std::nullopt;
        }
        map_.file = std::string(left_);
        apply_filter();
        return std::move(map_);
    }

private:
    // False if this is no option: a file name may begin with '-' too.
    bool read_option() {
        const std::string option = lower(first_word());
        if (option == "-o" || option == "-s" || option == "-t") {
            read_vector(option);
        } else if (option == "-mm") {
            skip_word();
            map_.use.base = static_cast<float>(number(option, 0.0));
            map_.use.gain = static_cast<float>(number(option, 1.0));
        } else if (option == "-bm") {
            skip_word();
            map_.bump = number(option, 1.0);
        } else if (option == "-boost" || option == "-texres") {
            skip_word();
            number(option, 0.0);  // sharper mip levels, another size: nothing here
        } else if (option == "-cc" || option == "-clamp" || option == "-blendu" ||
                   option == "-blendv") {
            read_switch(option);
        } else if (option == "-imfchan") {
            skip_word();
            read_channel();
        } else if (option == "-type") {
            skip_word();
            skip_word();
        } else {
            return false;
        }
        return true;
    }

    // One to three numbers; those left out keep their value.
    void read_vector(const std::string& option) {
        skip_word();
        std::array<double, 2> uv = {option == "-s" ? 1.0 : 0.0, option == "-s" ? 1.0 : 0.0};
        std::size_t count = 0;
        // The last word of the line is the file, whatever it looks like.
        while (count < 3 && has_more_words()) {
            const std::optional<double> value = parse_number(first_word());
            if (!value) break;
            if (count < uv.size() && is_usable(*value)) uv[count] = *value;
            skip_word();
            ++count;
        }
        if (count == 0) warn(option + " needs numbers: ignored");
        if (option == "-t") {
            warn("-t (turbulence) is not read");
            return;
        }
        const auto u = static_cast<float>(uv[0]);
        const auto v = static_cast<float>(uv[1]);
        if (option == "-s") {
            map_.use.u_row.x = u;
            map_.use.v_row.y = v;
        } else {
            map_.use.u_row.z = u;
            map_.use.v_row.z = v;
        }
    }

    double number(const std::string& option, double otherwise) {
        const std::optional<double> value =
            has_more_words() ? parse_number(first_word()) : std::nullopt;
        if (!value) {
            warn(option + " needs a number: ignored");
            return otherwise;
        }
        skip_word();
        if (is_usable(*value)) return *value;
        warn(fmt::format("{} must be within {}: ignored", option, kLargestCoordinate));
        return otherwise;
    }

    void read_switch(const std::string& option) {
        skip_word();
        const std::string word = lower(first_word());
        if (word != "on" && word != "off") {
            warn(option + " must be on or off: ignored");
            return;
        }
        skip_word();
        const bool on = word == "on";
        if (option == "-clamp") {
            map_.use.wrap_u = map_.use.wrap_v = on ? Wrap::clamp : Wrap::repeat;
        } else if (option == "-blendu") {
            blend_u_ = on;
        } else if (option == "-blendv") {
            blend_v_ = on;
        }
    }

    void read_channel() {
        const std::string word = lower(first_word());
        if (word.size() == 1 && std::string_view("rgbmlz").find(word[0]) != std::string::npos) {
            map_.channel = word[0];
            skip_word();
        } else {
            warn("-imfchan must be r, g, b, m, l or z: ignored");
        }
    }

    // There is one filter for both directions.
    void apply_filter() {
        if (!blend_u_ && !blend_v_) map_.use.filter = TextureFilter::nearest;
    }

    static bool is_usable(double value) { return std::abs(value) <= kLargestCoordinate; }

    [[nodiscard]] std::string_view first_word() const {
        return left_.substr(0, std::min(left_.find_first_of(" \t"), left_.size()));
    }
    [[nodiscard]] bool has_more_words() const { return first_word().size() < left_.size(); }
    void skip_word() {
        left_.remove_prefix(first_word().size());
        left_.remove_prefix(std::min(left_.find_first_not_of(" \t"), left_.size()));
    }

    void warn(const std::string& text) { warnings_.push_back(map_.place + ": " + text); }

    std::string_view left_;
    TextScanner& scanner_;
    std::string_view material_;
    std::vector<std::string>& warnings_;
    MtlMap map_;
    bool blend_u_ = true;
    bool blend_v_ = true;
};

// A file of the folder whose name differs in case only.
std::optional<std::filesystem::path> find_in_any_case(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path folder = path.parent_path();
    const std::string wanted = lower(path.filename().string());
    for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error), end;
         !error && entry != end; entry.increment(error)) {
        if (lower(entry->path().filename().string()) == wanted && entry->is_regular_file(error)) {
            return entry->path();
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<MtlMapKind> mtl_map_kind(std::string_view keyword) {
    static constexpr std::array<std::pair<std::string_view, MtlMapKind>, 11> kKinds = {{
        {"map_kd", MtlMapKind::diffuse},
        {"map_ks", MtlMapKind::specular},
        {"map_ns", MtlMapKind::shininess},
        {"map_d", MtlMapKind::opacity},
        {"map_opacity", MtlMapKind::opacity},
        {"map_tr", MtlMapKind::transparency},
        {"map_ke", MtlMapKind::emissive},
        {"map_bump", MtlMapKind::bump},
        {"bump", MtlMapKind::bump},
        {"norm", MtlMapKind::normal},
        {"map_kn", MtlMapKind::normal},
    }};
    const std::string name = lower(keyword);
    const auto* const found = std::find_if(kKinds.begin(), kKinds.end(),
                                           [&](const auto& kind) { return kind.first == name; });
    if (found == kKinds.end()) return std::nullopt;
    return found->second;
}

bool is_mtl_map(std::string_view keyword) {
    const std::string name = lower(keyword);
    return name.substr(0, 4) == "map_" || name == "bump" || name == "disp" || name == "decal" ||
           name == "refl" || name == "norm";
}

std::optional<MtlMap> read_mtl_map(TextScanner& scanner, MtlMapKind kind, std::string_view material,
                                   std::vector<std::string>& warnings) {
    return MapLine(scanner.rest(), scanner, material, warnings).read(kind);
}

std::optional<std::filesystem::path> find_named_file(
    const std::vector<std::filesystem::path>& folders, const std::string& name) {
    std::string slashed = name;
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    const std::filesystem::path path = slashed;
    if (!path.has_filename()) return std::nullopt;
    std::vector<std::filesystem::path> candidates;
    for (const std::filesystem::path& wanted : {path, path.filename()}) {
        for (const std::filesystem::path& folder : folders)
            candidates.push_back(folder / wanted);
    }
    std::error_code error;
    for (const std::filesystem::path& candidate : candidates) {
        if (std::filesystem::is_regular_file(candidate, error)) return candidate;
    }
    for (const std::filesystem::path& candidate : candidates) {
        if (auto found = find_in_any_case(candidate)) return found;
    }
    return std::nullopt;
}

}  // namespace raypick
