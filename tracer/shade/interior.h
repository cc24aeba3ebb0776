// Which bodies of glass a ray is inside of.
//
// Source: Schmidt, Budge, "Simple Nested Dielectrics in Ray Traced Images", 2002.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace raypick {

// The closed surface that a hit belongs to: an object, or one element of a set.
struct Body {
    ObjectId object = kNoObject;
    std::uint32_t element = 0;

    friend bool operator==(const Body&, const Body&) = default;
};
Body body_of(const Object& object, const Hit& hit);

// True if the material fills a body: rays that enter it are inside of something until they leave.
// So does a material of index 1, a bubble of air in glass.
bool fills(const Material& material);

// The bodies around a point of a ray's path, in the order in which they were entered.
class Interior {
public:
    Interior() = default;
    ~Interior() = default;
    Interior(const Interior& other) { *this = other; }
    // Only what is there: mostly one or none.
    Interior& operator=(const Interior& other) {
        count_ = other.count_;
        for (std::size_t i = 0; i < count_; ++i)
            entries_[i] = other.entries_[i];
        return *this;
    }

    // What is there: the material of the highest priority, of those the one entered last;
    // kNoMaterial is air.
    [[nodiscard]] MaterialId medium(const Scene& scene) const;
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] bool holds(const Body& body) const;

    // Nine bodies deep the oldest one is forgotten.
    void enter(const Body& body, MaterialId material);
    void leave(const Body& body);
    // As if the ray had begun inside.
    void begin_inside(const Body& body, MaterialId material);

private:
    static constexpr std::size_t kMost = 8;
    struct Entry {
        Body body;
        MaterialId material = kNoMaterial;
    };

    std::array<Entry, kMost> entries_{};
    std::size_t count_ = 0;
};

// What a ray does at the surface of a body that a material fills.
struct Crossing {
    Interior before;
    Interior after;
    MaterialId from = kNoMaterial;
    MaterialId to = kNoMaterial;
};

// False where the surface lies inside of something of higher priority or of its own kind, glass in
// the same glass. One of index 1 that absorbs nothing stays in its own kind: it may as well be a
// row of open sheets, which are never left.
bool is_there(const Scene& scene, const Crossing& crossing, MaterialId surface);

// A ray that leaves a body which it never entered began inside of it (its origin was there, or in
// an open mesh). One that enters a body twice had left it through a hole. `interior`: before, none
// of the crossing's own.
void cross_surface(const Scene& scene, const Interior& interior, const Body& body,
                   MaterialId material, bool front_face, Crossing& crossing);

}  // namespace raypick
