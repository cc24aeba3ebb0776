// What the words mean: POV-Ray 3.7 documentation, "Scene Description Language".
#include "tests/pov_scene.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <variant>

namespace raypick {

namespace {

[[noreturn]] void no_equivalent(const std::string& what) {
    throw std::invalid_argument("for POV-Ray: " + what);
}

std::string text(const glm::dvec3& v) {
    return fmt::format("<{:.17g}, {:.17g}, {:.17g}>", v.x, v.y, v.z);
}

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

double grey(const glm::vec3& colour, const char* what) {
    if (colour.x != colour.y || colour.y != colour.z) no_equivalent(std::string(what) + " is grey");
    return static_cast<double>(colour.x);
}

// --- Camera, lights, background -----------------------------------------------------------------

// With many rays a pixel, all of them traced. POV-Ray's samples lie on a disk of a quarter of its
// "aperture" (tracepixel.cpp), ours on one of half of the lens's diameter.
std::string lens_text(const Camera& camera, const RenderSettings& settings) {
    if (settings.aperture == 0.0) return "";
    const glm::dvec3 focus = camera.eye - settings.focus_distance * camera_frame(camera).vz;
    return fmt::format(
        " aperture {:.17g} focal_point {} blur_samples 512 variance 0 confidence 0.999",
        2.0 * settings.aperture, text(focus));
}

// Explicit vectors, so that POV-Ray's left-handed default doesn't come in.
std::string camera_text(const Camera& camera, ImageSize size, const RenderSettings& settings) {
    const CameraFrame frame = camera_frame(camera);
    const bool orthographic = camera.projection == Projection::orthographic;
    const double height =
        orthographic ? camera.height : 2.0 * std::tan(glm::radians(camera.fovy) / 2.0);
    const double aspect = static_cast<double>(size.cols) / size.rows;
    return fmt::format("camera {{ {} location {} direction {} right {} up {}{} }}\n",
                       orthographic ? "orthographic" : "perspective", text(camera.eye),
                       text(-frame.vz), text(height * aspect * frame.vx), text(height * frame.vy),
                       lens_text(camera, settings));
}

struct Fade {
    double gain;
    std::string text;
};

// POV-Ray's fall-off is 2 / (1 + (d / fade_distance)^fade_power).
Fade fade_of(const Attenuation& attenuation) {
    const auto [constant, linear, quadratic] = attenuation;
    if (linear == 0.0 && quadratic == 0.0) return {1.0 / constant, ""};
    if (!(constant > 0.0) || (linear != 0.0 && quadratic != 0.0)) {
        no_equivalent("attenuation is constant and one of linear and quadratic");
    }
    const bool by_square = quadratic != 0.0;
    const double distance = by_square ? std::sqrt(constant / quadratic) : constant / linear;
    return {0.5 / constant,
            fmt::format(" fade_distance {:.17g} fade_power {}", distance, by_square ? 2 : 1)};
}

struct LightText {
    int area_samples;

    std::string operator()(const PointLight& light) const {
        return lamp(light.position, light.colour, light.attenuation, "");
    }

    std::string operator()(const DirectionalLight& light) const {
        const glm::dvec3 from = -1e4 * glm::normalize(light.direction);
        return lamp(from, light.colour, {}, " parallel point_at <0, 0, 0>");
    }

    std::string operator()(const SpotLight& light) const {
        if (light.inner_degrees != light.outer_degrees) {
            no_equivalent("a spot light has a sharp edge: the soft ones have other curves");
        }
        const std::string cone =
            fmt::format(" spotlight radius {0:.17g} falloff {0:.17g} tightness 0 point_at {1}",
                        light.outer_degrees, text(light.position + light.direction));
        return lamp(light.position, light.colour, light.attenuation, cone);
    }

    // A disk that turns to what it shines on.
    std::string operator()(const SphereLight& light) const {
        const double across = 2.0 * light.radius * (1.0 - 1.0 / area_samples);
        const std::string disk = fmt::format(
            " area_light {}, {}, {}, {} circular orient area_illumination on",
            text({across, 0.0, 0.0}), text({0.0, 0.0, across}), area_samples, area_samples);
        return lamp(light.centre, light.colour, light.attenuation, disk);
    }

