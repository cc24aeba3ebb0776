// What a ray query returns and what it can be asked to leave out.
#pragma once

#include "tracer/scene/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace raypick {

// The first thing a ray meets. Ids, never pointers: it copies, serialises and survives edits.
struct Hit {
    ObjectId object = kNoObject;
    std::uint32_t primitive = 0;
    float t = std::numeric_limits<float>::infinity();
    glm::vec2 uv{0.0f};       // see ShapeHit
    bool front_face = false;  // the ray meets the side that the outward normal points to

    [[nodiscard]] bool valid() const { return object != kNoObject; }

    friend bool operator==(const Hit&, const Hit&) = default;
};

// Two surfaces at distances within this relative gap tie: the lowest (object, primitive) wins.
inline constexpr double kTieGap = 2e-6;

// Keeps the half space dot(normal, p) + d >= 0 (scene space).
struct ClipPlane {
    glm::vec3 normal{0.0f, 1.0f, 0.0f};
    float d = 0.0f;
};

// A reference to any callable bool(const Hit&); it must outlive the query. Called from the thread
// that traces, possibly for hits that are not the closest.
class AcceptHit {
public:
    AcceptHit() = default;
    template <typename F>
    // A reference, like a span. NOLINTNEXTLINE(google-explicit-constructor)
    requires(!std::is_same_v<std::remove_cvref_t<F>, AcceptHit>) AcceptHit(const F& callable)
        : context_(&callable), call_([](const void* context, const Hit& hit) -> bool {
              return (*static_cast<const F*>(context))(hit);
          }) {}

    bool operator()(const Hit& hit) const { return call_ == nullptr || call_(context_, hit); }
    explicit operator bool() const { return call_ != nullptr; }

private:
    const void* context_ = nullptr;
    bool (*call_)(const void*, const Hit&) = nullptr;
};

// What every query takes. The defaults leave nothing out.
struct RayQuery {
    std::uint32_t mask = 0xffffffffu;
    Sides sides = Sides::both;  // on top of the objects' own
    std::span<const ClipPlane> clip_planes;
    AcceptHit accept;
    // False: nobody looks at the uv of what is hit, and of other shapes than triangles, where it
    // takes arc tangents, it may be left 0.
    bool uv = true;
};

}  // namespace raypick
