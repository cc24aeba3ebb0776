// A truncated cone from the base at 0 along +y, exactly.
uniform float cone_length;
uniform float cone_base_radius;
uniform float cone_apex_radius;
uniform bool cone_capped;

Surface closest_surface(Ray ray) {
    UnitRay local = unit_ray(ray);
    ConeBody cone;
    cone.axis = vec3(0.0, 1.0, 0.0);
    cone.length = cone_length;
    cone.base_radius = cone_base_radius;
    cone.apex_radius = cone_apex_radius;
    cone.capped = cone_capped;
#ifdef TEXTURED
    cone.x = vec3(1.0, 0.0, 0.0);
#endif
    return closest_on_cone(ray, local.origin, local.direction, cone, 1.0, -1, kNoMaterial);
}
