// Rays that have nothing in common, a step of each in turn: while one waits for memory the others
// go on. Included once for each instruction set.
#if defined(RAYPICK_INTERLEAVED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_INTERLEAVED_INL_H
#undef RAYPICK_INTERLEAVED_INL_H
#else
#define RAYPICK_INTERLEAVED_INL_H
#endif

#include "tracer/accel/simd/ray_group-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// A ray on its way through the objects of a scene: what walk() does within the top tree and within
// a mesh's, to be stopped after every step.
template <typename Search>
class Traversal {
public:
    // Through all finite objects.
    void start(const AccelState& state, const Ray& ray, const RayQuery& query,
               const Search& search) {
        set_ray(state, ray, query, search);
        if (!state.top.empty()) stack_.push(ray_.t_min, state.top.root.bits);
    }

    // Through a mesh or a part of it.
    void start_in(const AccelState& state, const TopEntry& entry, const Ray& ray,
                  const RayQuery& query, const Search& search) {
        set_ray(state, ray, query, search);
        enter(entry);
    }

    // False if there is no way left.
    bool step() {
        while (true) {
            if (stack_.count == base_) {
                if (tree_ == nullptr) return false;
                leave();
                continue;
            }
            --stack_.count;
            if (stack_.enter[stack_.count] <= search_->limit()) break;
        }
        const WideRef at{stack_.ref[stack_.count]};
        const bool stop = tree_ != nullptr ? step_in_mesh(at) : step_in_top(at);
        if (!stop) fetch_next();
        return !stop;
    }

    [[nodiscard]] const Search& search() const { return *search_; }

private:
    void set_ray(const AccelState& state, const Ray& ray, const RayQuery& query,
                 const Search& search) {
        state_ = &state;
        ray_ = ray;
        if (ray_.t_min < 0.0f) ray_.t_min = 0.0f;  // what lies behind is not on it
        query_ = &query;
        search_.emplace(search);
        world_.emplace(ray_, state.reach);
        space_ = &*world_;
        tree_ = nullptr;
        stack_.count = 0;
        base_ = 0;
    }

    bool step_in_top(const WideRef& at) {
        if (!at.is_leaf()) {
            world_->slabs().push_met(state_->top.nodes[at.index()], ray_.t_min, search_->limit(),
                                     stack_);
            return false;
        }
        const std::uint32_t index = state_->top.indices[at.index()];
        if ((index & WideBvh::kLast) != 0) return enter(state_->entries[index & ~WideBvh::kLast]);
        return each_index(state_->top, at, [&](std::uint32_t entry) HWY_ATTR {
            return trace_entry(*state_, state_->entries[entry], ray_, *world_, *query_, *search_);
        });
    }

    bool enter(const TopEntry& entry) {
        const Instance& instance = state_->instances[entry.object];
        if (!instance.joined()) {
            const Object& object = state_->scene->objects[entry.object];
            if ((object.mask & query_->mask) == 0) return false;
            if (!std::holds_alternative<MeshInstance>(object.shape)) {
                return trace_entry(*state_, entry, ray_, *world_, *query_, *search_);
            }
            passage_.emplace(Passage{*state_->scene, object, instance, ray_, *query_,
                                     object_ray(instance, ray_)});
            if (!instance.identity) {
                local_.emplace(passage_->local, instance);
                space_ = &*local_;
            }
        }
        instance_ = &instance;
        tree_ = instance.tree;
        base_ = stack_.count;
        stack_.push(ray_.t_min, entry.part.bits);
        return false;
    }

    void leave() {
        tree_ = nullptr;
        base_ = 0;
        space_ = &*world_;
    }

    bool step_in_mesh(const WideRef& at) {
        if (at.is_leaf()) {
            if (instance_->joined()) {
                return trace_joined_leaf(*state_, *instance_, at, ray_, *world_, *query_, *search_);
            }
            return ShapeTrace<Search>{*passage_, space_, {}, *search_}.triangles_of(at);
        }
        space_->slabs().push_met(tree_->bvh.nodes[at.index()], ray_.t_min, search_->limit(),
                                 stack_);
        return false;
    }

    HWY_INLINE void fetch_next() const {
        if (stack_.count == base_) return;
        const WideRef next{stack_.ref[stack_.count - 1]};
        const void* place = nullptr;
        if (tree_ == nullptr) {
            if (next.is_leaf()) return;
            place = &state_->top.nodes[next.index()];
        } else if (next.is_leaf()) {
            place = &tree_->patches.blocks[next.index()];
        } else {
            place = &tree_->bvh.nodes[next.index()];
        }
        const auto* line = static_cast<const std::byte*>(place);
        for (std::size_t i = 0; i < 4; ++i)
            __builtin_prefetch(line + 64 * i);
    }

    const AccelState* state_ = nullptr;
    Ray ray_;
    const RayQuery* query_ = nullptr;
    std::optional<Search> search_;
    std::optional<RayInSpace> world_;
    std::optional<RayInSpace> local_;
    std::optional<Passage> passage_;  // not through the joined tree, where each leaf has its own
    RayInSpace* space_ = nullptr;
    const Instance* instance_ = nullptr;
    const PrimitiveTree* tree_ = nullptr;  // of the mesh that it is in
    std::size_t base_ = 0;                 // what waits below is of the top tree
    WaitingBoxes stack_;
};

// Puts rays on their way with begin(traversal), which returns false if there are no more, and gives
// each to end(traversal, slot) when it is done.
template <typename Search, std::size_t kAtOnce, typename Begin, typename End>
void run_interleaved(const Begin& begin, const End& end) {
    Traversal<Search> traversals[kAtOnce];  // NOLINT: large, and set by begin()
    std::array<std::size_t, kAtOnce> ray{};
    std::array<std::size_t, kAtOnce> slots{};
    std::size_t active = 0;
    for (; active < kAtOnce && begin(traversals[active], ray[active]); ++active)
        slots[active] = active;
    while (active > 0) {
        for (std::size_t i = 0; i < active;) {
            const std::size_t slot = slots[i];
            if (traversals[slot].step()) {
                ++i;
                continue;
            }
            end(traversals[slot], ray[slot]);
            if (begin(traversals[slot], ray[slot])) {
                ++i;
            } else {
                slots[i] = slots[--active];
            }
        }
    }
}

// So many rays hide what each of them waits for.
inline constexpr std::size_t kInterleaved = 6;

// Takes the lowest ray out of the mask.
inline std::size_t take_ray(RayMask& mask) {
    const auto ray = static_cast<std::size_t>(std::countr_zero(mask));
    mask &= mask - 1;
    return ray;
}

template <typename Search>
void trace_unbounded(const AccelState& state, const Ray& any_ray, const RayQuery& query,
                     Search& search) {
    if (state.unbounded.empty()) return;
    const Ray ray = from_origin(any_ray);
    for (const std::uint32_t object : state.unbounded) {
        if (trace_simple(state, object, ray, query, search)) return;
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
