// Distances to solids, negative inside.
#include "common/math.glsl"

struct Capsule {
    vec3 a, b;
    float radius;
};

// A box around the origin, from -half_size to half_size.
float box(vec3 p, vec3 half_size) {
    vec3 q = abs(p) - half_size;
    return length(max(q, 0.0)) + min(max3(q), 0.0);
}

float capsule(vec3 p, Capsule c) {
    vec3 along = c.b - c.a;
    float h = saturate(dot(p - c.a, along) / dot(along, along));
    return length(p - c.a - h * along) - c.radius;
}

// min(a, b) with its corner rounded over a width of k > 0.
float smooth_min(float a, float b, float k) {
    float h = max(k - abs(a - b), 0.0) / k;
    return min(a, b) - h * h * k * 0.25;
}

// The direction in which the distance to a box grows most, from four samples at the corners of a tetrahedron.
vec3 box_normal(vec3 p, vec3 half_size) {
    const vec2 e = vec2(1.0, -1.0);
    const float step = 1.0 / 1024.0;
    return normalize(e.xyy * box(p + e.xyy * step, half_size) + e.yyx * box(p + e.yyx * step, half_size) +
                     e.yxy * box(p + e.yxy * step, half_size) + e.xxx * box(p + e.xxx * step, half_size));
}