    // POV-Ray's grid goes from edge to edge; shrunk, its points are at the cells' centres.
    std::string operator()(const RectangleLight& light) const {
        const double shrink = 1.0 - 1.0 / area_samples;
        const std::string grid = fmt::format(
            " area_light {}, {}, {}, {} area_illumination on", text(shrink * light.edge_u),
            text(shrink * light.edge_v), area_samples, area_samples);
        return lamp(light.corner + 0.5 * (light.edge_u + light.edge_v), light.colour,
                    light.attenuation, grid);
    }

    static std::string lamp(const glm::dvec3& position, const glm::vec3& colour,
                            const Attenuation& attenuation, const std::string& kind) {
        const Fade fade = fade_of(attenuation);
        return fmt::format("light_source {{ {} rgb {}{}{} }}\n", text(position),
                           text(fade.gain * glm::dvec3(colour)), kind, fade.text);
    }
};

std::string background_text(const Scene& scene) {
    if (std::holds_alternative<std::monostate>(scene.environment)) {
        return fmt::format("background {{ rgb {} }}\n", text(scene.background));
    }
    if (const auto* image = std::get_if<ImageSky>(&scene.environment)) {
        // POV-Ray's images begin at +x and go round by +z.
        if (image->up != glm::dvec3(0, 1, 0) || image->forward != glm::dvec3(-1, 0, 0) ||
            image->scale != 1.0f) {
            no_equivalent("a sky image that is not turned or scaled");
        }
        return "sky_sphere { pigment { image_map { ppm \"sky.ppm\" gamma 1.0 map_type 1 "
               "interpolate 2 } } }\n";
    }
    const auto* sky = std::get_if<GradientSky>(&scene.environment);
    // A gradient repeats itself from 0 to 1; ours goes from -1 to 1.
    return fmt::format(
        "sky_sphere {{ pigment {{ gradient {} color_map {{ [0 rgb {}] [0.5 rgb {}] "
        "[1 rgb {}] }} scale 2 translate {} }} }}\n",
        text(glm::normalize(sky->up)), text(sky->ground), text(sky->horizon), text(sky->zenith),
        text(-glm::normalize(sky->up)));
}

// --- Images -------------------------------------------------------------------------------------

std::string texture_file(TextureId id) {
    return fmt::format("texture{}.ppm", id);
}

// 16 bits a channel, linear. `texel` gives the colour, 0..1, of a row and a column.
template <class Texel>
void write_ppm(const std::filesystem::path& file, int rows, int cols, const Texel& texel) {
    std::ofstream out(file, std::ios::binary);
    out << "P6\n" << cols << ' ' << rows << "\n65535\n";
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            const glm::vec3 colour = texel(row, col);
            for (int channel = 0; channel < 3; ++channel) {
                const auto sample = std::lround(65535.0f * colour[channel]);
                out.put(static_cast<char>(sample / 256)).put(static_cast<char>(sample % 256));
            }
        }
    }
}

void write_images(const std::filesystem::path& folder, const Scene& scene) {
    for (TextureId id = 0; id < scene.textures.size(); ++id) {
        const auto* image = std::get_if<ImageTexture>(&scene.textures[id].source);
        if (image == nullptr) continue;
        const TexturePixels& pixels = *image->pixels;
        const auto texel = [&pixels](int row, int col) {
            const ImageSize size{pixels.levels[0].rows, pixels.levels[0].cols};
            const glm::u8vec4& texel_bytes = pixels.texels[size.index({row, col})];
            const glm::vec3 stored = glm::vec3(glm::u8vec3(texel_bytes)) / 255.0f;
            if (pixels.coding == TexelCoding::linear) return stored;
            return glm::vec3(linear_from_srgb(stored.x), linear_from_srgb(stored.y),
                             linear_from_srgb(stored.z));
        };
        write_ppm(folder / texture_file(id), pixels.levels[0].rows, pixels.levels[0].cols, texel);
    }
    if (const auto* sky = std::get_if<ImageSky>(&scene.environment)) {
        const SkyPixels& pixels = *sky->pixels;
        write_ppm(folder / "sky.ppm", pixels.rows, pixels.cols, [&pixels](int row, int col) {
            return pixels.texels[ImageSize{pixels.rows, pixels.cols}.index({row, col})];
        });
    }
}

// --- Materials ----------------------------------------------------------------------------------

