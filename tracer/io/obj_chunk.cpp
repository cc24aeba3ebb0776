#include "tracer/io/obj_chunk.h"

#include "tracer/io/file_bytes.h"
#include "tracer/io/mesh_build.h"
#include "tracer/io/text_scanner.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

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
    ObjParser(const std::string& file, std::string_view text, const ObjRange& range)
        : scanner_(file, text.substr(0, range.end), true), before_(range.before) {
        scanner_.return_to(range.begin);
        obj_.positions.reserve(range.within[0]);
        obj_.uvs.reserve(range.within[1]);
        obj_.normals.reserve(range.within[2]);
    }

    // `step` is called now and then with the bytes read since the last time.
    ObjChunk parse(const std::function<void(std::size_t)>& step) {
        std::size_t lines = 0;
        std::size_t told = scanner_.offset();
        while (!scanner_.at_end()) {
            if ((++lines & 0xfffu) == 0) {
                step(scanner_.offset() - told);
                told = scanner_.offset();
            }
            read_line(scanner_.word());
            scanner_.next_line();
        }
        return std::move(chunk_);
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
            current_.group = groups_.number_of(group_name(), obj_.groups);
        } else if (keyword == "usemtl") {
            current_.material = materials_.number_of(clean_name(scanner_.rest()), obj_.materials);
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
            note(notes_.lines_and_points);
        } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
            note(notes_.free_forms);
        } else if (notes_.unknown.count++ == 0) {
            notes_.unknown.first = scanner_.offset();
            notes_.unknown_word = in_quotes(keyword);
        }
    }

    double coordinate(std::string_view what) {
        if (const std::optional<double> value = scanner_.try_number()) return *value;
        const std::size_t here = scanner_.offset();
        if (const std::optional<double> value = parse_misplaced_sign(scanner_.word())) {
            if (notes_.misplaced_signs.count++ == 0) notes_.misplaced_signs.first = here;
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
        check_count(counts(0));
        obj_.positions.push_back(p);
        skip_words();
    }

    void read_normal() {
        check_count(counts(2));
        obj_.normals.push_back(
            unit_or_zero(three("x of a normal", "y of a normal", "z of a normal")));
        skip_words();
    }

    void read_uv() {
        const double u = coordinate("u of a texture coordinate");
        const double v = line_goes_on() ? coordinate("v of a texture coordinate") : 0.0;
        check_count(counts(1));
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
            if (notes_.short_faces.count++ == 0) notes_.short_faces.first = here;
            return;
        }
        begin_run_if_changed();
        obj_.face_begin.push_back(begin);
    }

    void begin_run_if_changed() {
        if (!obj_.runs.empty() && same_names(obj_.runs.back(), current_)) return;
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

    // So far in the file.
    [[nodiscard]] std::size_t counts(std::size_t kind) const {
        return before_[kind] + count_of(obj_, kind);
    }

    void note_forward(std::size_t kind, std::uint32_t index, std::string_view word) {
        chunk_.forward[kind].add({index, scanner_.offset() - word.size(), word});
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

    void note(Note& what) {
        if (what.count++ == 0) what.first = scanner_.offset();
    }

    TextScanner scanner_;
    std::array<std::size_t, 3> before_;
    ObjChunk chunk_;
    ObjFile& obj_ = chunk_.obj;
    ObjRun& current_ = chunk_.last;
    ObjNotes& notes_ = chunk_.notes;
    NameNumbers groups_;
    NameNumbers materials_;
};

}  // namespace

bool same_names(const ObjRun& a, const ObjRun& b) {
    return a.object == b.object && a.group == b.group && a.material == b.material;
}

std::size_t count_of(const ObjFile& obj, std::size_t kind) {
    return kind == 0 ? obj.positions.size() : kind == 1 ? obj.uvs.size() : obj.normals.size();
}

std::string out_of_range(std::size_t kind, std::string_view word, std::size_t count) {
    return fmt::format("{}: there is no such {} (the file has {} {} lines{})", in_quotes(word),
                       kIndexKinds[kind].name, count, kIndexKinds[kind].keyword,
                       word[0] == '0' ? "; OBJ counts from 1" : "");
}

ObjChunk parse_obj_chunk(const std::string& file, std::string_view text, const ObjRange& range,
                         const std::function<void(std::size_t)>& step) {
    return ObjParser(file, text, range).parse(step);
}

}  // namespace raypick
