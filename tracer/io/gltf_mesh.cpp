#include "tracer/io/gltf_mesh.h"

#include "tracer/io/gltf_accessor.h"
#include "tracer/io/mesh_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <list>
#include <optional>
#include <utility>
#include <vector>

namespace raypick {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

enum class Mode { triangles = 4, strip = 5, fan = 6 };

// The vertices that primitives with the same attributes share, each taken over when first used.
class VertexSource {
public:
    using Key = std::array<std::size_t, 3>;  // accessors: position, normal, uv

    VertexSource(GltfDocument& document, const JsonValue& attributes, const Key& key,
                 const std::string& uv_name)
        : key_(key), position_(document, key[0], "VEC3"), vertex_(position_.count(), kNone) {
        if (key[1] != kNoAccessor) normal_.emplace(document, key[1], "VEC3");
        if (key[2] != kNoAccessor) uv_.emplace(document, key[2], "VEC2");
        check_count(attributes, "NORMAL", normal_);
        check_count(attributes, uv_name, uv_);
    }

    static constexpr std::size_t kNoAccessor = static_cast<std::size_t>(-1);

    static Key key_of(const GltfDocument& document, const JsonValue& attributes,
                      const std::string& uv_name) {
        Key key;
        key[0] = document.index(attributes.need("POSITION"), "accessors");
        const auto optional = [&](std::string_view name) {
            const std::optional<JsonValue> accessor = attributes.find(name);
            return accessor ? document.index(*accessor, "accessors") : kNoAccessor;
        };
        key[1] = optional("NORMAL");
        key[2] = optional(uv_name);
        return key;
    }

    [[nodiscard]] const Key& key() const { return key_; }
    [[nodiscard]] std::size_t count() const { return position_.count(); }

    // Makes room for what so many corners may take.
    void reserve(std::size_t corners, MeshData& data) const {
        const std::size_t most = std::min(corners, count());
        data.positions.reserve(most);
        data.normals.reserve(most);
        data.uvs.reserve(most);
    }

    // The number in `data` of vertex i; its arrays are all filled, with 0 where nothing is given.
    std::uint32_t take(std::size_t i, MeshData& data) {
        if (vertex_[i] != kNone) return vertex_[i];
        const glm::dvec3 position = position_.vec3(i);
        if (!is_coordinate(position)) position_.fail(i, coordinate_complaint(position));
        vertex_[i] = static_cast<std::uint32_t>(data.positions.size());
        data.positions.emplace_back(position);
        data.normals.push_back(normal_ ? unit_or_zero(normal_->vec3(i)) : glm::vec3(0.0f));
        // In glTF v grows downwards.
        const glm::dvec2 uv = uv_ ? uv_->vec2(i) : glm::dvec2(0.0);
        data.uvs.push_back(uv_ ? uv_or_zero(uv.x, 1.0 - uv.y) : glm::vec2(0.0f));
        return vertex_[i];
    }

private:
    void check_count(const JsonValue& attributes, std::string_view name,
                     const std::optional<GltfAccessor>& accessor) const {
        if (!accessor || accessor->count() >= count()) return;
        attributes.need(name).fail(
            fmt::format("{} elements for {} positions", accessor->count(), count()));
    }

    Key key_;
    GltfAccessor position_;
    std::optional<GltfAccessor> normal_;
    std::optional<GltfAccessor> uv_;
    std::vector<std::uint32_t> vertex_;
};

class MeshReader {
public:
    MeshReader(GltfDocument& document, const std::vector<int>& uv_sets)
        : document_(document), uv_sets_(uv_sets) {}

