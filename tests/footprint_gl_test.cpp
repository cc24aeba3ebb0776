// The footprint of a pixel's cone on a surface, in GLSL and in C++.
#include "tests/gl_fixture.h"
#include "tests/random.h"
#include "tracer/accel/surface.h"
#include "viewer/gl/load_gl.h"
#include "viewer/gl/program.h"
#include "viewer/gl/shader_source.h"
#include "viewer/gl/textures.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace raypick {
namespace {

// Where a ray meets a surface.
struct Meeting {
    SurfacePoint point;
    glm::vec3 direction{0.0f};
    float width = 1.0f;
};

// Runs the GLSL function for one pixel that gives the two axes.
class FootprintTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (!context_) return;
        const std::filesystem::path folder =
            std::filesystem::path(::testing::TempDir()) /
            ("raypick_footprint" + std::to_string(::getpid()));  // other tests run at the same time
        std::filesystem::create_directories(folder);
        for (const EmbeddedShader& shader : embedded_shaders())
            std::ofstream(folder / shader.name) << shader.text;
        std::ofstream(folder / "footprint.frag")
            << "#include \"texture.glsl\"\n"
               "uniform vec3 normal, dpdu, dpdv, direction;\n"
               "uniform float width;\n"
               "out vec4 axes;\n"
               "void main() {\n"
               "    Footprint f = footprint(normal, dpdu, dpdv, direction, width);\n"
               "    axes = vec4(f.major, f.minor);\n"
               "}\n";
        ASSERT_EQ(setenv("RAYPICK_SHADER_DIR", folder.c_str(), 1), 0);
        program_ = make_program("fullscreen.vert", "footprint.frag");
        ASSERT_EQ(unsetenv("RAYPICK_SHADER_DIR"), 0);
        std::filesystem::remove_all(folder);
        target_ = make_texture(kRgba32f, {1, 1});
        const GLuint names[] = {target_.name()};
        framebuffer_ = make_framebuffer(names);
        vertices_ = new_vertex_array();
        glBindVertexArray(vertices_.name());
        glViewport(0, 0, 1, 1);
    }

    void TearDown() override {
        vertices_ = {};
        framebuffer_ = {};
        target_ = {};
        program_ = {};
    }

    [[nodiscard]] Footprint in_glsl(const Meeting& meeting) const {
        const Uniforms uniforms(program_);
        uniforms.set("normal", meeting.point.geometric_normal);
        uniforms.set("dpdu", meeting.point.dpdu);
        uniforms.set("dpdv", meeting.point.dpdv);
        uniforms.set("direction", meeting.direction);
        uniforms.set("width", meeting.width);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glm::vec4 axes(0.0f);
        glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, &axes);
        check_gl("computing a footprint");
        return {{axes.x, axes.y}, {axes.z, axes.w}};
    }

    void expect_same(const Meeting& meeting) const {
        const Footprint cpp = footprint(meeting.point, meeting.direction, meeting.width);
        const Footprint glsl = in_glsl(meeting);
        const float size = std::max(glm::length(cpp.major), glm::length(cpp.minor));
        EXPECT_LE(glm::length(cpp.major - glsl.major), 1e-3f * size);
        EXPECT_LE(glm::length(cpp.minor - glsl.minor), 1e-3f * size);
    }

    Program program_;
    GlTexture target_;
    Framebuffer framebuffer_;
    VertexArray vertices_;
};

// A surface of any size whose uv runs askew, up to some 60 degrees from square.
Meeting random_meeting(Random& random) {
    const glm::dvec3 u = random.direction();
    const glm::dvec3 normal = glm::normalize(glm::cross(u, random.direction()));
    const glm::dvec3 v = glm::cross(normal, u) + random.between(-1.5, 1.5) * u;
    const double size = std::exp2(random.between(-12.0, 12.0));
    Meeting meeting;
    meeting.point.geometric_normal = glm::vec3(normal);
    meeting.point.dpdu = glm::vec3(size * random.between(0.2, 3.0) * u);
    meeting.point.dpdv = glm::vec3(size * random.between(0.2, 3.0) * v);
    meeting.direction = glm::vec3(random.direction());
    meeting.width = static_cast<float>(size * std::exp2(random.between(-10.0, 2.0)));
    return meeting;
}

TEST_F(FootprintTest, IsTheSameInCppAndGlsl) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        expect_same(random_meeting(random));
    }
}

TEST_F(FootprintTest, IsTheSameSeenStraightOnAndGrazing) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        Meeting meeting = random_meeting(random);
        meeting.direction = -meeting.point.geometric_normal;
        expect_same(meeting);
        // Less than the least cosine that counts.
        meeting.direction = glm::normalize(glm::normalize(meeting.point.dpdu) +
                                           static_cast<float>(random.between(-0.01, 0.01)) *
                                               meeting.point.geometric_normal);
        expect_same(meeting);
    }
}

TEST_F(FootprintTest, IsAPointWhereThereIsNoPlane) {
    Random random(1);
    Meeting meeting = random_meeting(random);
    meeting.point.dpdv = glm::vec3(0.0f);
    for (const Footprint& none :
         {in_glsl(meeting), footprint(meeting.point, meeting.direction, meeting.width)}) {
        EXPECT_EQ(none.major, glm::vec2(0.0f));
        EXPECT_EQ(none.minor, glm::vec2(0.0f));
    }
}

}  // namespace
}  // namespace raypick