// POV-Ray multiplies one pigment by the strengths of a finish; what a surface gives off and
// diffuses is scaled by 1 - t, t being what it transmits.
class MaterialText {
public:
    MaterialText(const Scene& scene, const Material& material)
        : scene_(scene), material_(material) {
        const glm::dvec3 transmit(material.transmit);
        const glm::dvec3 glow = glm::dvec3(material.emissive) +
                                glm::dvec3(material.ambient) * glm::dvec3(scene.ambient);
        matt_ = glm::dvec3(material.diffuse) != glm::dvec3(0.0) || glow != glm::dvec3(0.0);
        if (material.alpha_mode == AlphaMode::blend && material.opacity < 1.0f) {
            opacity_ = static_cast<double>(material.opacity);
            if (material.transmits()) no_equivalent("glass of opacity 1");
        }
        colour_ = glm::dvec3(material.diffuse);
        if (colour_ == glm::dvec3(0.0)) colour_ = glm::dvec3(1.0);
        if (material.transmits() && !matt_) colour_ = transmit / largest(transmit);
        for (int i = 0; i < 3; ++i) {
            if (glow[i] == 0.0) continue;
            if (colour_[i] == 0.0) no_equivalent("a surface that glows where it is not black");
            emission_[i] = glow[i] / colour_[i];
        }
    }

    [[nodiscard]] std::string pigment() const {
        const TextureMap& map = material_.map(MapSlot::diffuse);
        if (map && std::holds_alternative<Checker>(scene_.textures[map.texture].source)) {
            return checker(map);
        }
        if (map) return image(map);
        return fmt::format("pigment {{ rgbft {} }}", with_transmission(colour_));
    }

    [[nodiscard]] std::string finish() const {
        const bool diffuse = material_.diffuse != glm::vec3(0.0f);
        // What glass transmits takes nothing from what it diffuses in our model.
        const double visible = 1.0 - straight();
        if (!(visible > 0.0)) no_equivalent("matt glass that transmits all");
        const double strength = opacity_ / visible;
        std::string finish = fmt::format("finish {{ ambient 0 diffuse {:.17g} emission rgb {}",
                                         diffuse ? strength : 0.0, text(strength * emission_));
        const double specular = opacity_ * grey(material_.specular, "the highlight");
        if (specular > 0.0) {
            const auto shininess = static_cast<double>(material_.shininess);
            finish +=
                material_.model == LocalModel::phong
                    ? fmt::format(" phong {:.17g} phong_size {:.17g}", specular, shininess)
                    : fmt::format(" specular {:.17g} roughness {:.17g}", specular, 1.0 / shininess);
        }
        return finish + reflection() + " }";
    }

    [[nodiscard]] std::string interior() const {
        if (!material_.transmits() && material_.reflectance != Reflectance::dielectric) return "";
        if (material_.thin_walled) no_equivalent("a thin-walled sheet");
        std::string interior = fmt::format("interior {{ ior {:.17g}", material_.ior);
        const glm::dvec3 absorption(material_.absorption);
        if (const double most = largest(absorption); most > 0.0) {
            // Above a power of 1000 POV-Ray has exp(-(1 - fade_color) depth / fade_distance).
            interior += fmt::format(" fade_power 1001 fade_distance {:.17g} fade_color rgb {}",
                                    1.0 / most, text(1.0 - absorption / most));
        }
        return interior + " }";
    }

private:
    // What goes through unfiltered by the pigment.
    [[nodiscard]] double straight() const {
        if (!material_.transmits()) return 1.0 - opacity_;
        return matt_ ? grey(material_.transmit, "what matt glass transmits") : 0.0;
    }

    [[nodiscard]] std::string with_transmission(const glm::dvec3& colour) const {
        const bool filters = material_.transmits() && !matt_;
        return fmt::format("<{:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}>", colour.x, colour.y,
                           colour.z, filters ? largest(glm::dvec3(material_.transmit)) : 0.0,
                           straight());
    }

