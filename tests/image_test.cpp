#include "tracer/render/image.h"

#include "tests/random.h"
#include "tracer/error.h"
#include "tracer/render/image_files.h"
#include "tracer/render/srgb_bytes.h"
#include "tracer/scene/scene.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb_image.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

namespace raypick {
namespace {

namespace fs = std::filesystem;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// An empty folder that goes when the test ends.
class ImageFiles : public testing::Test {
protected:
    void SetUp() override {
        const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ =
            fs::temp_directory_path() / ("raypick_image_" + test + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path file(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : fs::directory_iterator(folder_)) {
            found.push_back(entry.path().filename());
        }
        return found;
    }

private:
    fs::path folder_;
};

Image random_image(ImageSize size) {
    Random random(4);
    Image image = make_image(size);
    for (std::size_t i = 0; i < size.pixel_count(); ++i) {
        image.colour[i] = glm::vec3(random.point(glm::dvec3(-0.1), glm::dvec3(1.3)));
        if (i % 5 == 0) continue;  // background
        image.depth[i] = static_cast<float>(random.between(0.1, 1e4));
        image.normal[i] = glm::vec3(random.direction());
        image.object[i] = random.below(1u << 31);
        image.primitive[i] = static_cast<std::uint32_t>(i) * 16777259u;  // needs all 32 bits
    }
    return image;
}

TEST(Image, StartsAsBackground) {
    const Image image = make_image({2, 3});
    EXPECT_EQ(image.size, (ImageSize{2, 3}));
    ASSERT_EQ(image.colour.size(), 6u);
    ASSERT_EQ(image.depth.size(), 6u);
    ASSERT_EQ(image.normal.size(), 6u);
    ASSERT_EQ(image.object.size(), 6u);
    ASSERT_EQ(image.primitive.size(), 6u);
    EXPECT_EQ(image.colour[5], glm::vec3(0.0f));
    EXPECT_EQ(image.depth[5], kInfinity);
    EXPECT_EQ(image.normal[5], glm::vec3(0.0f));
    EXPECT_EQ(image.object[5], kNoObject);
    EXPECT_EQ(image.primitive[5], 0xffffffffu);
}

// IEC 61966-2-1: linear below 0.0031308, then 1.055 x^(1/2.4) - 0.055.
TEST(Srgb, CurveFromTheStandard) {
    EXPECT_FLOAT_EQ(srgb_from_linear(0.0f), 0.0f);
    EXPECT_FLOAT_EQ(srgb_from_linear(1.0f), 1.0f);
    EXPECT_NEAR(srgb_from_linear(0.0031308f), 0.04045f, 1e-6f);
    EXPECT_NEAR(srgb_from_linear(0.001f), 0.01292f, 1e-7f);
    EXPECT_NEAR(srgb_from_linear(0.0031309f), 0.0404499f, 1e-5f);
    EXPECT_NEAR(srgb_from_linear(0.5f), 0.7353569f, 1e-6f);
    EXPECT_NEAR(srgb_from_linear(0.2140411f), 0.5f, 1e-6f);
    EXPECT_NEAR(linear_from_srgb(0.5f), 0.2140411f, 1e-6f);
    EXPECT_NEAR(linear_from_srgb(0.04045f), 0.0031308f, 1e-7f);
    for (int i = 0; i <= 1000; ++i) {
        const float x = static_cast<float>(i) / 1000.0f;
        EXPECT_NEAR(linear_from_srgb(srgb_from_linear(x)), x, 1e-6f);
    }
}

TEST(Srgb, Bytes) {
    EXPECT_EQ(srgb_byte(0.0f), 0);
    EXPECT_EQ(srgb_byte(1.0f), 255);
    EXPECT_EQ(srgb_byte(0.5f), 188);
    EXPECT_EQ(srgb_byte(0.18f), 118);
    EXPECT_EQ(srgb_byte(-1.0f), 0);
    EXPECT_EQ(srgb_byte(17.0f), 255);
    EXPECT_EQ(srgb_byte(kInfinity), 255);
    EXPECT_EQ(srgb_byte(-kInfinity), 0);
    EXPECT_EQ(srgb_byte(kNaN), 0);
    for (int byte = 0; byte < 256; ++byte) {
        EXPECT_EQ(srgb_byte(linear_from_srgb(static_cast<float>(byte) / 255.0f)), byte);
    }
}

// All 2^30 floats between 0 and 1 agree; here those around each change of byte, and every 1001st.
TEST(Srgb, BytesByTables) {
    const SrgbBytes byte;
    for (const float x : {kNaN, -kInfinity, -1.0f, -0.0f, 0.0f, 1.0f, 17.0f, kInfinity})
        EXPECT_EQ(byte(x), srgb_byte(x)) << x;
    const auto one = std::bit_cast<std::uint32_t>(1.0f);
    std::uint32_t last = 0;
    for (std::uint32_t bits = 0; bits < one; bits += 1001) {
        const auto x = std::bit_cast<float>(bits);
        ASSERT_EQ(byte(x), srgb_byte(x)) << x;
        const std::uint32_t now = srgb_byte(x);
        if (now == last) continue;
        last = now;
        for (std::uint32_t near = bits - 1001; near < bits + 1001; ++near) {
            const auto y = std::bit_cast<float>(near);
            ASSERT_EQ(byte(y), srgb_byte(y)) << y;
        }
    }
    EXPECT_EQ(last, 255u);
}

// Smooth and noisy, of more pixels than one thread takes at a time.
TEST_F(ImageFiles, LargePngIsReadBack) {
    constexpr ImageSize kLarge{700, 501};
    Image image;
    image.size = kLarge;
    Random random(8);
    for (int row = 0; row < kLarge.rows; ++row) {
        for (int col = 0; col < kLarge.cols; ++col) {
            const bool noisy = row % 200 > 150;
            const auto x = static_cast<float>(noisy ? random.between(0.0, 1.0) : col / 501.0);
            image.colour.emplace_back(x, 0.5f * x, static_cast<float>(row) / 700.0f);
        }
    }
    const std::vector<std::uint8_t> bytes = png_bytes(image);
    EXPECT_EQ(png_bytes(image), bytes) << "the same file every time";
    int width = 0;
    int height = 0;
    int channels = 0;
    stbi_uc* pixels = stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width,
                                            &height, &channels, 0);
    ASSERT_NE(pixels, nullptr);
    ASSERT_EQ((ImageSize{height, width}), kLarge);
    ASSERT_EQ(channels, 3);
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            ASSERT_EQ(pixels[3 * i + static_cast<std::size_t>(channel)],
                      srgb_byte(image.colour[i][channel]))
                << i;
        }
    }
    stbi_image_free(pixels);
}

