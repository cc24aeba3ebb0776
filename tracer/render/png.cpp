// Writes PNG (W3C, "Portable Network Graphics Specification, Second Edition", 2003): bands of rows
// are filtered and compressed side by side, each as deflate blocks that end on a byte, as pigz does
// with gzip files. The bands depend on the image alone, so the file does, too.
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"
#include "tracer/render/image_files.h"
#include "tracer/render/srgb_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <string_view>
#include <system_error>

namespace raypick {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kBandBytes = 1u << 18u;
// Measured on rendered pictures: hardly slower than 1 and 3 to 5 % smaller; 3 takes longer.
constexpr int kLevel = 2;

std::size_t row_bytes(ImageSize size) {
    return 3 * static_cast<std::size_t>(size.cols);
}

// Rows of one band.
std::size_t band_rows(ImageSize size) {
    return std::max<std::size_t>(1, kBandBytes / row_bytes(size));
}

void append_number(Bytes& bytes, std::uint32_t value) {
    for (const unsigned shift : {24u, 16u, 8u, 0u})
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

// Every chunk has its length in front and a checksum of name and content behind.
void append_chunk(Bytes& file, std::string_view name, const Bytes& content) {
    append_number(file, static_cast<std::uint32_t>(content.size()));
    const std::size_t begin = file.size();
    file.insert(file.end(), name.begin(), name.end());
    file.insert(file.end(), content.begin(), content.end());
    const uLong sum = crc32_z(0, &file[begin], file.size() - begin);
    append_number(file, static_cast<std::uint32_t>(sum));
}

// Sum of the differences' sizes: the smaller, the better the row compresses (the heuristic that the
// specification recommends).
std::size_t total(const std::uint8_t* differences, std::size_t count) {
    unsigned sum = 0;  // 2^30 bytes of at most 128
    for (std::size_t i = 0; i < count; ++i) {
        const auto signed_byte = static_cast<std::int8_t>(differences[i]);
        sum += static_cast<unsigned>(signed_byte < 0 ? -signed_byte : signed_byte);
    }
    return sum;
}

// One row's bytes and those of the row above, as PNG's filters see them.
class RowFilter {
public:
    explicit RowFilter(std::size_t count) : row_(count), above_(count), left_(count), up_(count) {}

    std::uint8_t* next_row() {
        std::swap(row_, above_);
        return row_.data();
    }

    // The row by the better one of the filters Sub (1) and Up (2).
    void append_to(Bytes& out) {
        std::copy_n(row_.begin(), 3, left_.begin());
        for (std::size_t i = 3; i < row_.size(); ++i)
            left_[i] = static_cast<std::uint8_t>(row_[i] - row_[i - 3]);
        for (std::size_t i = 0; i < row_.size(); ++i)
            up_[i] = static_cast<std::uint8_t>(row_[i] - above_[i]);
        const bool up = total(up_.data(), up_.size()) <= total(left_.data(), left_.size());
        out.push_back(up ? 2 : 1);
        const Bytes& better = up ? up_ : left_;
        out.insert(out.end(), better.begin(), better.end());
    }

private:
    Bytes row_;
    Bytes above_;  // 0 above the first row
    Bytes left_;
    Bytes up_;
};

void fill_row(const Image& image, std::size_t row, const SrgbBytes& byte, std::uint8_t* out) {
    const auto cols = static_cast<std::size_t>(image.size.cols);
    for (std::size_t i = row * cols; i < (row + 1) * cols; ++i) {
        for (int channel = 0; channel < 3; ++channel)
            *out++ = byte(image.colour[i][channel]);
    }
}

Bytes filtered_rows(const Image& image, std::size_t begin, std::size_t end, const SrgbBytes& byte) {
    RowFilter filter(row_bytes(image.size));
    if (begin > 0) fill_row(image, begin - 1, byte, filter.next_row());
    Bytes filtered;
    filtered.reserve((end - begin) * (row_bytes(image.size) + 1));
    for (std::size_t row = begin; row < end; ++row) {
        fill_row(image, row, byte, filter.next_row());
        filter.append_to(filtered);
    }
    return filtered;
}

// `flush`: Z_SYNC_FLUSH to end on a byte, Z_FINISH to end for good.
Bytes deflated(const Bytes& bytes, int flush) {
    z_stream stream{};
    constexpr int kRaw = -15;
    constexpr int kMemory = 8;
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, kRaw, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
        throw std::bad_alloc();
    }
    const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);
    constexpr std::size_t kFlushed = 16;  // more than a flush adds
    Bytes out(deflateBound(&stream, static_cast<uLong>(bytes.size())) + kFlushed);
    stream.next_in = const_cast<Bytef*>(bytes.data());  // NOLINT: zlib only reads it
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    const int result = deflate(&stream, flush);
    if (result != (flush == Z_FINISH ? Z_STREAM_END : Z_OK) || stream.avail_in != 0) {
        throw Error("the PNG encoder failed");
    }
    out.resize(out.size() - stream.avail_out);
    return out;
}

