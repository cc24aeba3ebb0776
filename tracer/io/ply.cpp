// PLY (Stanford): one mesh, ascii or binary.
#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/io/formats.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"
#include "tracer/io/ply_header.h"
#include "tracer/io/polygon.h"
#include "tracer/io/text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace raypick {

namespace {

constexpr std::uint64_t kMaxVertices = 0x7fffffffu;

// Items of an ascii file: one a line.
class AsciiItems {
public:
    AsciiItems(const std::string& file, std::string_view text, std::size_t offset)
        : scanner_(file, text) {
        scanner_.return_to(offset);
    }

    void begin_item() {
        while (scanner_.at_line_end() && !scanner_.at_end())
            scanner_.next_line();
    }
    void end_item() { scanner_.next_line(); }
    double value(PlyType) { return scanner_.number("a value"); }
    [[nodiscard]] std::uint64_t bytes_left() const { return scanner_.bytes_left(); }
    [[noreturn]] void fail(const std::string& complaint) const { scanner_.fail(complaint); }

private:
    TextScanner scanner_;
};

// Items of a binary file, without gaps.
class BinaryItems {
public:
    BinaryItems(std::string file, std::string_view bytes, std::size_t offset, bool swap)
        : file_(std::move(file)), bytes_(bytes), at_(offset), item_(offset), swap_(swap) {}

    void begin_item() { item_ = at_; }
    void end_item() {}

    double value(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return read<std::int8_t>();
            case PlyType::uint8:
                return read<std::uint8_t>();
            case PlyType::int16:
                return read<std::int16_t>();
            case PlyType::uint16:
                return read<std::uint16_t>();
            case PlyType::int32:
                return read<std::int32_t>();
            case PlyType::uint32:
                return read<std::uint32_t>();
            case PlyType::float32:
                return static_cast<double>(read<float>());
            case PlyType::float64:
                break;
        }
        return read<double>();
    }

    [[nodiscard]] std::uint64_t bytes_left() const { return bytes_.size() - at_; }
    [[noreturn]] void fail(const std::string& complaint) const {
        throw FileError(file_, fmt::format("byte {}: {}", item_, complaint));
    }

private:
    template <typename T>
    T read() {
        if (bytes_.size() - at_ < sizeof(T)) {
            item_ = at_;
            fail("the file ends here, in the middle of an element");
        }
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        if (swap_) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<T>(raw);
    }

    std::string file_;
    std::string_view bytes_;
    std::size_t at_;
    std::size_t item_;  // where the item at hand begins
    bool swap_;
};

struct PlyMesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> uvs;
    std::vector<glm::uvec3> triangles;
    std::size_t short_faces = 0;
};

// Where a vertex keeps what we read.
struct VertexLayout {
    std::array<std::size_t, 3> position{};
    std::array<std::size_t, 3> normal{};
    std::array<std::size_t, 2> uv{};
    bool has_normal = false;
    bool has_uv = false;
};

template <std::size_t N>
bool find_all(const PlyElement& element, const std::array<std::string_view, N>& names,
              std::array<std::size_t, N>& places) {
    for (std::size_t i = 0; i < N; ++i) {
        const std::optional<std::size_t> place = element.find(names[i]);
        if (!place || element.properties[*place].list_count) return false;
        places[i] = *place;
    }
    return true;
}

std::optional<VertexLayout> vertex_layout(const PlyElement& element) {
    VertexLayout layout;
    if (!find_all<3>(element, {"x", "y", "z"}, layout.position)) return std::nullopt;
    layout.has_normal = find_all<3>(element, {"nx", "ny", "nz"}, layout.normal);
    layout.has_uv = find_all<2>(element, {"u", "v"}, layout.uv) ||
                    find_all<2>(element, {"s", "t"}, layout.uv) ||
                    find_all<2>(element, {"texture_u", "texture_v"}, layout.uv);
    return layout;
}

template <typename Items>
class PlyReader {
public:
    PlyReader(Items items, const PlyHeader& header, const std::string& file,
              const LoadOptions& options)
        : items_(std::move(items)), header_(header), file_(file), options_(options) {}

    PlyMesh read() {
        for (const PlyElement& element : header_.elements) {
            check_promise(element);
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "face") {
                read_faces(element, false);
            } else if (element.name == "tristrips") {
                read_faces(element, true);
            } else {
                skip(element);
            }
        }
        return std::move(mesh_);
    }

