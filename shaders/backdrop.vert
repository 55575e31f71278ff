#version 330
// backdrop.vert: a quad over the whole window, behind everything. For SHADERed's ScreenQuadNDC.
layout(location = 0) in vec2 position; // -1...1

out float height; // 0 at the bottom of the picture, 1 at its top

void main()
{
    height = 0.5 * position.y + 0.5;
    gl_Position = vec4(position, 0.999999, 1.0); // as far as a depth test against the cleared 1.0 lets through
}
