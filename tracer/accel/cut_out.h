// Surfaces with holes: where a material's opacity leaves nothing, there is nothing to hit.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/scene/scene.h"

namespace raypick {

// Whether any primitive of the object may have holes; if not, is_cut_out is false for all its hits.
bool may_be_cut_out(const Scene& scene, const Object& object);

// Whether the surface is not there: its opacity is below the material's alpha_cutoff (cut_out), or
// too low to be seen in eight bits (blend).
bool is_cut_out(const Scene& scene, const Object& object, const Hit& hit);

}  // namespace raypick
