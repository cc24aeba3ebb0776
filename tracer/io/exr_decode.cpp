// Images by OpenEXR.
#include "tracer/error.h"
#include "tracer/io/image_decode.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <cstring>
#include <exception>
#include <string>

namespace raypick {

namespace {

// What OpenEXR reads from: bytes in memory.
class ByteStream : public Imf::IStream {
public:
    explicit ByteStream(std::string_view bytes) : IStream("image"), bytes_(bytes) {}

    bool read(char to[], int count) override {
        const auto wanted = static_cast<std::size_t>(count);
        if (count < 0 || wanted > bytes_.size() - at_) throw Error("the file ends too early");
        std::memcpy(to, bytes_.data() + at_, wanted);
        at_ += wanted;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t place) override {
        if (place > bytes_.size()) throw Error("the file ends too early");
        at_ = static_cast<std::size_t>(place);
    }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

FloatImage read_pixels(std::string_view bytes) {
    ByteStream stream(bytes);
    Imf::InputFile file(stream, 1);
    const Imath::Box2i window = file.header().dataWindow();
    const long long cols = static_cast<long long>(window.max.x) - window.min.x + 1;
    const long long rows = static_cast<long long>(window.max.y) - window.min.y + 1;
    check_image_size(rows, cols);
    const Imf::ChannelList& channels = file.header().channels();
    const bool grey = channels.findChannel("R") == nullptr && channels.findChannel("Y") != nullptr;
    if (!grey && channels.findChannel("R") == nullptr) {
        throw Error("has no channels R, G, B or Y");
    }
    FloatImage image{static_cast<int>(rows), static_cast<int>(cols), {}};
    image.texels.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols));
    Imf::FrameBuffer frame;
    const auto add = [&](const char* name, float* first, double otherwise) {
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, first, window, sizeof(glm::vec4),
                                            sizeof(glm::vec4) * static_cast<std::size_t>(cols), 1,
                                            1, otherwise));
    };
    add(grey ? "Y" : "R", &image.texels[0].x, 0.0);
    if (!grey) {
        add("G", &image.texels[0].y, 0.0);
        add("B", &image.texels[0].z, 0.0);
    }
    add("A", &image.texels[0].w, 1.0);
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    for (glm::vec4& texel : image.texels) {
        if (grey) texel.y = texel.z = texel.x;
        for (int i = 0; i < 4; ++i)
            texel[i] = light_or_zero(texel[i]);
    }
    return image;
}

}  // namespace

bool is_exr(std::string_view bytes) {
    return bytes.substr(0, 4) == "\x76\x2f\x31\x01";
}

FloatImage decode_exr(std::string_view bytes) {
    try {
        return read_pixels(bytes);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        throw Error(std::string("is a broken image (") + failure.what() + ")");
    }
}

}  // namespace raypick
