#version 330
// backdrop.frag: a vertical gradient of light, so that dark metal has an outline.
#ifdef GL_GOOGLE_include_directive
#extension GL_GOOGLE_include_directive : enable
#endif

#include "color.glsl"

in float height;

uniform vec3 top_radiance;    // linear
uniform vec3 bottom_radiance; // linear

layout(location = 0) out vec4 color;

void main()
{
    color = vec4(linear_to_srgb(tone_map(mix(bottom_radiance, top_radiance, smoothstep(0.0, 1.0, height)))), 1.0);
}
