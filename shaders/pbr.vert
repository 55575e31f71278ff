#version 330
// pbr.vert: takes a mesh to the screen and its surface to world space; carries on only what the pass needs.
#ifdef GL_GOOGLE_include_directive
#extension GL_GOOGLE_include_directive : enable
#endif

#include "features.glsl"

// The pass's input layout: Position, Normal, then as far as needed Texcoord, Tangent, Bitangent.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 view_projection;
uniform mat4 model;
uniform mat4 model_inverse;

out vec3 world_position;
out vec3 world_normal;

#if MAP_COUNT > 0
layout(location = 2) in vec2 texcoord;
out vec2 uv;
#endif
#if HAS_NORMAL_MAP
layout(location = 3) in vec3 tangent;
out vec3 world_tangent;
#endif
#if HAS_NORMAL_MAP && HAS_MIRRORED_UV
layout(location = 4) in vec3 bitangent;
out float handedness;
#endif

void main()
{
    vec4 world = model * vec4(position, 1.0);
    world_position = world.xyz;
    // A normal times the inverse from the left is the inverse transpose times the normal: perpendicular to the surface
    // under any scale. Tangents lie in the surface and move with it.
    world_normal = normal * mat3(model_inverse);
#if MAP_COUNT > 0
    uv = texcoord;
#endif
#if HAS_NORMAL_MAP
    world_tangent = mat3(model) * tangent;
#endif
#if HAS_NORMAL_MAP && HAS_MIRRORED_UV
    handedness = sign(dot(cross(normal, tangent), bitangent));
#endif
    gl_Position = view_projection * world;
}
