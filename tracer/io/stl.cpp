// STL: binary, or ascii with any number of solids.
//
// Facet normals are not read: they say no more than the order of the corners, and are often 0.
#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/io/file_kind.h"
#include "tracer/io/formats.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"
#include "tracer/io/text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace raypick {

namespace {

constexpr std::size_t kHeaderSize = 84;  // 80 bytes of text, the number of facets
constexpr std::size_t kFacetSize = 50;   // normal, three corners, two bytes

template <typename T>
T little_endian(const char* bytes) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
}

// Three corners a triangle.
struct StlSolid {
    std::string name;
    std::vector<glm::dvec3> corners;
};

bool same_word(std::string_view word, std::string_view lower_case) {
    return std::equal(
        word.begin(), word.end(), lower_case.begin(), lower_case.end(),
        [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

class AsciiStl {
public:
    AsciiStl(const std::filesystem::path& file, const LoadOptions& options)
        : text_(file), scanner_(file.string(), text_.view()), options_(options) {}

    std::vector<StlSolid> read() {
        for (std::string_view word = scanner_.word_anywhere(); !word.empty();
             word = scanner_.word_anywhere()) {
            if (same_word(word, "solid")) {
                begin_solid();
            } else if (same_word(word, "facet")) {
                read_facet();
            } else if (same_word(word, "endsolid")) {
                scanner_.next_line();
                in_solid_ = false;
            } else {
                scanner_.fail(in_quotes(word) + " where solid, facet or endsolid should stand");
            }
        }
        if (in_solid_) scanner_.fail("the file ends before endsolid");
        return std::move(solids_);
    }

private:
    void begin_solid() {
        if (in_solid_) scanner_.fail("solid before the endsolid of the one before");
        solids_.push_back({clean_name(scanner_.rest()), {}});
        in_solid_ = true;
    }

    void read_facet() {
        if (!in_solid_) scanner_.fail("facet outside of a solid");
        if ((facets_++ & 0xfffu) == 0) load_step(options_, 0.0f);
        expect("normal");
        for (int i = 0; i < 3; ++i)
            scanner_.number("a facet's normal");
        expect("outer");
        expect("loop");
        for (int i = 0; i < 3; ++i)
            read_vertex();
        expect("endloop");
        expect("endfacet");
    }

    void expect(std::string_view keyword) {
        const std::string_view word = scanner_.word_anywhere();
        if (same_word(word, keyword)) return;
        if (word.empty())
            scanner_.fail(fmt::format("the file ends where {} should stand", keyword));
        scanner_.fail(fmt::format("{} where {} should stand", in_quotes(word), keyword));
    }

    void read_vertex() {
        expect("vertex");
        glm::dvec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = scanner_.number("a coordinate");
        if (!is_coordinate(p)) scanner_.fail(coordinate_complaint(p));
        solids_.back().corners.push_back(p);
    }

    FileText text_;
    TextScanner scanner_;
    const LoadOptions& options_;
    std::vector<StlSolid> solids_;
    std::size_t facets_ = 0;
    bool in_solid_ = false;
};

std::vector<StlSolid> read_binary(const std::filesystem::path& file, const LoadOptions& options,
                                  std::vector<std::string>& warnings) {
    const FileBytes bytes = read_file(file);
    const std::string_view view = bytes.view();
    if (view.size() < kHeaderSize) {
        throw FileError(file.string(), fmt::format("byte {}: the file ends in the header of a "
                                                   "binary STL, which is {} bytes long",
                                                   view.size(), kHeaderSize));
    }
    const auto count = little_endian<std::uint32_t>(view.data() + kHeaderSize - 4);
    const std::uint64_t needed = kHeaderSize + std::uint64_t{count} * kFacetSize;
    if (needed > view.size()) {
        throw FileError(file.string(), fmt::format("byte 80: promises {} facets ({} bytes), but "
                                                   "the file has {} bytes",
                                                   count, needed, view.size()));
    }
    if (needed < view.size()) {
        warnings.push_back(warning(file, fmt::format("byte {}: {} bytes after the last facet are "
                                                     "ignored",
                                                     needed, view.size() - needed)));
    }
    StlSolid solid;
    solid.corners.reserve(std::size_t{count} * 3);
    for (std::uint32_t facet = 0; facet < count; ++facet) {
        if ((facet & 0x3fffu) == 0) load_step(options, 0.0f);
        const std::size_t begin = kHeaderSize + std::size_t{facet} * kFacetSize + 12;
        for (std::size_t at = begin; at < begin + 36; at += 12) {
            const char* xyz = view.data() + at;
            const glm::dvec3 p(little_endian<float>(xyz), little_endian<float>(xyz + 4),
                               little_endian<float>(xyz + 8));
            if (!is_coordinate(p)) {
                throw FileError(file.string(),
                                fmt::format("byte {}: {}", at, coordinate_complaint(p)));
            }
            solid.corners.push_back(p);
        }
    }
    std::vector<StlSolid> solids;
    solids.push_back(std::move(solid));
    return solids;
}

MeshData relative_to(const glm::dvec3& origin, const std::vector<glm::dvec3>& corners) {
    MeshData data;
    data.positions.reserve(corners.size());
    data.triangles.reserve(corners.size() / 3);
    for (const glm::dvec3& p : corners)
        data.positions.emplace_back(p - origin);
    for (std::uint32_t i = 0; i + 2 < corners.size(); i += 3)
        data.triangles.emplace_back(i, i + 1, i + 2);
    return data;
}

}  // namespace

LoadedScene load_stl(const std::filesystem::path& file, const LoadOptions& options) {
    LoadedScene loaded = begin_scene(options);
    std::vector<StlSolid> solids = is_binary_stl(read_head(file))
                                       ? read_binary(file, options, loaded.warnings)
                                       : AsciiStl(file, options).read();
    PointBounds bounds;
    for (const StlSolid& solid : solids) {
        for (const glm::dvec3& p : solid.corners)
            bounds.extend(p);
    }
    const glm::dvec3 origin = storage_origin(bounds);
    for (StlSolid& solid : solids) {
        if (solid.corners.empty()) continue;
        const bool named = !solid.name.empty();
        MeshData data = relative_to(origin, solid.corners);
        data = with_shading_normals(std::move(data), options.crease_degrees);
        place_mesh(
            loaded.scene, origin,
            make_mesh(named ? solid.name : clean_name(file.stem().string()), std::move(data)));
        load_step(options, 0.9f);
    }
    if (loaded.scene.objects.empty())
        throw FileError(file.string(), "has no facets: nothing to show");
    return loaded;
}

}  // namespace raypick
