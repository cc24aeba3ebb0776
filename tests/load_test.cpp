// load_scene: which reader a file goes to, and what is said of files that go nowhere.
#include "tracer/io/formats.h"

#include "model_files.h"

#include <gmock/gmock.h>

#include <sys/stat.h>

namespace raypick {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Load : public ModelFiles {
protected:
    static std::string complaint_of(const std::filesystem::path& file) {
        try {
            load_scene(file);
            return "";
        } catch (const FileError& error) {
            EXPECT_EQ(error.file(), file.string());
            return std::string(error.what()).substr(error.file().size() + 2);
        }
    }
};

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST_F(Load, ContentDecidesBeforeTheName) {
    EXPECT_EQ(placed_triangles(load("really.obj", kPly).scene), 1u);
    EXPECT_EQ(placed_triangles(load("no ending", kPly).scene), 1u);
    EXPECT_EQ(placed_triangles(load("wrong.txt", "# a comment\n\n" + kObj).scene), 1u);
    EXPECT_EQ(placed_triangles(load("UPPER.OBJ", kObj).scene), 1u);
}

TEST_F(Load, OtherFilesAreRefusedWithTheEndingsThatAreRead) {
    EXPECT_EQ(complaint("notes.txt", "Dear diary"),
              "has no format that we read (.json, .obj, .gltf, .glb, .ply, .stl, .nff)");
    EXPECT_THAT(readable_extensions(),
                ElementsAre(".json", ".obj", ".gltf", ".glb", ".ply", ".stl", ".nff"));
}

TEST_F(Load, FilesThatCannotBeRead) {
    EXPECT_EQ(complaint_of(folder_ / "gone.obj"), "no such file");
    EXPECT_EQ(complaint_of(folder_ / "gone" / "gone.obj"), "no such file");
    EXPECT_EQ(complaint_of(folder_), "is a folder");
    EXPECT_EQ(complaint("empty.obj", ""), "is empty");
    EXPECT_EQ(complaint_of(write("a.obj", kObj) / "below"), "no such file");
    ASSERT_EQ(mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
    EXPECT_EQ(complaint_of(folder_ / "pipe.obj"), "is not a regular file");
    const std::filesystem::path secret = write("secret.obj", kObj);
    std::filesystem::permissions(secret, std::filesystem::perms::none);
    // Root may read everything.
    if (getuid() != 0) {
        EXPECT_THAT(complaint_of(secret), HasSubstr("Permission denied"));
    }
}

TEST_F(Load, TheSceneIsCheckedAndItsOriginChosen) {
    const LoadedScene loaded = load("far.obj",
                                    "v 5000000 5000000 0\nv 5000001 5000000 0\n"
                                    "v 5000000 5000001 0\nf 1 2 3\n");
    EXPECT_NE(loaded.scene.origin, glm::dvec3(0.0));
    EXPECT_EQ(corner(loaded.scene, 0, 0, 1), glm::dvec3(5000001, 5000000, 0));
    const LoadedScene raw = load_model(folder_ / "far.obj", {});
    EXPECT_EQ(raw.scene.origin, glm::dvec3(0.0));
    EXPECT_EQ(corner(raw.scene, 0, 0, 1), glm::dvec3(5000001, 5000000, 0));
}

TEST_F(Load, ASceneFileIsNoModel) {
    const std::filesystem::path file = write("a.json", "{\"version\": 1}");
    EXPECT_THROW(load_model(file, {}), FileError);
}

TEST_F(Load, ProgressEndsAtOne) {
    std::atomic<float> progress = 0.0f;
    LoadOptions options;
    options.progress = &progress;
    load("a.ply", kPly, options);
    EXPECT_EQ(progress.load(), 1.0f);
}

}  // namespace
}  // namespace raypick
