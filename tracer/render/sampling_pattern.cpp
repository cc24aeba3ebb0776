#include "tracer/render/sampling_pattern.h"

#include "tracer/geometry/unit_disk.h"
#include "tracer/shade/random.h"

#include <cmath>
#include <numbers>

namespace raypick {

namespace {

// What the numbers of a pixel and of a sample are derived by.
enum Stream : std::uint64_t { image_order, lens_order, path };

// A random place in the cell of this number, of side x side cells in the unit square.
glm::dvec2 place_in_cell(std::uint32_t cell, int side, RandomSequence& random) {
    const auto cells = static_cast<std::uint32_t>(side);
    const glm::dvec2 corner(cell % cells, cell / cells);
    const auto x = static_cast<double>(random.next());
    const auto y = static_cast<double>(random.next());
    return (corner + glm::dvec2(x, y)) / static_cast<double>(side);
}

}  // namespace

SamplingPattern::SamplingPattern(const RenderSettings& settings)
    : side_(settings.samples), seed_(settings.seed), filter_(settings.filter) {}

PixelSample SamplingPattern::sample(std::uint64_t pixel, int index) const {
    const std::uint64_t pixel_seed = RandomSequence::derive(seed_, pixel);
    const auto number = static_cast<std::uint32_t>(index);
    const auto cells = static_cast<std::uint32_t>(count());
    const std::uint64_t sample_seed = RandomSequence::derive(~pixel_seed, number);
    const auto cell_of = [&](Stream order) {
        return shuffled(number, cells, RandomSequence::derive(pixel_seed, order));
    };
    RandomSequence random(sample_seed);
    const glm::dvec2 in_filter = place_in_cell(cell_of(image_order), side_, random);
    const FilterOffset x = filter_.sample(in_filter.x);
    const FilterOffset y = filter_.sample(in_filter.y);
    PixelSample sample;
    sample.offset = {x.offset, y.offset};
    sample.negative = x.negative != y.negative;
    sample.lens = disk_from_square(place_in_cell(cell_of(lens_order), side_, random));
    sample.seed = RandomSequence::derive(sample_seed, path);
    return sample;
}

// A Feistel network on the next power of four, walked until it comes out inside: Black, Rogaway,
// "Ciphers with Arbitrary Finite Domains", CT-RSA 2002.
std::uint32_t shuffled(std::uint32_t index, std::uint32_t count, std::uint64_t key) {
    if (count <= 1) return 0;
    constexpr std::uint64_t kRounds = 4;
    std::uint32_t half = 1;
    while ((count - 1) >> (2 * half) != 0)
        ++half;
    const std::uint32_t mask = (1u << half) - 1;
    do {
        std::uint32_t left = index >> half;
        std::uint32_t right = index & mask;
        for (std::uint64_t round = 0; round < kRounds; ++round) {
            const std::uint64_t mixed = RandomSequence::derive(key + round, right);
            const std::uint32_t next = left ^ (static_cast<std::uint32_t>(mixed) & mask);
            left = right;
            right = next;
        }
        index = left << half | right;
    } while (index >= count);
    return index;
}

}  // namespace raypick
