// Draws the objects of a scene with the programs of the first two passes.
#pragma once

#include "viewer/raster/seen_objects.h"
#include "viewer/raster/shader_set.h"
#include "viewer/raster/view_numbers.h"

#include <span>

namespace raypick {

// Binds `texture` to the unit that our programs read it from.
void bind(Unit unit, GLenum target, GLuint texture);

// In this order; the scene has `material_count` materials. The objects' index runs are in the
// element array buffer. Framebuffer, depth and stencil state are
// the caller's; face culling must be off, front faces culled where it is on, and is off afterwards.
void draw_objects(ShaderSet& shaders, Pass pass, const ViewNumbers& view,
                  std::span<const SeenObject> objects, int material_count);

}  // namespace raypick
