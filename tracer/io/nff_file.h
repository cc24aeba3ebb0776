// What a Neutral File Format file says, before it becomes a scene. Source: Eric Haines, "Neutral
// File Format", version 3.9, 1996.
#pragma once

#include "tracer/io/load.h"
#include "tracer/io/polygon.h"
#include "tracer/io/text_scanner.h"
#include "tracer/scene/limits.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

// Primitives of one kind that show the same sides: `count` are there, `parts` cover them.
struct NffGroup {
    std::vector<Part> parts;

    void add(std::uint32_t count, MaterialId material);
    [[nodiscard]] std::uint32_t size() const;
};

struct NffSpheres : NffGroup {
    std::vector<glm::dvec4> spheres;  // centre, radius > 0
};

struct NffCones : NffGroup {
    std::vector<glm::dvec4> ends;  // base and apex in turn: centre, radius >= 0
};

struct NffTriangles : NffGroup {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;  // of patches: one a position
    std::vector<glm::uvec3> triangles;
};

struct NffLight {
    glm::dvec3 position{0.0};
    std::optional<glm::vec3> colour;
};

struct NffPlane {
    Plane plane;
    MaterialId material = kNoMaterial;
    Sides sides = Sides::front_only;
};

// Numbers of values of Sides.
inline constexpr std::size_t kSideKinds = 3;

struct NffContent {
    std::optional<Camera> camera;
    glm::vec3 background{0.0f};
    std::vector<NffLight> lights;
    std::vector<Material> materials;  // one for all equal f lines: "f1", "f2", ...
    // By Sides.
    std::array<NffSpheres, kSideKinds> spheres;
    std::array<NffCones, kSideKinds> cones;
    std::array<NffTriangles, kSideKinds> polygons;
    std::array<NffTriangles, kSideKinds> patches;
    std::vector<NffPlane> planes;
};

// Reads the entities one by one. Numbers may stand on any line, as for the scanf of the original
// programs. Also understands what other programs add: `pl` (an infinite plane through three
// points), fewer numbers behind `f`, names of textures there and `tess`, both of which are left
// out.
class NffReader {
public:
    // `text` without comments. Warnings are appended.
    NffReader(const std::string& file, std::string_view text, const LoadOptions& options,
              std::vector<std::string>& warnings);

    // Throws FileError that names the line, or Cancelled.
    NffContent read();

private:
    void read_entity(std::string_view keyword);
    void read_view();
    void read_light();
    void read_fill();
    void read_sphere();
    void read_cone();
    void read_polygon(bool is_patch);
    void read_plane();
    void skip_rest_of_line(std::string_view of);

    double number(std::string_view what);
    // The next number, if that is what comes next.
    std::optional<double> optional_number();
    double not_negative(std::string_view what, double most = kMostLight);
    glm::dvec3 point(std::string_view what);
    glm::vec3 colour(std::string_view what);
    std::size_t corner_count(std::size_t numbers_a_corner);

    MaterialId material_of(const std::array<double, 8>& numbers);
    [[nodiscard]] Sides outer_sides() const;

    TextScanner scanner_;
    const LoadOptions& options_;
    std::vector<std::string>& warnings_;
    std::size_t text_size_;
    NffContent content_;
    MaterialId material_ = kNoMaterial;  // of what follows
    bool transmits_ = false;
    std::map<std::array<double, 8>, MaterialId> known_fills_;
    PolygonSplitter splitter_;
    std::vector<glm::dvec3> corners_;
    std::vector<glm::dvec3> normals_;
};

// The text with all comments (# to the line's end) turned into blanks, so that offsets hold.
std::string without_nff_comments(std::string_view text);

}  // namespace raypick
