#include "tracer/bvh/morton.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <array>

namespace raypick {

namespace {

constexpr int kBitsPerAxis = 10;
constexpr int kDigitBits = 10;
constexpr int kDigits = 3 * kBitsPerAxis / kDigitBits;
constexpr std::size_t kChunk = 1u << 15;

// Moves bit i to bit 3 i.
Int4 spread(Int4 bits) {
    bits = (bits | bits << 16) & 0x030000ff;
    bits = (bits | bits << 8) & 0x0300f00f;
    bits = (bits | bits << 4) & 0x030c30c3;
    return (bits | bits << 2) & 0x09249249;
}

// Cells are cubes, so that a flat scene is not cut along its thin side first.
class Grid {
public:
    explicit Grid(const Box4& twice_centres) : base_(twice_centres.min) {
        const Float4 extent = twice_centres.max - twice_centres.min;
        const float longest = std::max({extent[0], extent[1], extent[2]});
        const float scale = static_cast<float>(1 << kBitsPerAxis) * (1.0f - 1e-5f) / longest;
        constexpr float kLargest = 1e30f;
        if (scale > 0.0f && scale < kLargest) scale_ = all4(scale);
        base_[3] = 1.0f;  // the index in this lane is a denormal number: slow to multiply
    }

    [[nodiscard]] std::uint32_t code(const BoxRef& ref) const {
        // A centre beyond the range of float may make this a NaN, which goes to cell 0.
        const Float4 place = max4((ref.twice_centre() - base_) * scale_, all4(0.0f));
        const Int4 bits = spread(__builtin_convertvector(place, Int4));
        return static_cast<std::uint32_t>(bits[0] << 2 | bits[1] << 1 | bits[2]);
    }

private:
    Float4 base_;
    Float4 scale_ = all4(0.0f);
};

using Keys = LargeArray<MortonKey>;
using Counts = std::array<std::uint32_t, 1u << kDigitBits>;

// Sorts by digits, lowest first, each pass keeping the order of equal ones.
class RadixSort {
public:
    RadixSort(Keys& keys, const BvhOptions& options)
        : keys_(keys), other_(keys.size()), options_(options) {
        counts_.resize((keys.size() + kChunk - 1) / kChunk);
    }

    void run() {
        for (int digit = 0; digit < kDigits; ++digit) {
            shift_ = digit * kDigitBits;
            for_chunks([this](std::size_t i) { count_chunk(i); });
            sum_up();
            for_chunks([this](std::size_t i) { move_chunk(i); });
            keys_.swap(other_);
        }
    }

private:
    template <typename Body>
    void for_chunks(const Body& body) {
        parallel_for(counts_.size(), options_.threads, options_.stop, body);
        if (options_.stop.stop_requested()) throw Cancelled();
    }

    [[nodiscard]] std::size_t digit_of(const MortonKey& key) const {
        return key.code >> shift_ & ((1u << kDigitBits) - 1u);
    }

    [[nodiscard]] std::span<const MortonKey> chunk(std::size_t i) const {
        const std::size_t begin = i * kChunk;
        return std::span(keys_).subspan(begin, std::min(kChunk, keys_.size() - begin));
    }

    void count_chunk(std::size_t i) {
        counts_[i].fill(0);
        for (const MortonKey& key : chunk(i))
            ++counts_[i][digit_of(key)];
    }

    // From counts to where each chunk's first key of a digit goes.
    void sum_up() {
        std::uint32_t sum = 0;
        for (std::size_t digit = 0; digit < Counts().size(); ++digit) {
            for (Counts& counts : counts_) {
                const std::uint32_t count = counts[digit];
                counts[digit] = sum;
                sum += count;
            }
        }
    }

    void move_chunk(std::size_t i) {
        for (const MortonKey& key : chunk(i))
            other_[counts_[i][digit_of(key)]++] = key;
    }

    Keys& keys_;
    Keys other_;
    const BvhOptions& options_;
    std::vector<Counts> counts_;
    int shift_ = 0;
};

}  // namespace

LargeArray<MortonKey> morton_order(const RefArray& array, const BvhOptions& options) {
    const std::span<const BoxRef> refs = array.refs();
    const Grid grid(array.bounds.centres);
    Keys keys(refs.size());
    parallel_for((refs.size() + kChunk - 1) / kChunk, options.threads, options.stop,
                 [&](std::size_t chunk) {
                     const std::size_t end = std::min(refs.size(), (chunk + 1) * kChunk);
                     for (std::size_t i = chunk * kChunk; i < end; ++i)
                         keys[i] = {grid.code(refs[i]), static_cast<std::uint32_t>(i)};
                 });
    if (options.stop.stop_requested()) throw Cancelled();
    RadixSort(keys, options).run();
    return keys;
}

}  // namespace raypick