private:
    // A header may promise anything: what the file can't hold is refused before it costs memory.
    void check_promise(const PlyElement& element) const {
        const std::size_t item = element.smallest_item(header_.format);
        const std::uint64_t left = items_.bytes_left() + 1;  // the last line may lack its end
        const bool fits = item == 0 || element.count <= left / item;
        if (fits && element.count <= kMaxVertices) return;
        throw FileError(
            file_, fmt::format("line {}: the header promises {} elements {}, but only {} "
                               "bytes follow",
                               element.line, element.count, in_quotes(element.name), left - 1));
    }

    void step(std::uint64_t item, std::uint64_t count, float from, float to) const {
        if ((item & 0x3fffu) != 0) return;
        const float done = static_cast<float>(item) / static_cast<float>(count);
        load_step(options_, from + (to - from) * done);
    }

    void read_vertices(const PlyElement& element) {
        const std::optional<VertexLayout> layout = vertex_layout(element);
        if (!layout) {
            throw FileError(file_,
                            fmt::format("line {}: the vertices have no x, y and z", element.line));
        }
        if (!mesh_.positions.empty()) {
            throw FileError(file_,
                            fmt::format("line {}: vertices for a second time", element.line));
        }
        mesh_.positions.reserve(element.count);
        if (layout->has_normal) mesh_.normals.reserve(element.count);
        if (layout->has_uv) mesh_.uvs.reserve(element.count);
        std::vector<double> values(element.properties.size());
        for (std::uint64_t i = 0; i < element.count; ++i) {
            step(i, element.count, 0.0f, 0.3f);
            items_.begin_item();
            for (std::size_t p = 0; p < values.size(); ++p)
                values[p] = read_property(element.properties[p]);
            add_vertex(*layout, values);
            items_.end_item();
        }
    }

    // The value; of a list, which we pass over, its length.
    double read_property(const PlyProperty& property) {
        if (!property.list_count) return items_.value(property.type);
        const std::uint64_t length = list_length(property);
        for (std::uint64_t i = 0; i < length; ++i)
            items_.value(property.type);
        return static_cast<double>(length);
    }

    void add_vertex(const VertexLayout& layout, const std::vector<double>& values) {
        const auto three = [&](const std::array<std::size_t, 3>& at) {
            return glm::dvec3(values[at[0]], values[at[1]], values[at[2]]);
        };
        const glm::dvec3 position = three(layout.position);
        if (!is_coordinate(position)) {
            items_.fail(fmt::format("vertex {}: {}", mesh_.positions.size(),
                                    coordinate_complaint(position)));
        }
        mesh_.positions.push_back(position);
        if (layout.has_normal) mesh_.normals.push_back(unit_or_zero(three(layout.normal)));
        if (layout.has_uv) {
            mesh_.uvs.push_back(uv_or_zero(values[layout.uv[0]], values[layout.uv[1]]));
        }
    }

    // Throws if what is left of the file can't hold such a list.
    std::uint64_t list_length(const PlyProperty& property) {
        const double length = items_.value(*property.list_count);
        if (!(length >= 0.0) || length != std::floor(length)) {
            items_.fail(
                fmt::format("the list {} has the length {}", in_quotes(property.name), length));
        }
        const std::size_t item = header_.format == PlyFormat::ascii ? 2 : byte_size(property.type);
        const std::uint64_t most = (items_.bytes_left() + 1) / item;
        if (length > static_cast<double>(most)) {
            items_.fail(fmt::format("the list {} has the length {}, but only {} bytes follow",
                                    in_quotes(property.name), length, items_.bytes_left()));
        }
        return static_cast<std::uint64_t>(length);
    }

    void read_faces(const PlyElement& element, bool strips) {
        std::optional<std::size_t> indices = element.find("vertex_indices");
        if (!indices) indices = element.find("vertex_index");
        if (!indices || !element.properties[*indices].list_count) {
            throw FileError(file_,
                            fmt::format("line {}: the elements {} have no list vertex_indices",
                                        element.line, in_quotes(element.name)));
        }
        mesh_.triangles.reserve(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            step(i, element.count, 0.3f, 0.6f);
            items_.begin_item();
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                if (p == *indices) {
                    read_indices(element.properties[p]);
                } else {
                    read_property(element.properties[p]);
                }
            }
            if (strips) {
                add_strip();
            } else {
                add_face();
            }
            items_.end_item();
        }
    }

    void read_indices(const PlyProperty& property) {
        const std::uint64_t length = list_length(property);
        indices_.clear();
        for (std::uint64_t i = 0; i < length; ++i)
            indices_.push_back(items_.value(property.type));
    }

    [[nodiscard]] std::uint32_t checked(double index) const {
        const auto count = static_cast<double>(mesh_.positions.size());
        if (!(index >= 0.0 && index < count) || index != std::floor(index)) {
            items_.fail(fmt::format("there is no vertex {} (the file has {}, counted from 0)",
                                    index, mesh_.positions.size()));
        }
        return static_cast<std::uint32_t>(index);
    }

    void add_face() {
        corners_.clear();
        for (const double index : indices_)
            corners_.push_back(checked(index));
        if (corners_.size() < 3) {
            ++mesh_.short_faces;
        } else if (corners_.size() == 3) {
            mesh_.triangles.emplace_back(corners_[0], corners_[1], corners_[2]);
        } else {
            points_.clear();
            for (const std::uint32_t corner : corners_)
                points_.push_back(mesh_.positions[corner]);
            for (const glm::uvec3& t : splitter_.split(points_))
                mesh_.triangles.emplace_back(corners_[t.x], corners_[t.y], corners_[t.z]);
        }
    }

    // -1 begins a new strip; every second triangle turns the other way.
    void add_strip() {
        std::size_t begin = 0;
        for (std::size_t i = 0; i < indices_.size(); ++i) {
            if (indices_[i] == -1.0) {
                begin = i + 1;
            } else if (i >= begin + 2) {
                const std::uint32_t a = checked(indices_[i - 2]);
                const std::uint32_t b = checked(indices_[i - 1]);
                const std::uint32_t c = checked(indices_[i]);
                const bool odd = (i - begin) % 2 == 1;
                mesh_.triangles.push_back(odd ? glm::uvec3(b, a, c) : glm::uvec3(a, b, c));
            }
        }
    }

    void skip(const PlyElement& element) {
        if (element.properties.empty()) return;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            step(i, element.count, 0.6f, 0.6f);
            items_.begin_item();
            for (const PlyProperty& property : element.properties)
                read_property(property);
            items_.end_item();
        }
    }

    Items items_;
    const PlyHeader& header_;
    const std::string& file_;
    const LoadOptions& options_;
    PlyMesh mesh_;
    PolygonSplitter splitter_;
    std::vector<double> indices_;
    std::vector<std::uint32_t> corners_;
    std::vector<glm::dvec3> points_;
};

