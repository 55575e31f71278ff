// Unit vectors, colours and halves in fewer bits.
#include "common/math.glsl"

// A unit vector as a point of [-1, 1]^2: the octahedron |x| + |y| + |z| = 1, its lower half folded outward.
vec2 to_octahedral(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * SIGN_NOT_ZERO(p);
}

vec3 from_octahedral(vec2 p) {
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0)
        n.xy = (1.0 - abs(n.yx)) * SIGN_NOT_ZERO(n.xy);
    return normalize(n);
}

// x in the lowest byte.
uint pack_unorm8(vec4 v) {
    uvec4 b = uvec4(floor(saturate(v) * 255.0 + 0.5));
    return b.x | b.y << 8 | b.z << 16 | b.w << 24;
}

vec4 unpack_unorm8(uint word) {
    return vec4(word & 255u, word >> 8 & 255u, word >> 16 & 255u, word >> 24) / 255.0;
}

// The bits of the nearest half, ties to even; a magnitude beyond 65504 becomes infinity as IEEE 754 has it.
uint to_half(float x) {
    uint bits = floatBitsToUint(x);
    uint sign = bits >> 16 & 0x8000u;
    uint magnitude = bits & 0x7FFFFFFFu;
    if (magnitude > 0x7F800000u)
        return sign | 0x7E00u;
    if (magnitude >= 0x47800000u)
        return sign | 0x7C00u;
    if (magnitude < 0x33000000u)
        return sign;
    uint exponent = magnitude >> 23;
    uint mantissa = magnitude & 0x7FFFFFu;
    uint dropped = 13u;
    uint kept = magnitude - 0x38000000u;
    if (exponent < 113u) { // too small for a normal half
        dropped = 126u - exponent;
        kept = mantissa | 0x800000u;
    }
    uint half_way = 1u << (dropped - 1u);
    uint rest = kept & ((1u << dropped) - 1u);
    kept >>= dropped;
    if (rest > half_way || (rest == half_way && (kept & 1u) == 1u))
        kept += 1u;
    return sign | kept;
}

float from_half(uint h) {
    float sign = (h & 0x8000u) != 0u ? -1.0 : 1.0;
    uint exponent = h >> 10 & 31u;
    float mantissa = float(h & 1023u);
    if (exponent == 0u)
        return sign * mantissa / 16777216.0;
    if (exponent == 31u)
        return uintBitsToFloat((h & 0x8000u) << 16 | 0x7F800000u | (h & 1023u) << 13);
    return sign * (1.0 + mantissa / 1024.0) * exp2(float(exponent) - 15.0);
}

// Three bytes under one exponent, that of the largest.
uvec4 to_rgbe(vec3 color) {
    float largest = max3(color);
    if (largest < 1e-32)
        return uvec4(0u);
    int exponent = int(floatBitsToUint(largest) >> 23) - 126;
    return uvec4(uvec3(color * exp2(float(8 - exponent))), uint(exponent + 128));
}

vec3 from_rgbe(uvec4 e) {
    return e.w == 0u ? vec3(0.0) : (vec3(e.xyz) + 0.5) * exp2(float(int(e.w) - 136));
}
