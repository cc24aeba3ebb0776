// Random numbers that depend on nothing but what they are for, so that an image is the same for any
// number of threads.
#pragma once

#include <cstdint>

namespace raypick {

// SplitMix64: a sequence of numbers in [0, 1). Source: Steele, Lea, Flood, "Fast Splittable
// Pseudorandom Number Generators", OOPSLA 2014.
class RandomSequence {
public:
    explicit RandomSequence(std::uint64_t seed) : state_(seed) {}

    float next() {
        state_ += kStep;
        return static_cast<float>(mixed(state_) >> 40u) * 0x1p-24f;
    }

    // Goes past this many numbers.
    void skip(std::uint64_t count) { state_ += count * kStep; }

    // A seed for the sequence that belongs to `index` within what `seed` stands for.
    static std::uint64_t derive(std::uint64_t seed, std::uint64_t index) {
        return mixed(seed ^ mixed(index + kStep));
    }

private:
    static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;

    static std::uint64_t mixed(std::uint64_t z) {
        z = (z ^ (z >> 30u)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27u)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31u);
    }

    std::uint64_t state_;
};

}  // namespace raypick
