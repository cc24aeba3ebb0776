// A wide tree as a binary one, for what is to be said of both.
#pragma once

#include "tracer/bvh/wide_bvh.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace raypick {

class BinaryForm {
public:
    static Bvh of(const WideBvh& wide) {
        BinaryForm form(wide);
        if (!wide.empty()) {
            form.binary_.nodes.resize(1);
            form.place(form.whole(wide.root, wide.bounds), 0);
        }
        return std::move(form.binary_);
    }

private:
    // A subtree to be, or two joined.
    struct Part {
        Bounds bounds;
        WideRef ref;
        std::size_t leaves = 1;
        std::vector<Part> two;
    };

    explicit BinaryForm(const WideBvh& wide) : wide_(wide) {
        for (const std::uint32_t index : wide.indices)
            binary_.indices.push_back(index & ~WideBvh::kLast);
    }

    // Joins a node's children, neighbours first.
    [[nodiscard]] Part whole(const WideRef& ref, const Bounds& bounds) const {
        if (ref.is_leaf()) return {bounds, ref, 1, {}};
        std::vector<Part> parts;
        const WideNode& node = wide_.nodes.at(ref.index());
        for (std::uint32_t i = 0; i < kWidth; ++i) {
            if (node.child[i] != WideRef::kNothing) {
                parts.push_back(whole(node.ref(i), node.box(i)));
            }
        }
        while (parts.size() > 2)
            join_neighbours(parts);
        std::size_t leaves = 0;
        for (const Part& part : parts)
            leaves += part.leaves;
        return {bounds, {}, leaves, std::move(parts)};
    }

    // Of two neighbours whose box is the smallest those with the fewest leaves.
    static void join_neighbours(std::vector<Part>& parts) {
        std::size_t best = 0;
        std::pair<float, std::size_t> least{std::numeric_limits<float>::infinity(),
                                            ~std::size_t{0}};
        for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
            Bounds both = parts[i].bounds;
            both.extend(parts[i + 1].bounds);
            const std::pair<float, std::size_t> cost{both.half_area(),
                                                     parts[i].leaves + parts[i + 1].leaves};
            if (cost < least) {
                least = cost;
                best = i;
            }
        }
        Part joined;
        joined.bounds = parts[best].bounds;
        joined.bounds.extend(parts[best + 1].bounds);
        joined.leaves = least.second;
        joined.two.push_back(std::move(parts[best]));
        joined.two.push_back(std::move(parts[best + 1]));
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(best));
        parts[best] = std::move(joined);
    }

    void place(const Part& part, std::size_t node) {
        if (part.two.empty()) {
            const auto count = static_cast<std::uint32_t>(indices_of(wide_, part.ref).size());
            binary_.nodes[node] = {part.bounds, part.ref.index(), count};
            return;
        }
        const auto child = static_cast<std::uint32_t>(binary_.nodes.size());
        binary_.nodes[node] = {part.bounds, child, 0};
        binary_.nodes.resize(child + std::size_t{2});
        place(part.two[0], child);
        place(part.two[1], child + std::size_t{1});
    }

    const WideBvh& wide_;
    Bvh binary_;
};

}  // namespace raypick