PlyMesh read_data(const std::string& file, std::string_view bytes, const PlyHeader& header,
                  const LoadOptions& options) {
    if (header.format == PlyFormat::ascii) {
        AsciiItems items(file, bytes, header.data_offset);
        return PlyReader<AsciiItems>(std::move(items), header, file, options).read();
    }
    constexpr bool kThisIsLittle = std::endian::native == std::endian::little;
    const bool swap = (header.format == PlyFormat::little_endian) != kThisIsLittle;
    BinaryItems items(file, bytes, header.data_offset, swap);
    return PlyReader<BinaryItems>(std::move(items), header, file, options).read();
}

MeshData relative_to(const glm::dvec3& origin, PlyMesh mesh) {
    MeshData data;
    data.positions.reserve(mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions)
        data.positions.emplace_back(p - origin);
    data.normals = std::move(mesh.normals);
    data.uvs = std::move(mesh.uvs);
    data.triangles = std::move(mesh.triangles);
    return data;
}

// Vertices that no face uses don't count.
glm::dvec3 origin_of(const PlyMesh& mesh) {
    PointBounds bounds;
    for (const glm::uvec3& t : mesh.triangles) {
        for (const std::uint32_t vertex : {t.x, t.y, t.z})
            bounds.extend(mesh.positions[vertex]);
    }
    return storage_origin(bounds);
}

}  // namespace

LoadedScene load_ply(const std::filesystem::path& file, const LoadOptions& options) {
    const FileBytes bytes = read_file(file);
    LoadedScene loaded = begin_scene(options);
    TextScanner scanner(file.string(), bytes.view());
    const PlyHeader header = parse_ply_header(scanner, loaded.warnings);
    PlyMesh mesh = read_data(file.string(), bytes.view(), header, options);
    if (mesh.triangles.empty()) {
        throw FileError(file.string(), fmt::format("has {} vertices but no faces: nothing to show",
                                                   mesh.positions.size()));
    }
    if (mesh.short_faces > 0) {
        loaded.warnings.push_back(warning(
            file,
            fmt::format("{} faces with fewer than 3 corners are left out", mesh.short_faces)));
    }
    const glm::dvec3 origin = origin_of(mesh);
    MeshData data = relative_to(origin, std::move(mesh));
    load_step(options, 0.6f);
    data = with_shading_normals(std::move(data), options.crease_degrees);
    place_mesh(loaded.scene, origin, make_mesh(clean_name(file.stem().string()), std::move(data)));
    return loaded;
}

}  // namespace raypick
