#include "tracer/error.h"
#include "tracer/render/image_files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <cerrno>
#include <exception>
#include <system_error>

namespace raypick {

namespace {

// Adds a channel whose samples lie `stride` bytes apart. OpenEXR takes a non-const pointer although
// it only reads.
template <typename T>
void add_channel(Imf::Header& header, Imf::FrameBuffer& frame, const char* name,
                 Imf::PixelType type, const T* first, std::size_t stride, int cols) {
    header.channels().insert(name, Imf::Channel(type));
    // OpenEXR only reads. NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    auto* base = const_cast<char*>(reinterpret_cast<const char*>(first));
    frame.insert(name, Imf::Slice(type, base, stride, stride * static_cast<std::size_t>(cols)));
}

}  // namespace

void write_exr_file(const Image& image, const std::filesystem::path& file,
                    const std::filesystem::path& target) {
    try {
        const int cols = image.size.cols;
        Imf::Header header(cols, image.size.rows);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        const auto vector = [&](const char* name, const float* first) {
            add_channel(header, frame, name, Imf::FLOAT, first, sizeof(glm::vec3), cols);
        };
        vector("R", &image.colour[0].x);
        vector("G", &image.colour[0].y);
        vector("B", &image.colour[0].z);
        if (!image.normal.empty()) {
            vector("N.X", &image.normal[0].x);
            vector("N.Y", &image.normal[0].y);
            vector("N.Z", &image.normal[0].z);
        }
        const auto number = [&](const char* name, Imf::PixelType type, const auto& channel) {
            if (channel.empty()) return;
            add_channel(header, frame, name, type, channel.data(), sizeof(channel[0]), cols);
        };
        number("Z", Imf::FLOAT, image.depth);
        number("object_id", Imf::UINT, image.object);
        number("primitive_id", Imf::UINT, image.primitive);
        errno = 0;
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(frame);
        out.writePixels(image.size.rows);
    } catch (const std::exception& failure) {
        // OpenEXR's own words would name the temporary file.
        const std::string reason =
            errno != 0 ? std::generic_category().message(errno) : std::string(failure.what());
        throw FileError(target.string(), "can't be written: " + reason);
    }
}

}  // namespace raypick