    GltfMesh read(const JsonValue& json, std::string name) {
        for (const JsonValue& primitive : json.need("primitives").elements())
            read_primitive(primitive);
        if (!has_uvs_) data_.uvs.clear();
        if (has_normals_) {
            fill_normals(data_);
        } else {
            data_.normals.clear();  // flat, as the specification says
        }
        result_.mesh = make_mesh(std::move(name), std::move(data_), std::move(parts_));
        return std::move(result_);
    }

private:
    void read_primitive(const JsonValue& json) {
        const std::uint64_t mode = whole_number(json, "mode", 4);
        if (mode > 6) json.need("mode").refuse("a number from 0 to 6");
        if (json.find("targets")) result_.has_morphs = true;
        if (mode < 4) {
            result_.has_lines = true;
            return;
        }
        const std::optional<JsonValue> reference = json.find("material");
        const MaterialId material =
            reference ? static_cast<MaterialId>(document_.index(*reference, "materials"))
                      : kNoMaterial;
        VertexSource& source = source_of(json.need("attributes"), material);
        const auto first = static_cast<std::uint32_t>(data_.triangles.size());
        read_corners(json, source);
        add_triangles(static_cast<Mode>(mode));
        const auto count = static_cast<std::uint32_t>(data_.triangles.size()) - first;
        if (count > 0) parts_.push_back({first, count, material});
    }

    VertexSource& source_of(const JsonValue& attributes, MaterialId material) {
        const int uv_set = material < uv_sets_.size() ? uv_sets_[material] : 0;
        const std::string uv_name = fmt::format("TEXCOORD_{}", uv_set);
        const VertexSource::Key key = VertexSource::key_of(document_, attributes, uv_name);
        has_normals_ |= key[1] != VertexSource::kNoAccessor;
        has_uvs_ |= key[2] != VertexSource::kNoAccessor;
        const auto known = std::find_if(sources_.begin(), sources_.end(),
                                        [&](const VertexSource& s) { return s.key() == key; });
        if (known != sources_.end()) return *known;
        return sources_.emplace_back(document_, attributes, key, uv_name);
    }

    // Vertex numbers of the primitive's corners.
    void read_corners(const JsonValue& json, VertexSource& source) {
        corners_.clear();
        const std::optional<JsonValue> reference = json.find("indices");
        if (!reference) {
            for (std::size_t i = 0; i < source.count(); ++i)
                corners_.push_back(source.take(i, data_));
            return;
        }
        const GltfAccessor indices(document_, document_.index(*reference, "accessors"), "SCALAR");
        if (!indices.holds_indices()) reference->fail("the accessor does not hold indices");
        corners_.reserve(indices.count());
        // Of the first primitive only: making room each time would move all that is there.
        if (data_.positions.empty()) source.reserve(indices.count(), data_);
        for (std::size_t i = 0; i < indices.count(); ++i) {
            const std::uint32_t index = indices.index(i);
            if (index >= source.count()) {
                indices.fail(
                    i, fmt::format("there is no vertex {} (there are {})", index, source.count()));
            }
            corners_.push_back(source.take(index, data_));
        }
    }

    void add_triangles(Mode mode) {
        const std::size_t step = mode == Mode::triangles ? 3 : 1;
        if (data_.triangles.empty()) data_.triangles.reserve(corners_.size() / step);
        for (std::size_t i = 0; i + 2 < corners_.size(); i += step) {
            const std::uint32_t a = corners_[mode == Mode::fan ? 0 : i];
            const std::uint32_t b = corners_[i + 1];
            const std::uint32_t c = corners_[i + 2];
            const bool turned = mode == Mode::strip && i % 2 == 1;
            data_.triangles.push_back(turned ? glm::uvec3(b, a, c) : glm::uvec3(a, b, c));
        }
    }

    GltfDocument& document_;
    const std::vector<int>& uv_sets_;
    std::list<VertexSource> sources_;
    MeshData data_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> corners_;
    bool has_normals_ = false;
    bool has_uvs_ = false;
    GltfMesh result_;
};

}  // namespace

GltfMesh read_gltf_mesh(GltfDocument& document, std::size_t index, std::string name,
                        const std::vector<int>& uv_sets) {
    return MeshReader(document, uv_sets).read(document.array("meshes")[index], std::move(name));
}

}  // namespace raypick
