// Triangles: t and barycentrics from the triangle's own corners, so that depth does not depend on
// what the rasteriser interpolates. Which pixels are covered is the rasteriser's business: a ray
// that passes by the edge by less than its resolution gets the edge's t.
//
// Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
#include "mesh_arrays.glsl"

uniform samplerBuffer normals;  // object space, if has_normals
uniform bool has_normals;
uniform int first_primitive;  // of this draw, which may be a part of the mesh

flat in int triangle_index;  // within this draw

// Axes turned so that z is the one along which the ray runs fastest.
vec3 turned(vec3 v, int fastest) {
    return fastest == 0 ? v.yzx : fastest == 1 ? v.zxy : v;
}

// Barycentric weights of the point where the ray meets the triangle's plane, moved onto the
// triangle; 0, and so is t, if the triangle is seen edge-on.
vec3 weights(vec3 a, vec3 b, vec3 c, vec2 slope) {
    vec2 pa = a.xy - slope * a.z;
    vec2 pb = b.xy - slope * b.z;
    vec2 pc = c.xy - slope * c.z;
    vec3 w = vec3(pc.x * pb.y - pc.y * pb.x, pa.x * pc.y - pa.y * pc.x,
                  pb.x * pa.y - pb.y * pa.x);
    if (w.x + w.y + w.z < 0.0) w = -w;
    w = max(w, 0.0);
    float sum = w.x + w.y + w.z;
    return sum > 0.0 ? w / sum : vec3(0.0);
}

#ifdef TEXTURED
uniform samplerBuffer uvs;  // if has_uvs
uniform bool has_uvs;

// The mesh's own uv, interpolated, and what the triangle's corners say of its derivatives.
void set_mesh_frame(inout Surface s, uvec3 corner, vec3 w, vec3 ab, vec3 ac) {
    if (!has_uvs) return;
    vec2 a = texelFetch(uvs, int(corner.x)).xy;
    vec2 b = texelFetch(uvs, int(corner.y)).xy;
    vec2 c = texelFetch(uvs, int(corner.z)).xy;
    s.uv = w.x * a + w.y * b + w.z * c;
    vec2 to_b = b - a;
    vec2 to_c = c - a;
    float area = to_b.x * to_c.y - to_b.y * to_c.x;
    if (area == 0.0) return;
    set_texture_frame(s, s.uv, (to_c.y * ab - to_b.y * ac) / area,
                      (to_b.x * ac - to_c.x * ab) / area);
}
#endif

Surface closest_surface(Ray ray) {
    uvec4 triangle = texelFetch(triangles, triangle_index);
    vec3 o = object_vector(ray.origin);
    vec3 a = from_eye(triangle.x) - o;
    vec3 b = from_eye(triangle.y) - o;
    vec3 c = from_eye(triangle.z) - o;
    vec3 d = object_vector(ray.direction);
    vec3 speed = abs(d);
    int fastest = speed.x > speed.y ? (speed.x > speed.z ? 0 : 2) : (speed.y > speed.z ? 1 : 2);
    vec3 td = turned(d, fastest);
    vec3 ta = turned(a, fastest);
    vec3 tb = turned(b, fastest);
    vec3 tc = turned(c, fastest);
    vec3 w = weights(ta, tb, tc, td.xy / td.z);

    Surface s = no_surface();
    s.t = dot(w, vec3(ta.z, tb.z, tc.z)) / td.z;
    if (!(s.t > ray.t_min)) return no_surface();
    vec3 ab = b - a;
    vec3 ac = c - a;
    float scale = max(largest(ab), largest(ac));
    vec3 face = cross(ab / scale, ac / scale);
    s.geometric = scene_normal(face);
    s.shading = s.geometric;
    s.front = dot(face, d) < 0.0;
    if (has_normals) {
        vec3 n = w.x * texelFetch(normals, int(triangle.x)).xyz +
                 w.y * texelFetch(normals, int(triangle.y)).xyz +
                 w.z * texelFetch(normals, int(triangle.z)).xyz;
        if (dot(n, face) < 0.0) n = -n;  // as tracer/accel/surface.cpp
        if (dot(n, n) > 1e-12) s.shading = scene_normal(n);
    }
    s.primitive = uint(first_primitive + triangle_index);
    s.material = triangle.w;
#ifdef TEXTURED
    set_mesh_frame(s, triangle.xyz, w, ab, ac);
#endif
    if (is_there(s)) return s;
    return no_surface();
}
