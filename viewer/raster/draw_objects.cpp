#include "viewer/raster/draw_objects.h"

#include <glm/matrix.hpp>

namespace raypick {

namespace {

static_assert(std::variant_size_v<DrawnShape> == kShapeKinds);

// Draws one object with the program in `uniforms`, which is current.
struct ShapeDraw {
    const ViewNumbers& view;
    const DrawnObject& object;
    std::span<const IndexRun> runs;
    const Uniforms& uniforms;

    void operator()(const std::shared_ptr<const GpuMesh>& mesh) const {
        set_mesh_numbers();
        for (std::size_t i = 0; i < mesh->chunks().size(); ++i) {
            if (!runs.empty() && runs[i].count == 0) continue;
            const GpuMesh::Chunk& chunk = mesh->chunks()[i];
            uniforms.set("first_primitive", static_cast<int>(chunk.first));
            uniforms.set("has_normals", static_cast<int>(chunk.has_normals));
            uniforms.set("has_uvs", static_cast<int>(chunk.has_uvs));
            bind(Unit::triangles, GL_TEXTURE_BUFFER, chunk.triangles.texture());
            bind(Unit::positions, GL_TEXTURE_BUFFER, chunk.positions.texture());
            bind(Unit::normals, GL_TEXTURE_BUFFER, chunk.normals.texture());
            bind(Unit::uvs, GL_TEXTURE_BUFFER, chunk.uvs.texture());
            if (runs.empty()) {
                glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * chunk.count));
            } else {
                draw_run(runs[i]);
            }
        }
    }

    void operator()(const Sphere& sphere) const {
        const SphereNumbers numbers = sphere_numbers(view, sphere, object.object_from_scene);
        set_space(numbers.object_from_scene);
        uniforms.set("sphere_eye", numbers.eye);
        uniforms.set("sphere_eye_power", numbers.eye_power);
        draw_proxy();
    }

    void operator()(const Box& box) const {
        const BoxNumbers numbers = box_numbers(view, box, object.object_from_scene);
        set_space(numbers.object_from_scene);
        uniforms.set("box_min", numbers.min);
        uniforms.set("box_max", numbers.max);
        draw_proxy();
    }

    void operator()(const Plane& plane) const {
        const PlaneNumbers numbers =
            plane_numbers(view, plane, object.scene_from_object, object.object_from_scene);
        uniforms.set("plane_normal", numbers.normal);
        uniforms.set("plane_height", numbers.height);
        if (object.look.textured) {
            uniforms.set("plane_uv", numbers.uv);
            uniforms.set("plane_u", numbers.u);
            uniforms.set("plane_v", numbers.v);
            uniforms.set("plane_dpdu", numbers.dpdu);
            uniforms.set("plane_dpdv", numbers.dpdv);
        }
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

    void operator()(const UnitDisk& disk) const {
        enter_unit_space();
        uniforms.set("disk_inner_radius", disk.inner_radius);
        draw_proxy();
    }

    void operator()(const UnitSquare&) const {
        enter_unit_space();
        draw_proxy();
    }

    void operator()(const UnitCone& cone) const {
        enter_unit_space();
        uniforms.set("cone_length", cone.length);
        uniforms.set("cone_base_radius", cone.base_radius);
        uniforms.set("cone_apex_radius", cone.apex_radius);
        uniforms.set("cone_capped", static_cast<int>(cone.capped));
        draw_proxy();
    }

    void operator()(const UnitTorus& torus) const {
        enter_unit_space();
        uniforms.set("torus_minor_radius", torus.minor_radius);
        draw_proxy();
    }

    void operator()(const std::shared_ptr<const GpuSphereSet>& set) const { draw_set(set->chunks); }

    void operator()(const std::shared_ptr<const GpuConeSet>& set) const {
        uniforms.set("cone_capped", static_cast<int>(set->set.capped));
        draw_set(set->chunks);
    }

private:
    static void draw_run(const IndexRun& run) {
        // An offset into the buffer, which OpenGL takes as a pointer.
        const auto* offset =
            reinterpret_cast<const void*>(run.first * sizeof(std::uint32_t));  // NOLINT
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(run.count), GL_UNSIGNED_INT, offset);
    }

    void enter_unit_space() const {
        set_space(object.object_from_scene.linear);
        uniforms.set("unit_eye", glm::vec3(object.object_from_scene.point(view.eye)));
    }

    // The space that the shape's shader works in.
    void set_space(const glm::dmat3& object_from_scene) const {
        uniforms.set("object_from_scene", glm::mat3(object_from_scene));
        if (!object.look.textured) return;
        uniforms.set("scene_from_object", glm::mat3(glm::inverse(object_from_scene)));
    }

    void set_mesh_numbers() const {
        const MeshNumbers numbers =
            mesh_numbers(view, object.scene_from_object, object.object_from_scene);
        set_space(numbers.object_from_scene);
        uniforms.set("clip_from_object", numbers.clip_from_object);
        uniforms.set("eye_high", numbers.eye_high);
        uniforms.set("eye_low", numbers.eye_low);
    }

    // Six vertices an element: see shaders/billboard.glsl.
    void draw_set(const std::vector<SetChunk>& chunks) const {
        set_mesh_numbers();
        for (const SetChunk& chunk : chunks) {
            uniforms.set("first_primitive", static_cast<int>(chunk.first));
            uniforms.set("has_materials", static_cast<int>(chunk.has_materials));
            bind(Unit::positions, GL_TEXTURE_BUFFER, chunk.elements.texture());
            bind(Unit::triangles, GL_TEXTURE_BUFFER, chunk.materials.texture());
            glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * chunk.count));
        }
    }

    // Back faces only: one fragment a pixel, also with the eye inside.
    void draw_proxy() const {
        const ProxyNumbers proxy = proxy_numbers(view, object.bounds);
        uniforms.set("clip_from_scene", glm::mat3(view.clip_from_scene));
        uniforms.set("proxy_min", proxy.min);
        uniforms.set("proxy_max", proxy.max);
        glEnable(GL_CULL_FACE);
        glDrawArrays(GL_TRIANGLES, 0, 36);
        glDisable(GL_CULL_FACE);
    }
};

}  // namespace

void bind(Unit unit, GLenum target, GLuint texture) {
    bind_texture(static_cast<GLuint>(unit), target, texture);
}

void draw_objects(ShaderSet& shaders, Pass pass, const ViewNumbers& view,
                  std::span<const SeenObject> objects, int material_count) {
    for (const SeenObject& seen : objects) {
        const DrawnObject* const object = seen.object;
        const Uniforms uniforms(shaders.shape(pass, object->shape.index(), object->look));
        uniforms.set("object_id", object->id);
        uniforms.set("object_material", object->material);
        uniforms.set("sides", static_cast<int>(object->sides));
        uniforms.set("material_count", material_count);
        std::visit(ShapeDraw{view, *object, seen.runs, uniforms}, object->shape);
    }
}

}  // namespace raypick
