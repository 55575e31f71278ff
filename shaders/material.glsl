// material.glsl: the uniforms and maps of a pass become a Material. Compiles only what the pass asks for.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL

#include "features.glsl"
#include "brdf.glsl"
#include "color.glsl"

// SHADERed gives the k-th texture of a pass to the k-th declaration of this form that it finds in the text, even where an
// #if hides it. So the declarations are numbered and each map takes the next number. Bind a pass's textures in the order
// albedo, roughness, metalness, normal, leaving out those that it does not have.
#if MAP_COUNT > 0
uniform sampler2D map_1;
#endif
#if MAP_COUNT > 1
uniform sampler2D map_2;
#endif
#if MAP_COUNT > 2
uniform sampler2D map_3;
#endif
#if MAP_COUNT > 3
uniform sampler2D map_4;
#endif

#define ALBEDO_MAP map_1

#if HAS_ALBEDO_MAP == 0
#define ROUGHNESS_MAP map_1
#else
#define ROUGHNESS_MAP map_2
#endif

#if HAS_ALBEDO_MAP + HAS_ROUGHNESS_MAP == 0
#define METALNESS_MAP map_1
#elif HAS_ALBEDO_MAP + HAS_ROUGHNESS_MAP == 1
#define METALNESS_MAP map_2
#else
#define METALNESS_MAP map_3
#endif

#if MAP_COUNT == 1
#define NORMAL_MAP map_1
#elif MAP_COUNT == 2
#define NORMAL_MAP map_2
#elif MAP_COUNT == 3
#define NORMAL_MAP map_3
#else
#define NORMAL_MAP map_4
#endif

#if !HAS_ALBEDO_MAP
uniform vec3 albedo; // linear
#endif
#if !HAS_ROUGHNESS_MAP
uniform float roughness;
#endif
#if !HAS_METALNESS_MAP && !defined(METALNESS)
uniform float metalness;
#endif

// The material at texture coordinates uv; a pass without maps does not look at them.
Material material_at(vec2 uv)
{
    Material m;
#if HAS_ALBEDO_MAP
    m.albedo = srgb_to_linear(texture(ALBEDO_MAP, uv).rgb);
#else
    m.albedo = albedo;
#endif
#if HAS_ROUGHNESS_MAP
    m.roughness = texture(ROUGHNESS_MAP, uv).r;
#else
    m.roughness = roughness;
#endif
#if defined(METALNESS)
    m.metalness = float(METALNESS);
#elif HAS_METALNESS_MAP
    m.metalness = texture(METALNESS_MAP, uv).r;
#else
    m.metalness = metalness;
#endif
    return m;
}

#endif
