"""Render states, topologies and pixel formats: SHADERed's names for them, and GL's."""

from __future__ import annotations

from .. import native
from ..native import gl_enums as gl
from ..projects.project import RenderState, StencilSide

#: None: SHADERed hands GL a value that GL refuses
TOPOLOGIES = {
    "Undefined": None,
    "PointList": gl.GL_POINTS,
    "LineList": gl.GL_LINES,
    "LineStrip": gl.GL_LINE_STRIP,
    "TriangleList": gl.GL_TRIANGLES,
    "TriangleStrip": gl.GL_TRIANGLE_STRIP,
    "LineListAdjecent": gl.GL_LINES_ADJACENCY,
    "LineStripAdjecent": gl.GL_LINE_STRIP_ADJACENCY,
    "TriangleListAdjecent": gl.GL_TRIANGLES_ADJACENCY,
    "TriangleStripAdjecent": gl.GL_TRIANGLE_STRIP_ADJACENCY,
    "Patches": gl.GL_PATCHES,
}
FACTORS = {
    "": None,
    "Zero": gl.GL_ZERO,
    "One": gl.GL_ONE,
    "Source Color": gl.GL_SRC_COLOR,
    "Inverse Source Color": gl.GL_ONE_MINUS_SRC_COLOR,
    "Source Alpha": gl.GL_SRC_ALPHA,
    "Inverse Source Alpha": gl.GL_ONE_MINUS_SRC_ALPHA,
    "Destination Alpha": gl.GL_DST_ALPHA,
    "Inverse Destination Alpha": gl.GL_ONE_MINUS_DST_ALPHA,
    "Destination Color": gl.GL_DST_COLOR,
    "Inverse Destination Color": gl.GL_ONE_MINUS_DST_COLOR,
    "Saturated Source Alpha": gl.GL_SRC_ALPHA_SATURATE,
    "Blend Factor": gl.GL_CONSTANT_COLOR,
    "Inverse Blend Factor": gl.GL_ONE_MINUS_CONSTANT_COLOR,
    "Source 1 Color": None,
    "Inverse Source 1 Color": None,
    "Source 1 Alpha": None,
    "Inverse Source 1 Alpha": None,
}
FUNCTIONS = {
    "": None,
    "Add": gl.GL_FUNC_ADD,
    "Subtract": gl.GL_FUNC_SUBTRACT,
    "Reverse Subtract": gl.GL_FUNC_REVERSE_SUBTRACT,
    "Min": gl.GL_MIN,
    "Max": gl.GL_MAX,
}
COMPARES = {
    "": None,
    "Never": gl.GL_NEVER,
    "Less": gl.GL_LESS,
    "Equal": gl.GL_EQUAL,
    "LessEqual": gl.GL_LEQUAL,
    "Greater": gl.GL_GREATER,
    "NotEqual": gl.GL_NOTEQUAL,
    "GreaterEqual": gl.GL_GEQUAL,
    "Always": gl.GL_ALWAYS,
}
#: "Saturated" wraps and the others saturate: SHADERed has the two the wrong way round
STENCILS = {
    "": gl.GL_ZERO,
    "Keep": gl.GL_KEEP,
    "Zero": gl.GL_ZERO,
    "Replace": gl.GL_REPLACE,
    "Increase Saturated": gl.GL_INCR_WRAP,
    "Decrease Saturated": gl.GL_DECR_WRAP,
    "Invert": gl.GL_INVERT,
    "Increase": gl.GL_INCR,
    "Decrease": gl.GL_DECR,
}


def gl_state(state: RenderState) -> native.State:
    """The state in GL's terms."""
    cull = gl.GL_FRONT if state.cull_front else gl.GL_BACK
    made = native.State(
        fill=gl.GL_LINE if state.wireframe else gl.GL_FILL,
        cull=cull if state.cull else gl.GL_NONE,
        front=gl.GL_CCW if state.ccw else gl.GL_CW,
        depth_clamp=state.depth_clamp,
        depth_test=state.depth_test,
        depth_write=state.depth_write,
        depth_function=COMPARES[state.depth_function],
    )
    if state.blend is not None:
        b = state.blend
        made = made._replace(
            blend=True,
            blend_functions=(FUNCTIONS[b.color_function], FUNCTIONS[b.alpha_function]),
            blend_factors=tuple(
                FACTORS[f] for f in (b.color_source, b.color_destination, b.alpha_source, b.alpha_destination)
            ),
            blend_color=b.factor,
        )
    if state.stencil is not None:
        made = made._replace(
            stencil_test=True,
            stencil_reference=1,
            stencil_read_mask=state.stencil.read_mask,
            stencil_write_mask=state.stencil.write_mask,
            stencil_front=_side(state.stencil.front),
            stencil_back=_side(state.stencil.back),
        )
    return made


def _side(side: StencilSide) -> native.Stencil:
    return native.Stencil(
        COMPARES[side.function], STENCILS[side.fail], STENCILS[side.depth_fail], STENCILS[side.passed]
    )


#: pixel formats by SHADERed's names -> GL's internal format; those of integers SHADERed cannot make
FORMATS = {
    "RGBA": 0x1908,
    "RGB": 0x1907,
    "RG": 0x8227,
    "R": 0x1903,
    "R8": 0x8229,
    "R8_SNORM": 0x8F94,
    "R16": 0x822A,
    "R16_SNORM": 0x8F98,
    "R8G8": 0x822B,
    "R8G8_SNORM": 0x8F95,
    "R16G16": 0x822C,
    "R16G16_SNORM": 0x8F99,
    "R3G3B2": 0x2A10,
    "R4G4B4": 0x804F,
    "R5G5B5": 0x8050,
    "R8G8B8": 0x8051,
    "R8G8B8_SNORM": 0x8F96,
    "R10G10B10": 0x8052,
    "R12G12B12": 0x8053,
    "R16G16B16_SNORM": 0x8F9A,
    "R2G2B2A2": 0x8055,
    "R4G4B4A4": 0x8056,
    "R5G5B5A1": 0x8057,
    "R8G8B8A8": 0x8058,
    "R8G8B8A8_SNORM": 0x8F97,
    "R10G10B10A2": 0x8059,
    "R12G12B12A12": 0x805A,
    "R16G16B16A16": 0x805B,
    "SR8G8B8": 0x8C41,
    "SR8G8B8A8": 0x8C43,
    "R16_FLOAT": 0x822D,
    "R16G16_FLOAT": 0x822F,
    "R16G16B16_FLOAT": 0x881B,
    "R16G16B16A16_FLOAT": 0x881A,
    "R32_FLOAT": 0x822E,
    "R32G32_FLOAT": 0x8230,
    "R32G32B32_FLOAT": 0x8815,
    "R32G32B32A32_FLOAT": 0x8814,
    "R11G11B10_FLOAT": 0x8C3A,
    "R9G9B9_E5": 0x8C3D,
}
INTEGER_FORMATS = ("UNKNOWN", "R10G10B10A2_UINT") + tuple(
    f"{channels}_{kind}"
    for channels in (
        *("R8", "R16", "R32", "R8G8", "R16G16", "R32G32", "R8G8B8", "R16G16B16", "R32G32B32"),
        *("R8G8B8A8", "R16G16B16A16", "R32G32B32A32"),
    )
    for kind in ("INT", "UINT")
)
