"""Checks texture files: whether they can be read, how they are turned, and what the shader takes their numbers for."""

from __future__ import annotations

import os
import re
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..errors import did_you_mean
from ..native import Stage
from ..projects.xml_lines import Element
from ..rendering import textures
from ..rendering.textures import TextureError
from . import flow, roles, samplers
from .state import Bound, PassState, State, flag, path_of
from .structure import check_path, faces

#: read by SHADERed too, which changes them in ways of its own; where the reader here does not know them, it is no fault
_OTHERS = (".hdr", ".dds", ".psd", ".gif", ".pic", ".pgm", ".ppm")
_DX_IN_NAME = re.compile(r"(?:[Nn]ormal|NORMAL|nrm|nor)[-_ ]?(DX|dx|Dx|DirectX|directx)|(?:^|[-_ ])(DX|dx)(?:[-_. ]|$)")
_GL_IN_NAME = re.compile(r"(?:[Nn]ormal|NORMAL|nrm|nor)[-_ ]?(GL|gl|Gl|OpenGL|opengl)|(?:^|[-_ ])(GL|gl)(?:[-_. ]|$)")
_TURNS_GREEN = re.compile(
    r"\.[yg]\s*\*=\s*-\s*1|\.[yg]\s*=\s*-|\.[yg]\s*=\s*1\.0*\s*-|1\.0*\s*-\s*\w+\.[yg]\b|vec[23]\s*\(\s*1\.0*\s*,\s*-\s*1\.0*"
)
_TURNS_V = re.compile(r"1\.0*\s*-\s*(?:[\w.]*\.)?[yvt]\b|\.y\s*=\s*1\.0*\s*-|\.y\s*=\s*-")


def pixels(path: Path) -> np.ndarray:
    """(h, w, 4) uint8, top row first. TextureError."""
    return _pixels(path.resolve(), path.stat().st_mtime_ns)


@lru_cache(maxsize=8)
def _pixels(path: Path, _changed: int) -> np.ndarray:
    return textures.read(path, vflip=True)


def readable(state: State, bound: Bound) -> np.ndarray | None:
    """The pixels of a bound texture file; None where it is none, or cannot be read."""
    if bound.path is None or flag(bound.element, "is_3d"):
        return None
    try:
        return pixels(state.file(bound.path))
    except (TextureError, OSError):
        return None


def check(state: State) -> None:
    """Checks all textures that passes use."""
    used = {id(b.element) for p in state.passes for b in p.bound}
    for element in state.objects:
        if id(element) in used and element.attributes.get("type") == "texture":
            _check_files(state, element)
    for shader_pass in state.passes:
        for bound in shader_pass.bound:
            if bound.path is not None:
                _check_flip(state, shader_pass, bound)
        for bound, sampler in samplers.given(shader_pass):
            if bound.path is not None:
                _check_colors(state, shader_pass, bound, sampler)
                _check_green(state, shader_pass, bound, sampler)


def _check_files(state: State, element: Element) -> None:
    if flag(element, "keyboard_texture"):
        return
    cube = flag(element, "cube")
    for relative in faces(element) if cube else [path_of(element.attributes.get("path", ""))]:
        path = state.file(relative)
        check_path(state, element, relative)
        what = f'<object type="texture" path="{relative}">' if not cube else f'the face "{relative}" of a cube map'
        if not os.path.isfile(path):
            hint = did_you_mean(os.path.basename(relative), _files_in(path.parent))
            state.add(
                "HS401",
                element,
                f"{what}: there is no such file{hint}",
                "correct the path: it is relative to the .sprj, and white space in it counts",
            )
            continue
        try:
            textures.size(path)
            if not cube and not flag(element, "is_3d"):
                pixels(path)
        except TextureError as error:
            state.add(
                "HS402",
                element,
                f"{what}: {error.message}",
                "save it as an 8-bit PNG of at most 16384 pixels a side",
                "note" if relative.lower().endswith(_OTHERS) else None,
            )


