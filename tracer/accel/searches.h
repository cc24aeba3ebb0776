// What a traversal looks for. limit() is how far it must look (inclusive), offer() takes an
// admitted hit and returns true to stop.
#pragma once

#include "tracer/accel/hit.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace raypick {

// False for searches that look at no more of a hit than its t.
template <typename Search>
inline constexpr bool kKeepsHits = true;

inline float tie_limit(float t) {
    return static_cast<float>(t * (1.0 + kTieGap));
}

inline bool precedes(const Hit& a, const Hit& b) {
    return std::tie(a.object, a.primitive) < std::tie(b.object, b.primitive);
}

// The closest t, and among the hits that tie with it the lowest (object, primitive). A tie's window
// moves when a closer hit turns up; `ambiguous` says that a hit was dropped that the final window
// might have held, and that LowestInWindow must decide.
class ClosestSearch {
public:
    explicit ClosestSearch(float t_max) : limit_(t_max) {}

    [[nodiscard]] float limit() const { return limit_; }
    bool offer(const Hit& hit) {
        if (hit.t < closest_) {
            closest_ = hit.t;
            limit_ = std::min(limit_, tie_limit(closest_));
        }
        if (!winner_.valid()) {
            winner_ = hit;
        } else if (winner_.t > limit_) {
            ambiguous_ = ambiguous_ || dropped_;
            winner_ = hit;
        } else {
            dropped_ = true;
            if (precedes(hit, winner_)) winner_ = hit;
        }
        return false;
    }

    [[nodiscard]] const Hit& winner() const { return winner_; }
    [[nodiscard]] bool ambiguous() const { return ambiguous_; }

private:
    float limit_;
    float closest_ = std::numeric_limits<float>::infinity();
    Hit winner_;
    bool dropped_ = false;
    bool ambiguous_ = false;
};

class LowestInWindow {
public:
    explicit LowestInWindow(float limit) : limit_(limit) {}

    [[nodiscard]] float limit() const { return limit_; }
    bool offer(const Hit& hit) {
        if (!winner_.valid() || precedes(hit, winner_)) winner_ = hit;
        return false;
    }
    [[nodiscard]] const Hit& winner() const { return winner_; }

private:
    float limit_;
    Hit winner_;
};

class AnySearch {
public:
    explicit AnySearch(float t_max) : limit_(t_max) {}

    [[nodiscard]] float limit() const { return limit_; }
    bool offer(const Hit&) {
        found_ = true;
        return true;
    }
    [[nodiscard]] bool found() const { return found_; }

private:
    float limit_;
    bool found_ = false;
};

template <>
inline constexpr bool kKeepsHits<AnySearch> = false;

class AllSearch {
public:
    explicit AllSearch(float t_max) : limit_(t_max) {}

    [[nodiscard]] float limit() const { return limit_; }
    bool offer(const Hit& hit) {
        hits_.push_back(hit);
        return false;
    }
    [[nodiscard]] std::vector<Hit> sorted() && {
        std::sort(hits_.begin(), hits_.end(), [](const Hit& a, const Hit& b) {
            return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
        });
        return std::move(hits_);
    }

private:
    float limit_;
    std::vector<Hit> hits_;
};

}  // namespace raypick
