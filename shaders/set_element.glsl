// The element of a set that a fragment may show.
#include "set_arrays.glsl"

uniform usamplerBuffer element_materials;  // if has_materials
uniform bool has_materials;
uniform int first_primitive;  // of this draw, which may be a part of the set

flat in int element;

uint element_material() {
    return has_materials ? texelFetch(element_materials, element).r : kNoMaterial;
}
