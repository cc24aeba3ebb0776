#include "tracer/shade/ray_counts.h"

namespace raypick {

RayCounts& RayCounts::operator+=(const RayCounts& other) {
    eye += other.eye;
    eye_hits += other.eye_hits;
    reflection += other.reflection;
    refraction += other.refraction;
    shadow += other.shadow;
    shadow_blocked += other.shadow_blocked;
    for (std::size_t i = 0; i < reflection_at.size(); ++i) {
        reflection_at[i] += other.reflection_at[i];
        refraction_at[i] += other.refraction_at[i];
        shadow_at[i] += other.shadow_at[i];
    }
    return *this;
}

}  // namespace raypick