def _files_in(folder: Path) -> list[str]:
    try:
        return os.listdir(folder)
    except OSError:
        return []


def _check_flip(state: State, shader_pass: PassState, bound: Bound) -> None:
    """A texture on models without vflip, and one on built-in shapes with it."""
    kinds, flipped = shader_pass.kinds(), flag(bound.element, "vflip")
    if len(kinds) != 1 or any(_TURNS_V.search(text) for text in shader_pass.preprocessed.values()):
        return
    image = readable(state, bound)
    if image is None or np.array_equal(image[:, ::8], image[::-1, ::8]):
        return
    if kinds == {"model"} and not flipped:
        state.add(
            "HS403",
            bound.element,
            f'"{bound.path}" is on models of pass "{shader_pass.name}" without vflip: they show it upside down',
            'write vflip="true"',
        )
    elif kinds == {"geometry"} and flipped:
        state.add(
            "HS403",
            bound.element,
            f'"{bound.path}" is on built-in shapes of pass "{shader_pass.name}" with vflip: they show it upside down',
            'write vflip="false"',
            "note",
        )


def _check_colors(state: State, shader_pass: PassState, bound: Bound, sampler: str) -> None:
    """sRGB decoded never, twice, or where there is none."""
    text = shader_pass.preprocessed[Stage.FRAGMENT]
    role, times = roles.of_file(bound.path), flow.decodes(text, sampler)
    if role is None or times is None or samplers.wanted_role(shader_pass, sampler) not in (role, None):
        return
    what = f'"{bound.path}", by its name a {role} map, read by "{sampler}" of pass "{shader_pass.name}"'
    at = _first_use(shader_pass, sampler)
    if role != roles.COLOR and times > 0:
        state.add("HS405", at, f"{what}, is decoded from sRGB", "take its numbers as they are")
    elif role == roles.COLOR and times > 1:
        state.add("HS406", at, f"{what}, is decoded from sRGB {times} times", "decode it once")
    elif role == roles.COLOR and times == 0 and (flow.encodes(text) or flow.lights(text)):
        state.add(
            "HS404",
            at,
            f"{what}, is never decoded from sRGB",
            "decode it where it is read: pow(texel.rgb, vec3(2.2)) or the curve of IEC 61966-2-1",
        )


def _first_use(shader_pass: PassState, sampler: str) -> tuple[str, int]:
    text = shader_pass.preprocessed[Stage.FRAGMENT]
    match = re.search(rf"\btexture\w*\s*\(\s*{re.escape(sampler)}\b", text)
    return shader_pass.sources[Stage.FRAGMENT].origin(text.count("\n", 0, match.start()) + 1)


def _check_green(state: State, shader_pass: PassState, bound: Bound, sampler: str) -> None:
    """Normal maps whose name says DX or GL against what the shader does with green."""
    name = os.path.basename(bound.path)
    is_dx, is_gl = bool(_DX_IN_NAME.search(name)), bool(_GL_IN_NAME.search(name))
    text = shader_pass.preprocessed[Stage.FRAGMENT]
    if is_dx == is_gl or flow.decodes(text, sampler) is None:
        return
    turns = any(
        _TURNS_GREEN.search(text[f.start : f.end]) for f in flow.functions(text) if f.name in flow.reached(text)
    )
    if turns != is_dx:
        does = "turns green round" if turns else "does not turn green round"
        macro = "NORMAL_MAP_DX" if "NORMAL_MAP_DX" in shader_pass.sources[Stage.FRAGMENT].text else ""
        how = f"define {macro} as {int(is_dx)}" if macro else "turn its y round" if is_dx else "leave its y as it is"
        state.add(
            "HS407",
            bound.bind,
            f'"{bound.path}" is a {"DX" if is_dx else "GL"} normal map by its name, and pass '
            f'"{shader_pass.name}" {does}',
            f"{how}, or take the {'GL' if is_dx else 'DX'} map",
        )
