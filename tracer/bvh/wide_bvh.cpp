#include "tracer/bvh/wide_bvh.h"

#include "tracer/bvh/float4.h"

#include <cstddef>
#include <limits>

namespace raypick {

namespace {

// Of each child, a lane for each of the four octants in which z is positive.
template <typename Lanes>
using PerChild = std::array<Lanes, kWidth>;

// How far the boxes' centres are along the octants' diagonals, times a factor.
PerChild<Float4> along_diagonals(const WideNode& node) {
    constexpr std::int32_t kSign = std::numeric_limits<std::int32_t>::min();
    const Int4 minus_x{0, kSign, 0, kSign};
    const Int4 minus_y{0, 0, kSign, kSign};
    const auto& planes = node.planes;
    PerChild<Float4> along{};
    for (std::size_t i = 0; i < kWidth; ++i) {
        const Int4 x = bits_of(all4(planes[0][i] + planes[3][i])) ^ minus_x;
        const Int4 y = bits_of(all4(planes[1][i] + planes[4][i])) ^ minus_y;
        const Float4 sum = from_bits(x) + from_bits(y) + all4(planes[2][i] + planes[5][i]);
        // Empty boxes have no centre, but a NaN: they come last.
        along[i] = max4(sum, all4(-std::numeric_limits<float>::infinity()));
    }
    return along;
}

// How many children come before each: those that are farther, and those as far with a lower number.
PerChild<Int4> count_before(const PerChild<Float4>& along) {
    PerChild<Int4> before{};
    for (std::size_t i = 0; i < kWidth; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const Int4 farther = along[i] > along[k];  // -1 where it is
            before[k] -= farther;
            before[i] += farther + 1;
        }
    }
    return before;
}

// 8^power, exactly.
Float4 power_of_8(Int4 power) {
    return from_bits((3 * power + 127) << 23);
}

}  // namespace

Bounds WideNode::box(std::uint32_t i) const {
    return {{planes[0][i], planes[1][i], planes[2][i]}, {planes[3][i], planes[4][i], planes[5][i]}};
}

// By their centres along the octant's diagonal; in opposite octants the other way round.
void WideNode::sort_children() {
    const PerChild<Int4> before = count_before(along_diagonals(*this));
    // Three bits a child: whole numbers below 2^24, which floats hold exactly.
    Float4 forwards{};
    Float4 backwards{};
    for (std::size_t i = 0; i < kWidth; ++i) {
        const Float4 number = all4(static_cast<float>(i));
        forwards += number * power_of_8(before[i]);
        backwards += number * power_of_8(static_cast<std::int32_t>(kWidth - 1) - before[i]);
    }
    for (std::size_t octant = 0; octant < 4; ++octant) {
        const auto front = static_cast<std::uint32_t>(forwards[octant]);
        const auto back = static_cast<std::uint32_t>(backwards[octant]);
        std::memcpy(order.data() + 3 * octant, &front, 3);
        std::memcpy(order.data() + 3 * (7 - octant), &back, 3);
    }
}

}  // namespace raypick
