#include "tracer/io/obj_file.h"

#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"
#include "tracer/io/text_scanner.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace raypick {

namespace {

constexpr std::uint32_t kMaxIndex = 0x7fffffffu;

// What a number in a face counts.
struct IndexKind {
    std::string_view name;
    std::uint32_t ObjCorner::*index;
    std::string_view keyword;
};

constexpr std::array<IndexKind, 3> kIndexKinds{{
    {"vertex", &ObjCorner::position, "v"},
    {"texture coordinate", &ObjCorner::uv, "vt"},
    {"normal", &ObjCorner::normal, "vn"},
}};

// "3.1+e2": an exponent with its sign on the wrong side, as some writers print it.
std::optional<double> parse_misplaced_sign(std::string_view word) {
    const std::size_t e = word.find_first_of("eE");
    if (e == std::string_view::npos || e == 0 || (word[e - 1] != '+' && word[e - 1] != '-')) {
        return std::nullopt;
    }
    std::string fixed(word);
    std::swap(fixed[e - 1], fixed[e]);
    return parse_number(fixed);
}

class ObjParser {
public:
    ObjParser(const std::filesystem::path& file, const LoadOptions& options,
              std::vector<std::string>& warnings)
        : text_(file),
          scanner_(file.string(), text_.view(), true),
          options_(options),
          warnings_(warnings) {}

    ObjFile parse() {
        std::size_t lines = 0;
        while (!scanner_.at_end()) {
            if ((++lines & 0xfffu) == 0) {
                load_step(options_, 0.6f * static_cast<float>(scanner_.offset()) /
                                        static_cast<float>(text_.view().size()));
            }
            read_line(scanner_.word());
            scanner_.next_line();
        }
        obj_.face_begin.push_back(obj_.corners.size());
        check_forward_references();
        warn_of_rest();
        if (obj_.face_count() == 0) fail_without_faces();
        return std::move(obj_);
    }

private:
    void read_line(std::string_view keyword) {
        if (keyword.empty() || keyword[0] == '#') return;
        if (keyword == "v") {
            read_position();
        } else if (keyword == "f" || keyword == "fo") {
            read_face();
        } else if (keyword == "vn") {
            read_normal();
        } else if (keyword == "vt") {
            read_uv();
        } else if (keyword == "o") {
            current_.object = static_cast<int>(obj_.objects.size());
            obj_.objects.push_back(clean_name(scanner_.rest()));
        } else if (keyword == "g") {
            current_.group = number_of(group_name(), obj_.groups, group_numbers_);
        } else if (keyword == "usemtl") {
            current_.material =
                number_of(clean_name(scanner_.rest()), obj_.materials, material_numbers_);
        } else if (keyword == "mtllib") {
            obj_.libraries.emplace_back(scanner_.rest());
        } else {
            read_other(keyword);
        }
    }

    // Lines and points have no surface, smoothing groups give way to the crease angle.
    void read_other(std::string_view keyword) {
        if (keyword == "s") return;
        if (keyword == "l" || keyword == "p") {
            note(lines_and_points_);
        } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
            note(free_forms_);
        } else if (unknown_.count++ == 0) {
            unknown_.first = scanner_.offset();
            unknown_word_ = in_quotes(keyword);
        }
    }

    double coordinate(std::string_view what) {
        if (const std::optional<double> value = scanner_.try_number()) return *value;
        const std::size_t here = scanner_.offset();
        if (const std::optional<double> value = parse_misplaced_sign(scanner_.word())) {
            if (misplaced_signs_.count++ == 0) misplaced_signs_.first = here;
            return *value;
        }
        scanner_.return_to(here);
        return scanner_.number(what);
    }

    glm::dvec3 three(std::string_view x, std::string_view y, std::string_view z) {
        const double a = coordinate(x);
        const double b = coordinate(y);
        return {a, b, coordinate(z)};
    }

    bool line_goes_on() {
        const char next = scanner_.peek();
        return next != '\n' && next != '#';
    }

