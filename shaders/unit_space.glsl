// A shape in the space of viewer/raster/unit_shapes.h, which is this program's object space.
uniform vec3 unit_eye;  // the eye, from double precision

// The ray, of which t still is the scene's.
struct UnitRay {
    vec3 origin;
    vec3 direction;
};

UnitRay unit_ray(Ray ray) {
    return UnitRay(unit_eye + object_vector(ray.origin), object_vector(ray.direction));
}
