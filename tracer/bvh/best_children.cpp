#include "tracer/bvh/best_children.h"

#include "tracer/bvh/float4.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace raypick {

namespace {

constexpr std::size_t kOne = kWidth;  // where the cost of one subtree stands

// Larger than any cost, even twice.
constexpr float kImpossible = 1e30f;

// In a cost's lowest bits stands how many children the first of the two below becomes; 0: none.
constexpr std::int32_t kShareBits = 7;

Float4 with_share(Float4 cost, std::size_t share) {
    const auto bits = static_cast<std::int32_t>(share);
    return from_bits((bits_of(cost) & ~kShareBits) | bits);
}

Float4 load4(const float* at) {
    Float4 values;
    std::memcpy(&values, at, sizeof values);
    return values;
}

// The factor that makes an area a cost; 0 where areas tell nothing.
float visits_per_area(const BvhNode& root) {
    const float area = root.bounds.half_area();
    return area > 1e-30f && area < 1e30f ? 1.0f / area : 0.0f;
}

}  // namespace

void BestChildren::find(std::span<const BvhNode> nodes, float per_node) {
    nodes_ = nodes;
    costs_.resize(nodes.size());
    const float per_area = visits_per_area(nodes.front());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        Costs& costs = costs_[i];
        std::fill_n(costs.begin(), kOne, kImpossible);
        if (nodes[i].is_leaf()) {
            std::fill(costs.begin() + kOne, costs.end(), 0.0f);
            continue;
        }
        const Costs& left = costs_[nodes[i].first];
        const Costs& right = costs_[nodes[i].first + 1];
        // If it is opened: at most one child to at most eight.
        Float4 few = all4(kImpossible);
        Float4 many = few;
        for (std::size_t share = 1; share < kWidth; ++share) {
            const Float4 first = all4(left[kOne - 1 + share]);
            few = min4(with_share(first + load4(&right[kOne - share]), share), few);
            many = min4(with_share(first + load4(&right[kOne + 4 - share]), share), many);
        }
        // Areas may be infinite, which times 0 is a NaN.
        const float visits = per_area > 0.0f ? nodes[i].bounds.half_area() * per_area : 0.0f;
        const Float4 whole = with_share(all4(many[3] + visits + per_node), 0);
        few = min4(few, whole);
        const Float4 seven = min4(many, whole);
        std::memcpy(&costs[kOne], &few, sizeof few);
        std::memcpy(&costs[kOne + 4], &seven, sizeof seven);
        costs.back() = many[3];  // opened in any case
    }
}

// How many children the first of the two below becomes; 0: it is a child itself.
std::uint32_t BestChildren::share_of_first(const Opened& opened) const {
    const float cost = costs_[opened.node][kOne - 1 + opened.most];
    return std::bit_cast<std::uint32_t>(cost) & static_cast<std::uint32_t>(kShareBits);
}

WideChildren BestChildren::of(std::uint32_t root) const {
    WideChildren children;
    std::array<Opened, kWidth> todo;
    std::size_t waiting = 0;
    todo[waiting++] = {root, kWidth};
    while (waiting > 0) {
        const Opened at = todo[--waiting];
        const std::uint32_t share = nodes_[at.node].is_leaf() ? 0 : share_of_first(at);
        if (share == 0) {
            children.node[children.count++] = at.node;
            continue;
        }
        const std::uint32_t first = nodes_[at.node].first;
        todo[waiting++] = {first + 1, at.most - share};
        todo[waiting++] = {first, share};
    }
    return children;
}

}  // namespace raypick
