#version 330
// entry.frag: functions beside an entry point that has inputs, outputs and qualifiers of every kind.
layout(origin_upper_left) in vec4 gl_FragCoord;
in vec3 world_normal;
flat in int id;
centroid in vec2 uv;
noperspective in float depth;
in Surface {
    vec3 position;
    vec3 tangent;
} surface;

uniform float gain;
uniform sampler2D map;

layout(location = 0) out vec4 color;
layout(location = 1) out vec4 brightness;

float twice(float x)
{
    return 2.0 * x;
}

float gained(float x)
{
    return gain * x;
}

vec4 looked_up(vec2 at)
{
    return texture(map, at);
}

void main()
{
    color = vec4(twice(world_normal.x) + surface.position.x + depth) * looked_up(uv) + gl_FragCoord * float(id);
    brightness = vec4(gained(color.x));
}
