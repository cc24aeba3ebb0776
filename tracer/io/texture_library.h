// The textures of a model while it is read: first all images that its materials name are decoded at
// once, then all textures are made of them at once.
#pragma once

#include "tracer/io/image_decode.h"
#include "tracer/io/load.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raypick {

// An image that a model names.
struct ImageSource {
    std::string name;            // tells images apart; "" is not allowed
    std::filesystem::path file;  // "" if the bytes are inside another file
    std::string_view bytes{};    // then these, which must stay until decode() is done
    std::string problem{};       // what is wrong if there is neither: "is missing"
    std::string place{};         // where it is asked for, as warnings begin: "a.mtl: line 12"
};

class TextureLibrary {
public:
    using ImageNumber = std::size_t;

    // The textures go to `target`, which must outlive this.
    explicit TextureLibrary(LoadedScene& target) : target_(&target) {}

    // An image to decode; known ones are not decoded again. HDR and EXR images are made bytes as
    // the coding says, because materials have no more than that.
    ImageNumber image(ImageSource source, TexelCoding coding);

    // Decodes the images, in parallel; those that can't be read are said in warnings. Reports
    // progress between the two numbers. Throws Cancelled.
    void decode(const LoadOptions& options, float progress_begin, float progress_end);

    // After decode(). A broken image is the placeholder's.
    [[nodiscard]] bool broken(ImageNumber image) const { return entries_[image].broken; }
    [[nodiscard]] std::shared_ptr<const ByteImage> pixels(ImageNumber image) const {
        return entries_[image].pixels;
    }
    [[nodiscard]] const std::string& name(ImageNumber image) const {
        return entries_[image].source.name;
    }

    // The texture that shows an image as it is; the same id for the same image.
    TextureId texture(ImageNumber image);
    // The texture of what `bake` makes, in make(), of pixels() that it keeps. The same key means
    // the same texture, whose name it becomes.
    TextureId baked(const std::string& key, TexelCoding coding, std::function<ByteImage()> bake);

    // Makes the textures, in parallel, and lets go of the images. Throws Cancelled.
    void make(const LoadOptions& options, float progress_begin, float progress_end);

private:
    struct Entry {
        ImageSource source;
        TexelCoding coding = TexelCoding::srgb;
        std::shared_ptr<ByteImage> pixels;
        std::string complaint;
        bool broken = false;
    };
    struct Job {
        TextureId texture = kNoTexture;
        TexelCoding coding = TexelCoding::srgb;
        std::function<ByteImage()> bake;
        std::shared_ptr<ByteImage> as_it_is{};  // instead
        bool last = false;                      // nobody else looks at that
    };

    static void decode(Entry& entry);
    static ByteImage image_of(Job& job);
    TextureId texture_of(const std::string& key, Job job);

    LoadedScene* target_;
    std::vector<Entry> entries_;
    std::map<std::pair<std::string, TexelCoding>, ImageNumber> numbers_;
    std::map<std::string, TextureId> textures_;
    std::vector<Job> jobs_;
};

// --- Looking at images --------------------------------------------------------------------------

// Is channel 0..3 the same everywhere, but for a step of rounding?
bool is_uniform(const ByteImage& image, int channel);
// Are all texels r = g = b?
bool is_grey(const ByteImage& image);
// Is nearly every texel's channel close to 0 or to 255: a shape cut out?
bool is_nearly_binary(const ByteImage& image, int channel);
// Rec. 709 luminance of the bytes, in all three colours.
ByteImage luminance(const ByteImage& image);

}  // namespace raypick
