#version 330
// entry.vert: functions beside a vertex shader's entry point.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 view_projection;

out vec3 world_normal;
invariant gl_Position;

vec4 projected(vec3 p)
{
    return view_projection * vec4(p, 1.0);
}

void main()
{
    world_normal = normal * float(gl_VertexID);
    gl_Position = projected(position);
}