    // Weights and colours may follow; lines may go on after a backslash.
    void skip_words() {
        while (line_goes_on())
            scanner_.word();
    }

    void read_position() {
        const glm::dvec3 p = three("x of a vertex", "y of a vertex", "z of a vertex");
        if (!is_coordinate(p)) scanner_.fail(coordinate_complaint(p));
        check_count(obj_.positions.size());
        obj_.positions.push_back(p);
        skip_words();
    }

    void read_normal() {
        check_count(obj_.normals.size());
        obj_.normals.push_back(
            unit_or_zero(three("x of a normal", "y of a normal", "z of a normal")));
        skip_words();
    }

    void read_uv() {
        const double u = coordinate("u of a texture coordinate");
        const double v = line_goes_on() ? coordinate("v of a texture coordinate") : 0.0;
        check_count(obj_.uvs.size());
        obj_.uvs.push_back(uv_or_zero(u, v));
        skip_words();
    }

    void check_count(std::size_t count) const {
        if (count >= kMaxIndex) scanner_.fail("too many vertices for this program");
    }

    void read_face() {
        const std::size_t begin = obj_.corners.size();
        const std::size_t here = scanner_.offset();
        while (line_goes_on())
            obj_.corners.push_back(corner(scanner_.word()));
        const std::size_t count = obj_.corners.size() - begin;
        if (count == 0) scanner_.fail("a face without corners");
        if (count < 3) {
            obj_.corners.resize(begin);
            if (short_faces_.count++ == 0) short_faces_.first = here;
            return;
        }
        begin_run_if_changed();
        obj_.face_begin.push_back(begin);
    }

    void begin_run_if_changed() {
        const auto same = [&](const ObjRun& run) {
            return run.object == current_.object && run.group == current_.group &&
                   run.material == current_.material;
        };
        if (!obj_.runs.empty() && same(obj_.runs.back())) return;
        current_.first_face = static_cast<std::uint32_t>(obj_.face_begin.size());
        obj_.runs.push_back(current_);
    }

    // v, v/vt, v//vn or v/vt/vn
    ObjCorner corner(std::string_view word) {
        ObjCorner corner;
        std::string_view left = word;
        for (std::size_t kind = 0; kind < kIndexKinds.size(); ++kind) {
            const bool given = !left.empty() && left[0] != '/';
            if (given) {
                corner.*kIndexKinds[kind].index = index(kind, left, word);
            } else if (kind == 0) {
                fail_face(word);
            }
            if (left.empty()) return corner;
            if (left[0] != '/') fail_face(word);
            left.remove_prefix(1);
        }
        fail_face(word);
    }

    [[noreturn]] void fail_face(std::string_view word) const {
        scanner_.fail(
            fmt::format("{} is no corner of a face: v, v/vt, v//vn or v/vt/vn", in_quotes(word)));
    }

    // Takes the number off `left`. Positive numbers count from 1, negative ones back from the
    // latest.
    std::uint32_t index(std::size_t kind, std::string_view& left, std::string_view word) {
        long long number = 0;
        const char* const begin = left.data() + (left[0] == '+' ? 1 : 0);
        const auto [stop, error] = std::from_chars(begin, left.data() + left.size(), number);
        if (error == std::errc::invalid_argument) fail_face(word);
        left.remove_prefix(static_cast<std::size_t>(stop - left.data()));
        const auto count = static_cast<long long>(counts(kind));
        const long long index = number < 0 ? count + number : number - 1;
        if (error != std::errc() || number == 0 || index < 0 || index > kMaxIndex) {
            scanner_.fail(out_of_range(kind, word, counts(kind)));
        }
        const auto result = static_cast<std::uint32_t>(index);
        if (index >= count) note_forward(kind, result, word);
        return result;
    }

    [[nodiscard]] std::size_t counts(std::size_t kind) const {
        return kind == 0   ? obj_.positions.size()
               : kind == 1 ? obj_.uvs.size()
                           : obj_.normals.size();
    }

