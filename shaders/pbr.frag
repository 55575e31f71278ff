#version 330
// pbr.frag: the colour of a surface under three directional lights.
#ifdef GL_GOOGLE_include_directive
#extension GL_GOOGLE_include_directive : enable
#endif

#include "material.glsl"
#include "normal_map.glsl"

in vec3 world_position;
in vec3 world_normal;
#if MAP_COUNT > 0
in vec2 uv;
#endif
#if HAS_NORMAL_MAP
in vec3 world_tangent;
#endif
#if HAS_NORMAL_MAP && HAS_MIRRORED_UV
in float handedness;
#endif

uniform vec3 camera_position;

// A directional light: the direction toward it, of any length, and its linear irradiance on a surface that faces it.
uniform vec3 key_direction;
uniform vec3 key_irradiance;
uniform vec3 fill_direction;
uniform vec3 fill_irradiance;
uniform vec3 rim_direction;
uniform vec3 rim_irradiance;

layout(location = 0) out vec4 color;

void main()
{
    vec3 n = normalize(world_normal);
#if HAS_NORMAL_MAP && HAS_MIRRORED_UV
    n = perturb_normal_mirrored(n, world_tangent, handedness, texture(NORMAL_MAP, uv).xyz);
#elif HAS_NORMAL_MAP
    n = perturb_normal(n, world_tangent, texture(NORMAL_MAP, uv).xyz);
#endif
#if MAP_COUNT > 0
    Material m = material_at(uv);
#else
    Material m = material_at(vec2(0.0));
#endif
    vec3 v = normalize(camera_position - world_position);

    vec3 radiance = key_irradiance * shade(normalize(key_direction), v, n, m);
    radiance += fill_irradiance * shade(normalize(fill_direction), v, n, m);
    radiance += rim_irradiance * shade(normalize(rim_direction), v, n, m);
    color = vec4(linear_to_srgb(tone_map(radiance)), 1.0);
}