struct Band {
    Bytes deflated;
    std::size_t size = 0;  // before that
    uLong checksum = 0;
};

std::vector<Band> compress(const Image& image) {
    const SrgbBytes byte;
    const auto rows = static_cast<std::size_t>(image.size.rows);
    const std::size_t height = band_rows(image.size);
    std::vector<Band> bands((rows + height - 1) / height);
    parallel_for(bands.size(), 0, {}, [&](std::size_t i) {
        const std::size_t end = std::min(rows, (i + 1) * height);
        const Bytes filtered = filtered_rows(image, i * height, end, byte);
        Band& band = bands[i];
        band.size = filtered.size();
        band.checksum = adler32_z(1, filtered.data(), filtered.size());
        band.deflated = deflated(filtered, end == rows ? Z_FINISH : Z_SYNC_FLUSH);
    });
    return bands;
}

// Around the bands of a zlib stream stand two bytes and a checksum.
void add_stream_ends(std::vector<Band>& bands) {
    uLong checksum = bands.front().checksum;
    for (std::size_t i = 1; i < bands.size(); ++i)
        checksum =
            adler32_combine(checksum, bands[i].checksum, static_cast<z_off_t>(bands[i].size));
    const Bytes begin = {0x78, 0x01};
    Bytes& first = bands.front().deflated;
    first.insert(first.begin(), begin.begin(), begin.end());
    append_number(bands.back().deflated, static_cast<std::uint32_t>(checksum));
}

}  // namespace

bool fits_png(ImageSize size) {
    constexpr std::int64_t kLargest = 1 << 30;  // stb_image, which reads it, counts in an int
    return (std::int64_t{3} * size.cols + 1) * size.rows <= kLargest;
}

std::vector<std::uint8_t> png_bytes(const Image& image) {
    if (image.colour.empty()) throw Error("an image without pixels can't be a PNG");
    if (!fits_png(image.size)) throw Error("too large for a PNG: write .exr instead");
    std::vector<Band> bands = compress(image);
    add_stream_ends(bands);
    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    Bytes header;
    append_number(header, static_cast<std::uint32_t>(image.size.cols));
    append_number(header, static_cast<std::uint32_t>(image.size.rows));
    // 8 bits, RGB, the only compression, the only set of filters, not interlaced.
    header.insert(header.end(), {8, 2, 0, 0, 0});
    append_chunk(file, "IHDR", header);
    for (const Band& band : bands)
        append_chunk(file, "IDAT", band.deflated);
    append_chunk(file, "IEND", {});
    return file;
}

void write_png_file(const Image& image, const std::filesystem::path& file,
                    const std::filesystem::path& target) {
    const std::vector<std::uint8_t> bytes = png_bytes(image);
    errno = 0;
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
        const std::string reason =
            errno != 0 ? std::generic_category().message(errno) : std::string("write failed");
        throw FileError(target.string(), "can't be written: " + reason);
    }
}

}  // namespace raypick