    static std::string out_of_range(std::size_t kind, std::string_view word, std::size_t count) {
        return fmt::format("{}: there is no such {} (the file has {} {} lines{})", in_quotes(word),
                           kIndexKinds[kind].name, count, kIndexKinds[kind].keyword,
                           word[0] == '0' ? "; OBJ counts from 1" : "");
    }

    // A corner may name what stands further down in the file; the furthest one is checked at the
    // end.
    struct ForwardReference {
        std::uint32_t index = 0;
        std::size_t offset = 0;
        std::string_view word;
    };

    void note_forward(std::size_t kind, std::uint32_t index, std::string_view word) {
        ForwardReference& furthest = forward_[kind];
        if (!furthest.word.empty() && index <= furthest.index) return;
        furthest = {index, scanner_.offset() - word.size(), word};
    }

    void check_forward_references() const {
        for (std::size_t kind = 0; kind < forward_.size(); ++kind) {
            const ForwardReference& furthest = forward_[kind];
            if (furthest.word.empty() || furthest.index < counts(kind)) continue;
            scanner_.fail_at(furthest.offset, out_of_range(kind, furthest.word, counts(kind)));
        }
    }

    // Several names in one line name one group.
    std::string group_name() {
        std::string name;
        while (!scanner_.at_line_end()) {
            if (!name.empty()) name += ' ';
            name += clean_name(scanner_.word());
        }
        return name.empty() ? "default" : name;  // as the format's specification says
    }

    static int number_of(std::string name, std::vector<std::string>& names,
                         std::map<std::string, int, std::less<>>& numbers) {
        const auto [entry, is_new] = numbers.try_emplace(name, static_cast<int>(names.size()));
        if (is_new) names.push_back(std::move(name));
        return entry->second;
    }

    // What is passed over, to be told once.
    struct Note {
        std::size_t count = 0;
        std::size_t first = 0;  // offset
    };

    void note(Note& what) {
        if (what.count++ == 0) what.first = scanner_.offset();
    }

    void warn(const Note& what, const std::string& text) {
        if (what.count == 0) return;
        const std::string more = what.count > 1 ? fmt::format(" ({} times)", what.count) : "";
        warnings_.push_back(scanner_.place(what.first, text + more));
    }

    void warn_of_rest() {
        warn(lines_and_points_, "lines and points are not shown");
        warn(free_forms_, "free-form curves and surfaces are not read");
        warn(short_faces_, "a face with fewer than 3 corners is left out");
        warn(misplaced_signs_, "the sign stands before the exponent's e: read as if behind it");
        warn(unknown_, fmt::format("{} is no OBJ keyword that we know: ignored", unknown_word_));
    }

    [[noreturn]] void fail_without_faces() const {
        if (unknown_.count > 0) {
            scanner_.fail_at(unknown_.first,
                             unknown_word_ + " is no OBJ keyword, and no face follows");
        }
        if (short_faces_.count > 0) {
            scanner_.fail_at(short_faces_.first,
                             "a face with fewer than 3 corners, and there is no other face");
        }
        throw FileError(
            scanner_.file(),
            fmt::format("has {} vertices but no faces: nothing to show", obj_.positions.size()));
    }

    FileText text_;
    TextScanner scanner_;
    const LoadOptions& options_;
    std::vector<std::string>& warnings_;
    ObjFile obj_;
    ObjRun current_;
    std::map<std::string, int, std::less<>> group_numbers_;
    std::map<std::string, int, std::less<>> material_numbers_;
    std::array<ForwardReference, 3> forward_;
    Note lines_and_points_;
    Note free_forms_;
    Note short_faces_;
    Note misplaced_signs_;
    Note unknown_;
    std::string unknown_word_;
};

}  // namespace

ObjFile parse_obj(const std::filesystem::path& file, const LoadOptions& options,
                  std::vector<std::string>& warnings) {
    return ObjParser(file, options, warnings).parse();
}

}  // namespace raypick