// One row may be more than that.
TEST_F(ImageFiles, WidePngIsReadBack) {
    Image image = make_image({3, 100'000});
    image.colour[299'999] = glm::vec3(1.0f);
    const std::vector<std::uint8_t> bytes = png_bytes(image);
    int width = 0;
    int height = 0;
    int channels = 0;
    stbi_uc* pixels = stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width,
                                            &height, &channels, 0);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ((ImageSize{height, width}), image.size);
    EXPECT_EQ(pixels[899'999], 255);
    EXPECT_EQ(pixels[899'996], 0);
    stbi_image_free(pixels);
}

TEST_F(ImageFiles, PngIsReadBack) {
    Image image = random_image({7, 5});
    image.colour[3] = {kNaN, 0.5f, kInfinity};
    write_image(image, file("a.png"));
    int width = 0;
    int height = 0;
    int channels = 0;
    stbi_uc* pixels = stbi_load(file("a.png").c_str(), &width, &height, &channels, 0);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(width, 5);
    EXPECT_EQ(height, 7);
    ASSERT_EQ(channels, 3);
    for (std::size_t i = 0; i < 35; ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            EXPECT_EQ(pixels[3 * i + static_cast<std::size_t>(channel)],
                      srgb_byte(image.colour[i][channel]))
                << i;
        }
    }
    EXPECT_EQ(pixels[9], 0) << "NaN";
    EXPECT_EQ(pixels[10], 188);
    stbi_image_free(pixels);
    EXPECT_THAT(names(), testing::ElementsAre("a.png")) << "nothing else is left";
}

TEST_F(ImageFiles, RowZeroIsTheTopOfAPng) {
    Image image = make_image({2, 1});
    image.colour[0] = glm::vec3(1.0f);
    write_image(image, file("top.png"));
    int width = 0;
    int height = 0;
    int channels = 0;
    stbi_uc* pixels = stbi_load(file("top.png").c_str(), &width, &height, &channels, 3);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(pixels[0], 255);
    EXPECT_EQ(pixels[3], 0);
    stbi_image_free(pixels);
}

// Reads one channel of an EXR file as it is stored.
template <typename T>
std::vector<T> channel(Imf::InputFile& in, const char* name, Imf::PixelType type) {
    const Imath::Box2i window = in.header().dataWindow();
    const int cols = window.max.x - window.min.x + 1;
    const int rows = window.max.y - window.min.y + 1;
    std::vector<T> values(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
    Imf::FrameBuffer frame;
    frame.insert(name, Imf::Slice(type, reinterpret_cast<char*>(values.data()), sizeof(T),
                                  sizeof(T) * static_cast<std::size_t>(cols)));
    in.setFrameBuffer(frame);
    in.readPixels(window.min.y, window.max.y);
    return values;
}

std::vector<std::string> channel_names(const Imf::InputFile& in) {
    std::vector<std::string> found;
    for (auto i = in.header().channels().begin(); i != in.header().channels().end(); ++i) {
        found.emplace_back(i.name());
        const bool id = found.back().ends_with("_id");
        EXPECT_EQ(i.channel().type, id ? Imf::UINT : Imf::FLOAT) << found.back();
    }
    return found;
}

TEST_F(ImageFiles, AnExrHasTheChannelsThatTheImageHas) {
    const Image all = random_image({3, 4});
    const Image colour{all.size, all.colour, {}, {}, {}, {}};
    write_image(colour, file("a.exr"));
    Imf::InputFile in(file("a.exr").c_str());
    EXPECT_THAT(channel_names(in), testing::UnorderedElementsAre("R", "G", "B"));
    const std::vector<float> green = channel<float>(in, "G", Imf::FLOAT);
    for (std::size_t i = 0; i < all.colour.size(); ++i)
        EXPECT_EQ(green[i], all.colour[i].y);
}

TEST_F(ImageFiles, ExrIsReadBack) {
    const Image image = random_image({9, 13});
    write_image(image, file("a.exr"));
    Imf::InputFile in(file("a.exr").c_str());
    EXPECT_THAT(channel_names(in),
                testing::UnorderedElementsAre("R", "G", "B", "Z", "N.X", "N.Y", "N.Z", "object_id",
                                              "primitive_id"));
    EXPECT_EQ(in.header().dataWindow().max.x, 12);
    EXPECT_EQ(in.header().dataWindow().max.y, 8);
    const auto colour =
        std::array{channel<float>(in, "R", Imf::FLOAT), channel<float>(in, "G", Imf::FLOAT),
                   channel<float>(in, "B", Imf::FLOAT)};
    const auto normal =
        std::array{channel<float>(in, "N.X", Imf::FLOAT), channel<float>(in, "N.Y", Imf::FLOAT),
                   channel<float>(in, "N.Z", Imf::FLOAT)};
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(colour[k][i], image.colour[i][static_cast<int>(k)]);
            EXPECT_EQ(normal[k][i], image.normal[i][static_cast<int>(k)]);
        }
    }
    EXPECT_EQ(channel<float>(in, "Z", Imf::FLOAT), image.depth);
    EXPECT_EQ(channel<std::uint32_t>(in, "object_id", Imf::UINT), image.object);
    EXPECT_EQ(channel<std::uint32_t>(in, "primitive_id", Imf::UINT), image.primitive);
    EXPECT_THAT(names(), testing::ElementsAre("a.exr"));
}

TEST_F(ImageFiles, UpperCaseEndings) {
    write_image(make_image({1, 1}), file("A.PNG"));
    write_image(make_image({1, 1}), file("A.Exr"));
    EXPECT_THAT(names(), testing::UnorderedElementsAre("A.PNG", "A.Exr"));
}

TEST_F(ImageFiles, OtherEndingsAreRefused) {
    EXPECT_EQ(unsupported_image_name("x.png"), "");
    EXPECT_EQ(unsupported_image_name("folder.d/x.EXR"), "");
    for (const std::string name : {"x.jpg", "x", "png", ".png.txt", ""}) {
        EXPECT_NE(unsupported_image_name(name), "") << name;
        EXPECT_THROW(write_image(make_image({1, 1}), file("").string() + name), FileError) << name;
    }
    EXPECT_TRUE(names().empty());
}

// The PNG encoder counts bytes in an int.
TEST_F(ImageFiles, AnImageBeyondAPngIsRefusedByItsSize) {
    EXPECT_EQ(unsupported_image("x.png", {16384, 16384}), "");
    EXPECT_EQ(unsupported_image("x.exr", {65535, 65535}), "");
    EXPECT_EQ(unsupported_image("x.PNG", {65535, 65535}),
              "too large for a PNG: write .exr instead");
    EXPECT_NE(unsupported_image("x.jpg", {1, 1}), "");
}

TEST_F(ImageFiles, AMissingFolderIsAnError) {
    for (const std::string name : {"missing/a.png", "missing/a.exr"}) {
        try {
            write_image(random_image({3, 3}), file(name));
            FAIL() << "there is no such folder";
        } catch (const FileError& error) {
            EXPECT_EQ(error.file(), file(name).string());
            EXPECT_EQ(std::string(error.what()).find(".part"), std::string::npos)
                << "names the target: " << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
    EXPECT_TRUE(names().empty());
}

TEST_F(ImageFiles, AFailureLeavesNothingAndKeepsWhatWasThere) {
    // A folder in the target's place can't be replaced by a file.
    for (const std::string name : {"taken.png", "taken.exr"}) {
        fs::create_directories(file(name) / "inside");
        EXPECT_THROW(write_image(random_image({3, 3}), file(name)), FileError);
        EXPECT_TRUE(fs::is_directory(file(name) / "inside"));
    }
    EXPECT_THAT(names(), testing::UnorderedElementsAre("taken.png", "taken.exr"));
}

TEST_F(ImageFiles, AnExistingFileIsReplacedWhole) {
    std::ofstream(file("a.png")) << std::string(100000, 'x');
    write_image(make_image({1, 1}), file("a.png"));
    EXPECT_LT(fs::file_size(file("a.png")), 1000u);
    EXPECT_THAT(names(), testing::ElementsAre("a.png"));
}

TEST_F(ImageFiles, AnEmptyImageIsAnErrorNotACrash) {
    EXPECT_THROW(write_image(make_image({0, 0}), file("a.png")), FileError);
    EXPECT_THROW(write_image(make_image({0, 0}), file("a.exr")), FileError);
    EXPECT_TRUE(names().empty());
}

}  // namespace
}  // namespace raypick