    // POV-Ray's checker is one of cubes; made high, it is one of squares on the floor.
    [[nodiscard]] std::string checker(const TextureMap& map) const {
        const auto* squares = std::get_if<Checker>(&scene_.textures[map.texture].source);
        if (map.u_row.y != 0.0f || map.u_row.z != 0.0f || map.v_row.x != 0.0f ||
            map.v_row.z != 0.0f || material_.transmits()) {
            no_equivalent("a checker that is scaled only");
        }
        constexpr double kHigh = 1e6;
        return fmt::format(
            "pigment {{ checker rgb {} rgb {} scale <{:.17g}, {}, {:.17g}> translate {} }}",
            text(colour_ * glm::dvec3(squares->even)), text(colour_ * glm::dvec3(squares->odd)),
            1.0 / static_cast<double>(map.u_row.x), kHigh, 1.0 / static_cast<double>(map.v_row.y),
            text({0.0, -0.5 * kHigh, 0.0}));
    }

    // By the texture coordinates of a mesh.
    [[nodiscard]] std::string image(const TextureMap& map) const {
        TextureMap plain;
        plain.texture = map.texture;
        plain.filter = TextureFilter::nearest;
        if (!(map == plain) || colour_ != glm::dvec3(1.0)) {
            no_equivalent("an image as it is, with texels that don't blend, on white");
        }
        return fmt::format("pigment {{ uv_mapping image_map {{ ppm \"{}\" gamma 1.0 }} }}",
                           texture_file(map.texture));
    }

    [[nodiscard]] std::string reflection() const {
        if (!material_.reflects()) return "";
        const glm::dvec3 reflect = opacity_ * glm::dvec3(material_.reflect);
        switch (material_.reflectance) {
            case Reflectance::constant:
                return fmt::format(" reflection {{ rgb {} }}", text(reflect));
            case Reflectance::dielectric:
                // Without the last word what is reflected would be transmitted, too.
                return fmt::format(" reflection {{ rgb 0, rgb {} fresnel on }} conserve_energy",
                                   text(reflect));
            case Reflectance::conductor:
                return fmt::format(" reflection {{ rgb {}, rgb {} falloff 5 }}", text(reflect),
                                   text(glm::dvec3(opacity_)));
        }
        return "";
    }

    const Scene& scene_;
    const Material& material_;
    glm::dvec3 colour_{1.0};
    glm::dvec3 emission_{0.0};
    double opacity_ = 1.0;
    bool matt_ = false;  // diffuses or glows
};

// --- Shapes -------------------------------------------------------------------------------------

std::string sphere_text(const Sphere& sphere) {
    return fmt::format("sphere {{ {}, {:.17g}", text(sphere.centre), sphere.radius);
}

std::string cone_text(const Cone& cone) {
    return fmt::format("cone {{ {}, {:.17g}, {}, {:.17g}{}", text(cone.base), cone.base_radius,
                       text(cone.apex), cone.apex_radius, cone.capped ? "" : " open");
}

std::string triangle_text(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return fmt::format("triangle {{ {}, {}, {} }} ", text(a), text(b), text(c));
}

template <class Vertices>
std::string vector_list(const char* name, const Vertices& vertices) {
    std::string list = fmt::format("{} {{ {}", name, vertices.size());
    for (const auto& v : vertices)
        list += ", " + text(v);
    return list + " } ";
}

std::string mesh_text(const Mesh& mesh) {
    std::string result = "mesh2 { " + vector_list("vertex_vectors", mesh.positions);
    if (!mesh.normals.empty()) result += vector_list("normal_vectors", mesh.normals);
    if (!mesh.uvs.empty()) {
        std::string uvs;
        for (const glm::vec2& uv : mesh.uvs)
            uvs += fmt::format(", <{}, {}>", uv.x, uv.y);
        result += fmt::format("uv_vectors {{ {}{} }} ", mesh.uvs.size(), uvs);
    }
    result += fmt::format("face_indices {{ {}", mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles)
        result += fmt::format(", <{}, {}, {}>", t.x, t.y, t.z);
    return result + " }";
}

// The object without its last brace.
struct ShapeText {
    const Scene& scene;

