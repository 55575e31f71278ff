// What the other files share.
#ifndef COMMON_MATH
#define COMMON_MATH

#define saturate(x) clamp((x), 0.0, 1.0)
#define SIGN_NOT_ZERO(v) vec2((v).x >= 0.0 ? 1.0 : -1.0, (v).y >= 0.0 ? 1.0 : -1.0)

float max3(vec3 v) {
    return max(v.x, max(v.y, v.z));
}

float min3(vec3 v) {
    return min(v.x, min(v.y, v.z));
}

#endif
