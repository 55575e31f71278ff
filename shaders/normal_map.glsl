// normal_map.glsl: from a texel of a normal map to a world-space normal. Pure functions.
//
// NORMAL_MAP_DX 1 reads maps labelled DX, whose green points down the image; 0 reads GL.
#ifndef NORMAL_MAP_GLSL
#define NORMAL_MAP_GLSL

#ifndef NORMAL_MAP_DX
#define NORMAL_MAP_DX 0
#endif

// Tangent-space normal of a texel, 0...1 a channel; not normalised.
// The byte 128 stands for 0: the usual 2c - 1 makes 1/255 of it, so that a flat map would tilt the surface by 0.0055 rad,
// enough to dim a highlight of roughness 0.045 seventy-fold.
vec3 decode_normal(vec3 texel)
{
    vec3 normal = (texel * 255.0 - 128.0) / 127.0;
#if NORMAL_MAP_DX
    normal.y = -normal.y;
#endif
    // A normal map cannot turn a surface inside out: at least the smallest step of a byte points outward.
    normal.z = max(normal.z, 1.0 / 127.0);
    return normal;
}

// The unit normal n bent by a texel. t is the tangent, the direction of growing u on the surface, of any length and not
// quite perpendicular to n (as interpolation leaves it). handedness is +1, or -1 where the texture is mirrored: there the
// bitangent is -cross(n, t). A zero tangent (a model without any) gives n itself.
vec3 perturb_normal_mirrored(vec3 n, vec3 t, float handedness, vec3 texel)
{
    vec3 map = decode_normal(texel);
    vec3 tangent = t - n * dot(n, t);
    tangent *= inversesqrt(max(dot(tangent, tangent), 1e-30)); // 0 stays 0, where normalize() makes NaN
    vec3 bitangent = cross(n, tangent) * handedness;
    return normalize(mat3(tangent, bitangent, n) * map);
}

// The same for textures that are not mirrored.
vec3 perturb_normal(vec3 n, vec3 t, vec3 texel)
{
    return perturb_normal_mirrored(n, t, 1.0, texel);
}

#endif