    std::string operator()(const Sphere& sphere) const { return sphere_text(sphere); }
    std::string operator()(const Plane& plane) const {
        const double length = glm::length(plane.normal);
        return fmt::format("plane {{ {}, {:.17g}", text(plane.normal / length), -plane.d / length);
    }
    std::string operator()(const Triangle& t) const {
        return "mesh { " + triangle_text(t.a, t.b, t.c);
    }
    std::string operator()(const Box& box) const {
        return fmt::format("box {{ {}, {}", text(box.min), text(box.max));
    }
    std::string operator()(const Disk& disk) const {
        return fmt::format("disc {{ {}, {}, {:.17g}, {:.17g}", text(disk.centre), text(disk.normal),
                           disk.radius, disk.inner_radius);
    }
    std::string operator()(const Rectangle& r) const {
        const glm::dvec3 opposite = r.corner + r.edge_u + r.edge_v;
        return "mesh { " + triangle_text(r.corner, r.corner + r.edge_u, opposite) +
               triangle_text(r.corner, opposite, r.corner + r.edge_v);
    }
    std::string operator()(const Cone& cone) const { return cone_text(cone); }
    std::string operator()(const Torus& torus) const {
        const glm::dvec3 axis = glm::normalize(torus.axis);
        const glm::dvec3 aside = std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 x = glm::normalize(glm::cross(aside, axis));
        return fmt::format("torus {{ {:.17g}, {:.17g} sturm ", torus.major_radius,
                           torus.minor_radius) +
               matrix({{x, axis, glm::cross(x, axis)}, torus.centre});
    }
    std::string operator()(const MeshInstance& instance) const {
        return mesh_text(scene.meshes[instance.mesh]);
    }
    std::string operator()(const SphereSetInstance& instance) const {
        const SphereSet& set = scene.sphere_sets[instance.set];
        std::string all = "union { ";
        for (std::uint32_t i = 0; i < set.spheres.size(); ++i)
            all += sphere_text(sphere_of(set, i)) + " } ";
        return all;
    }
    std::string operator()(const ConeSetInstance& instance) const {
        const ConeSet& set = scene.cone_sets[instance.set];
        std::string all = "union { ";
        for (std::uint32_t i = 0; i < set.size(); ++i)
            all += cone_text(cone_of(set, i)) + " } ";
        return all;
    }

    // POV-Ray's rows are what becomes of the axes and of the origin.
    static std::string matrix(const Transform& transform) {
        std::string rows;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3& axis = transform.linear[i];
            rows += fmt::format("{:.17g}, {:.17g}, {:.17g}, ", axis.x, axis.y, axis.z);
        }
        const glm::dvec3& origin = transform.translation;
        return fmt::format(" matrix <{}{:.17g}, {:.17g}, {:.17g}>", rows, origin.x, origin.y,
                           origin.z);
    }
};

// An object of one material.
std::string object_text(const Scene& scene, const Object& object, bool shadows) {
    if (object.sides != Sides::both) no_equivalent("an object that is seen from both sides");
    if (object.material == kNoMaterial && parts_of(scene, object.shape).size() != 1) {
        no_equivalent("an object of one material");
    }
    const MaterialText look(scene, material(scene, material_id(scene, object, 0)));
    std::string result = std::visit(ShapeText{scene}, object.shape);
    if (!object.world_from_object.is_identity())
        result += ShapeText::matrix(object.world_from_object);
    return fmt::format("{} {} {} {}{} }}\n", result, look.pigment(), look.finish(), look.interior(),
                       shadows ? "" : " no_shadow");
}

}  // namespace

void write_pov_scene(const std::filesystem::path& folder, const Scene& scene, const Camera& camera,
                     ImageSize size, const RenderSettings& settings, int area_samples) {
    std::ofstream file(folder / "scene.pov");
    file << fmt::format(
        "#version 3.7;\n"
        "global_settings {{ assumed_gamma 1 max_trace_level {} adc_bailout 0 }}\n",
        settings.depth);
    file << camera_text(camera, size, settings) << background_text(scene);
    for (const Light& light : scene.lights)
        file << std::visit(LightText{area_samples}, light);
    for (const Object& object : scene.objects)
        file << object_text(scene, object, settings.shadows);
    write_images(folder, scene);
}

Image read_pov_picture(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string line;
    std::getline(in, line);
    if (line != "P6") return {};
    while (std::getline(in, line) && !line.empty() && line[0] == '#') {
    }
    Image image;
    std::istringstream(line) >> image.size.cols >> image.size.rows;
    std::getline(in, line);
    if (line != "65535") return {};
    image = make_image(image.size);
    const auto sample = [&in] {
        const int high = in.get();
        return static_cast<float>(high * 256 + in.get()) / 65535.0f;
    };
    for (glm::vec3& pixel : image.colour) {
        pixel.x = sample();
        pixel.y = sample();
        pixel.z = sample();
    }
    return in ? image : Image{};
}

}  // namespace raypick
