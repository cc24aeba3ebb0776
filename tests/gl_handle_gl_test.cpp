// Owners of OpenGL names, contexts, shaders, row order.
#include "viewer/gl/gl_handle.h"

#include "tests/gl_fixture.h"
#include "tracer/error.h"
#include "viewer/gl/gl_row.h"
#include "viewer/gl/load_gl.h"
#include "viewer/gl/program.h"
#include "viewer/gl/shader_source.h"
#include "viewer/gl/textures.h"
#include "viewer/raster/mesh_chunks.h"
#include "viewer/raster/shader_set.h"

#include <gmock/gmock.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace raypick {
namespace {

// Writes down what is destroyed.
struct Recorder {
    static std::vector<GLuint>& destroyed() {
        static std::vector<GLuint> names;
        return names;
    }
    static void destroy(GLuint name) { destroyed().push_back(name); }
};
using Handle = GlHandle<Recorder>;

static_assert(!std::is_copy_constructible_v<Handle> && !std::is_copy_assignable_v<Handle>);
static_assert(std::is_nothrow_move_constructible_v<Handle>);
static_assert(std::is_nothrow_move_assignable_v<Handle>);

class GlHandleTest : public ::testing::Test {
protected:
    void SetUp() override { Recorder::destroyed().clear(); }
};

TEST_F(GlHandleTest, DestroysItsNameOnce) {
    { const Handle handle(7); }
    EXPECT_THAT(Recorder::destroyed(), ::testing::ElementsAre(7u));
}

TEST_F(GlHandleTest, ZeroOwnsNothing) {
    {
        const Handle nothing;
        const Handle zero(0);
        EXPECT_FALSE(nothing);
        EXPECT_FALSE(zero);
    }
    EXPECT_TRUE(Recorder::destroyed().empty());
}

TEST_F(GlHandleTest, MovingHandsTheNameOver) {
    {
        Handle first(7);
        const Handle second(std::move(first));
        EXPECT_EQ(second.name(), 7u);
        EXPECT_FALSE(first);  // NOLINT(bugprone-use-after-move): that is what is tested
    }
    EXPECT_THAT(Recorder::destroyed(), ::testing::ElementsAre(7u));
}

TEST_F(GlHandleTest, AssigningLosesNeitherName) {
    {
        Handle first(7);
        Handle second(8);
        first = std::move(second);
        EXPECT_EQ(first.name(), 8u);
    }
    EXPECT_THAT(Recorder::destroyed(), ::testing::UnorderedElementsAre(7u, 8u));
}

TEST_F(GlHandleTest, MovingOntoItselfKeepsTheName) {
    {
        Handle handle(7);
        Handle& alias = handle;
        handle = std::move(alias);
        EXPECT_EQ(handle.name(), 7u);
        EXPECT_TRUE(Recorder::destroyed().empty());
    }
    EXPECT_THAT(Recorder::destroyed(), ::testing::ElementsAre(7u));
}

TEST(GlRow, TurnsRowsOverAndBack) {
    const ImageSize size{211, 317};
    EXPECT_EQ(gl_row(size, 0), 210);
    EXPECT_EQ(gl_row(size, 210), 0);
    for (int row = 0; row < size.rows; ++row)
        EXPECT_EQ(gl_row(size, gl_row(size, row)), row);
}

TEST(MeshChunks, AMeshThatFitsIsUsedAsItIs) {
    const std::vector<glm::uvec3> triangles{{0, 1, 2}, {2, 1, 3}};
    const auto chunks = split_mesh(triangles, 4, 4);
    ASSERT_EQ(chunks.size(), 1u);
    EXPECT_EQ(chunks[0].first, 0u);
    EXPECT_EQ(chunks[0].count, 2u);
    EXPECT_TRUE(chunks[0].triangles.empty());
    EXPECT_TRUE(split_mesh({}, 4, 4).empty());
}

TEST(MeshChunks, PartsKeepOrderAndCorners) {
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t i = 0; i < 50; ++i)
        triangles.emplace_back(i, (7 * i + 1) % 52, i + 2);
    const std::size_t limit = 8;
    std::uint32_t next = 0;
    for (const MeshChunk& chunk : split_mesh(triangles, 52, limit)) {
        EXPECT_EQ(chunk.first, next);
        ASSERT_EQ(chunk.triangles.size(), chunk.count);
        EXPECT_LE(chunk.triangles.size(), limit);
        EXPECT_LE(chunk.vertices.size(), limit);
        for (const glm::uvec3& local : chunk.triangles) {
            for (int i = 0; i < 3; ++i) {
                EXPECT_EQ(chunk.vertices.at(local[i]), triangles[next][i]);
            }
            ++next;
        }
    }
    EXPECT_EQ(next, triangles.size());
}

using OffscreenContextTest = GlTest;

TEST_F(OffscreenContextTest, SaysWhatItIs) {
    EXPECT_NE(context_->description().find("OpenGL"), std::string::npos);
    GLint major = 0;
    GLint minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    EXPECT_GE(10 * major + minor, 33);
    RecordProperty("gl", context_->description());
    RecordProperty("buffer_texels", std::to_string(max_buffer_texels()));
}

