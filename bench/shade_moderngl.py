"""``shade`` by moderngl, on Mesa's software renderer through EGL: the same GLSL, in the two ways that moderngl offers.

Textures, buffers and programs are made once and used again, as a program that calls often would. Compute shaders were
tried too: never faster than the better of these two. Only in a process of its own: two providers of GL in one crash.
"""

from __future__ import annotations

from collections.abc import Callable

import moderngl
import numpy as np

from harness.language import glsl

from . import ROOT, AbsentError
from .inputs import Inputs

WIDTH_MAX = 2048
_BRDF = glsl.load(ROOT / "shaders" / "brdf.glsl", {}, [ROOT / "shaders"], version=glsl.VERSION).text
_TRIANGLE = """#version 330
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }
"""
_FRAGMENT = f"""{_BRDF}
uniform sampler2D {", ".join(Inputs._fields)};
out vec3 radiance;
void main()
{{
    ivec2 p = ivec2(gl_FragCoord.xy);
    Material m = Material(texelFetch(albedo, p, 0).rgb, texelFetch(metalness, p, 0).r, texelFetch(roughness, p, 0).r);
    radiance = shade(texelFetch(l, p, 0).xyz, texelFetch(v, p, 0).xyz, texelFetch(n, p, 0).xyz, m);
}}
"""
_VERTEX = f"""{_BRDF}
in vec3 l, v, n, albedo;
in float metalness, roughness;
out vec3 radiance;
void main() {{ radiance = shade(l, v, n, Material(albedo, metalness, roughness)); }}
"""


def _context() -> moderngl.Context:
    try:
        return moderngl.create_context(standalone=True, backend="egl")
    except Exception as error:  # noqa: BLE001 -- moderngl raises no other
        raise AbsentError(f"no EGL context ({error}): apt-get install libegl1 libgl1-mesa-dri") from None


def _components(array: np.ndarray) -> int:
    return 1 if array.ndim == 1 else array.shape[1]


def textures() -> Callable[[Inputs], np.ndarray]:
    """A texture an argument, a fragment an evaluation, the picture read back."""
    context = _context()
    program = context.program(vertex_shader=_TRIANGLE, fragment_shader=_FRAGMENT)
    for unit, name in enumerate(Inputs._fields):
        program[name] = unit
    triangle = context.vertex_array(program, [])
    made: dict[int, tuple[list[moderngl.Texture], moderngl.Framebuffer]] = {}

    def make(x: Inputs):
        count = len(x.l)
        width = min(WIDTH_MAX, 1 << (count.bit_length() + 1) // 2)
        size = width, -(-count // width)
        pictures = [context.texture(size, _components(array), dtype="f4") for array in x]
        return pictures, context.framebuffer([context.texture(size, 3, dtype="f4")])

    def shade(x: Inputs) -> np.ndarray:
        count = len(x.l)
        if count not in made:
            made[count] = make(x)
        pictures, target = made[count]
        width, height = target.size
        rows, rest = divmod(count, width)
        for unit, (picture, array) in enumerate(zip(pictures, x, strict=True)):
            if rows:
                picture.write(array[: rows * width], viewport=(0, 0, width, rows))
            if rest:
                picture.write(array[rows * width :], viewport=(0, rows, rest, 1))
            picture.use(unit)
        target.use()
        triangle.render(moderngl.TRIANGLES, vertices=3)
        radiance = np.empty((width * height, 3), np.float32)
        target.read_into(radiance, components=3, dtype="f4")
        return radiance[:count]

    return shade


def feedback() -> Callable[[Inputs], np.ndarray]:
    """A vertex an evaluation, its output captured by transform feedback: no rasteriser, but one thread."""
    context = _context()
    context.simple_framebuffer((1, 1)).use()  # without a complete one GL draws nothing, captured or not
    program = context.program(vertex_shader=_VERTEX, varyings=["radiance"])
    made: dict[int, tuple[list[moderngl.Buffer], moderngl.VertexArray, moderngl.Buffer]] = {}

    def make(x: Inputs):
        buffers = [context.buffer(reserve=array.nbytes) for array in x]
        content = [
            (buffer, f"{_components(array)}f", name)
            for buffer, array, name in zip(buffers, x, Inputs._fields, strict=True)
        ]
        return buffers, context.vertex_array(program, content), context.buffer(reserve=x.l.nbytes)

    def shade(x: Inputs) -> np.ndarray:
        count = len(x.l)
        if count not in made:
            made[count] = make(x)
        buffers, vertices, captured = made[count]
        for buffer, array in zip(buffers, x, strict=True):
            buffer.write(array)
        vertices.transform(captured, vertices=count)
        radiance = np.empty((count, 3), np.float32)
        captured.read_into(radiance)
        return radiance

    return shade
