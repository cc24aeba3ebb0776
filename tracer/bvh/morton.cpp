#include "tracer/bvh/morton.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace raypick {

namespace {

constexpr int kBitsPerAxis = 10;
constexpr int kDigitBits = 10;
constexpr int kDigits = 3 * kBitsPerAxis / kDigitBits;
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
        base_[3] = 0.0f;
    }

    [[nodiscard]] std::uint32_t code(Float4 twice_centre) const {
        // A centre beyond the range of float may make this a NaN, which goes to cell 0.
        const Float4 place = max4((twice_centre - base_) * scale_, all4(0.0f));
        const Int4 bits = spread(__builtin_convertvector(place, Int4));
        return static_cast<std::uint32_t>(bits[0] << 2 | bits[1] << 1 | bits[2]);
    }

private:
    Float4 base_;
    Float4 scale_ = all4(0.0f);
};

using Keys = LargeArray<MortonKey>;

float longest_side(const Box4& box) {
    const Float4 extent = box.max - box.min;
    return std::max({extent[0], extent[1], extent[2]});
}

// Keys of the usable boxes, in order.
class KeyMaker {
public:
    KeyMaker(std::size_t count, const Box4Source& boxes, const BvhOptions& options)
        : count_(count), boxes_(boxes), options_(options), keys_(count) {
        chunks_.resize((count + kChunk - 1) / kChunk);
    }

    Keys make(const Box4& around) {
        fill(Grid({around.min + around.min, around.max + around.max}));
        const Box4 centres = centres_of_all();
        // Anew if nothing was known, or if half of the cells along each side are empty.
        const float known = longest_side(around);
        if (!(known >= 0.0f && longest_side(centres) > known)) fill(Grid(centres));
        close_gaps();
        return std::move(keys_);
    }

private:
    static constexpr std::size_t kChunk = 1u << 13;

    struct Chunk {
        std::size_t count = 0;
        Box4 centres;  // around twice the boxes' centres
    };

    void fill(const Grid& grid) {
        parallel_for(chunks_.size(), options_.threads, options_.stop, [&](std::size_t i) {
            chunks_[i] = fill_chunk(grid, i * kChunk, std::min(count_, (i + 1) * kChunk));
        });
        if (options_.stop.stop_requested()) throw Cancelled();
    }

    // Puts keys where they are if no box is left out.
    Chunk fill_chunk(const Grid& grid, std::size_t begin, std::size_t end) {
        std::array<Box4, 128> some;
        Chunk chunk;
        for (std::size_t i = begin; i < end; i += some.size()) {
            const std::span<Box4> wanted(some.data(), std::min(some.size(), end - i));
            boxes_(i, wanted);
            for (std::size_t k = 0; k < wanted.size(); ++k) {
                const Box4 box = wanted[k];
                if (!is_usable(box)) continue;
                const Float4 twice_centre = box.min + box.max;
                chunk.centres.extend(twice_centre);
                keys_[begin + chunk.count++] = {grid.code(twice_centre),
                                                static_cast<std::uint32_t>(i + k)};
            }
        }
        return chunk;
    }

    [[nodiscard]] Box4 centres_of_all() const {
        Box4 centres;
        for (const Chunk& chunk : chunks_)
            centres.extend(chunk.centres);
        return centres;
    }

    void close_gaps() {
        std::size_t end = 0;
        for (std::size_t i = 0; i < chunks_.size(); ++i) {
            const MortonKey* const begin = keys_.data() + i * kChunk;
            if (end != i * kChunk) std::copy(begin, begin + chunks_[i].count, keys_.data() + end);
            end += chunks_[i].count;
        }
        keys_.resize(end);
    }

    std::size_t count_;
    const Box4Source& boxes_;
    const BvhOptions& options_;
    Keys keys_;
    std::vector<Chunk> chunks_;
};

using Counts = std::array<std::uint32_t, 1u << kDigitBits>;

// Sorts by digits, lowest first, each pass keeping the order of equal ones.
class RadixSort {
public:
    RadixSort(Keys& keys, const BvhOptions& options)
        : keys_(keys), other_(keys.size()), options_(options), chunk_(chunk_size()) {
        counts_.resize((keys.size() + chunk_ - 1) / chunk_);
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
    // Some for each thread; not too many, as each has counts of its own, and not so large that a
    // cancelled build goes on for long.
    [[nodiscard]] std::size_t chunk_size() const {
        const auto threads =
            static_cast<std::size_t>(options_.threads > 0 ? options_.threads : hardware_threads());
        const std::size_t share = threads == 1 ? keys_.size() : keys_.size() / (4 * threads);
        return std::clamp<std::size_t>(share, 1u << 12, 1u << 18);
    }

    template <typename Body>
    void for_chunks(const Body& body) {
        parallel_for(counts_.size(), options_.threads, options_.stop, body);
        if (options_.stop.stop_requested()) throw Cancelled();
    }

    [[nodiscard]] std::size_t digit_of(const MortonKey& key) const {
        return key.code >> shift_ & ((1u << kDigitBits) - 1u);
    }

    [[nodiscard]] std::span<const MortonKey> chunk(std::size_t i) const {
        const std::size_t begin = i * chunk_;
        return std::span(keys_).subspan(begin, std::min(chunk_, keys_.size() - begin));
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
    std::size_t chunk_;  // keys in each; the order of keys doesn't depend on it
    std::vector<Counts> counts_;
    int shift_ = 0;
};

}  // namespace

LargeArray<MortonKey> morton_order(std::size_t count, const Box4Source& boxes, const Box4& around,
                                   const BvhOptions& options) {
    Keys keys = KeyMaker(count, boxes, options).make(around);
    RadixSort(keys, options).run();
    return keys;
}

}  // namespace raypick
