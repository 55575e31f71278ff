"""SPIR-V modules as lists of instructions [Khronos: SPIR-V Specification 1.6, section 2.3]."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

_HEADER_WORDS = 5
_LOAD, _ACCESS_CHAIN, _VARIABLE = 61, 65, 59
#: storage classes of what comes from outside by descriptors: UniformConstant, Uniform, StorageBuffer
_RESOURCES = {0, 2, 12}


def instructions(words: np.ndarray) -> Iterator[tuple[int, list[int]]]:
    """Opcode and operands of each instruction of a module."""
    listed = words.tolist()
    place = _HEADER_WORDS
    while place < len(listed):
        length, code = listed[place] >> 16, listed[place] & 0xFFFF
        yield code, listed[place + 1 : place + length]
        place += length


def reads_resources(words: np.ndarray) -> bool:
    """Whether a module reads uniforms, textures or buffers."""
    resources = set()
    for code, operands in instructions(words):
        if code == _VARIABLE and operands[2] in _RESOURCES:
            resources.add(operands[1])
        elif code in (_LOAD, _ACCESS_CHAIN) and operands[2] in resources:
            return True
    return False