TEST_F(OffscreenContextTest, ASecondContextWorksAfterTheFirst) {
    context_.reset();
    const OffscreenContext second;
    const GlTexture texture = make_texture(kRgba32f, {2, 3});
    EXPECT_TRUE(texture);
    EXPECT_NO_THROW(check_gl("making a texture"));
}

TEST(OffscreenContextChoice, AnUnknownBackendIsNamed) {
    ASSERT_EQ(setenv("RAYPICK_GL", "teapot", 1), 0);
    try {
        const OffscreenContext context;
        ADD_FAILURE() << "opened " << context.description();
    } catch (const NoOpenGL& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("teapot"));
    }
    ASSERT_EQ(unsetenv("RAYPICK_GL"), 0);
}

// In a process of its own, as every test here (one back-end a process).
// Each program that a scene may ask for.
void expect_all_shaders_compile() {
    ShaderSet shaders;
    const SurfaceLook looks[] = {{false, false, false},
                                 {true, false, false},
                                 {true, true, false},
                                 {true, false, true},
                                 {true, true, true}};
    for (std::size_t kind = 0; kind < kShapeKinds; ++kind) {
        for (const SurfaceLook& look : looks) {
            EXPECT_NO_THROW(shaders.shape(Pass::depth, kind, look)) << kind;
            EXPECT_NO_THROW(shaders.shape(Pass::surface, kind, look)) << kind;
        }
    }
    for (const bool textured : {false, true}) {
        for (const bool image_sky : {false, true}) {
            for (const bool shaped_lights : {false, true})
                EXPECT_NO_THROW(shaders.shade({textured, image_sky, shaped_lights}));
        }
    }
}

TEST(OffscreenContextChoice, EglOpensToo) {
    std::unique_ptr<OffscreenContext> context;
    std::string reason;
    try {
        context = std::make_unique<OffscreenContext>(OffscreenBackend::egl);
    } catch (const NoOpenGL& error) {
        reason = error.what();
    }
    RAYPICK_REQUIRE(context != nullptr, reason);
    expect_all_shaders_compile();
    EXPECT_NO_THROW(check_gl("compiling the shaders"));
}

using ProgramTest = GlTest;

TEST_F(ProgramTest, AllShadersCompile) {
    expect_all_shaders_compile();
    EXPECT_NO_THROW(make_program("fullscreen.vert", "present.frag"));
    EXPECT_NO_THROW(check_gl("compiling the shaders"));
}

TEST_F(ProgramTest, DestroyedNamesAreGone) {
    GLuint name = 0;
    {
        const GlTexture texture = make_texture(kRgba32f, {2, 3});
        name = texture.name();
        EXPECT_EQ(glIsTexture(name), GL_TRUE);
    }
    EXPECT_EQ(glIsTexture(name), GL_FALSE);
}

TEST_F(ProgramTest, ErrorsNameTheFileAndTheLine) {
    const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) /
                                         ("raypick_shaders" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "fullscreen.vert") << "void main() { gl_Position = vec4(0.0); }\n";
    std::ofstream(folder / "bad.frag") << "// fine\n#include \"worse.glsl\"\nvoid main() {}\n";
    std::ofstream(folder / "worse.glsl") << "\n\nfloat f() { return missing; }\n";
    ASSERT_EQ(setenv("RAYPICK_SHADER_DIR", folder.c_str(), 1), 0);
    try {
        make_program("fullscreen.vert", "bad.frag");
        ADD_FAILURE() << "compiled";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("bad.frag does not compile"));
        EXPECT_THAT(error.what(), ::testing::HasSubstr("worse.glsl:3"));
    }
    EXPECT_THROW(make_program("fullscreen.vert", "absent.frag"), Error);
    ASSERT_EQ(unsetenv("RAYPICK_SHADER_DIR"), 0);
    std::filesystem::remove_all(folder);
}

TEST(ShaderSources, IncludesStandOnceAndLinesCount) {
    const std::string defines[] = {"SHAPE_BOX"};
    const ShaderSource source = shader_source("surface.frag", defines);
    EXPECT_EQ(source.text.rfind("#version 330 core\n#define SHAPE_BOX\n", 0), 0u);
    EXPECT_EQ(source.files.front(), "surface.frag");
    EXPECT_EQ(std::count(source.files.begin(), source.files.end(), "view.glsl"), 1);
    EXPECT_EQ(source.text.find("#include"), std::string::npos);
    EXPECT_THROW(shader_source("teapot.frag"), Error);
}

TEST_F(ProgramTest, TooManyTexelsAreAnError) {
    const std::size_t count = max_buffer_texels() + 1;
    if (count > (std::size_t{1} << 28)) GTEST_SKIP() << "this OpenGL holds very many";
    const std::vector<std::byte> bytes(count);
    EXPECT_THROW(BufferTexture(GL_R8UI, 1, bytes, "bytes"), Error);
}

}  // namespace
}  // namespace raypick
