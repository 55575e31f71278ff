"""The uniforms that a called function reads: given by name, checked against the types that the driver reports."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import CallError, did_you_mean
from ..language.leaf import Leaf
from ..language.signature import DTYPES, Array, Numeric
from ..native import gl_enums
from .arguments import array, dense
from .evaluation import Evaluation
from .texture_argument import SAMPLERS

_TYPES = {
    str(kind): kind
    for kind in (
        *(Numeric(base, rows) for base in ("float", "int", "uint", "bool") for rows in (1, 2, 3, 4)),
        *(Numeric("float", rows, columns) for rows in (2, 3, 4) for columns in (2, 3, 4)),
    )
}

#: base type -> numpy's type of the 4-byte numbers that go through GL
_GL_DTYPES = {base: Leaf("", (), Numeric(base)).dtype for base in DTYPES}


def set_all(evaluation: Evaluation, given: Mapping[str, Any]) -> None:
    """Sets every uniform that the function reads.

    Those that the file gives a value may be left out, and keep it. CallError names what is missing, unknown, or does
    not fit.
    """
    signature = evaluation.signature
    for name in given:
        if name not in evaluation.uniforms:
            hint = did_you_mean(name, [*(p.name for p in signature.inputs), *evaluation.uniforms])
            message = f"{signature} has no parameter {name} and reads no such uniform{hint}"
            raise CallError(message, *signature.origin)
    for name, uniform in evaluation.uniforms.items():
        try:
            _set(evaluation, name, uniform, given)
        except CallError as error:
            raise CallError(error.message, *signature.origin) from None


def _set(evaluation: Evaluation, name: str, uniform: Any, given: Mapping) -> None:
    function = evaluation.signature.name
    stated = gl_enums.GLSL_TYPE_NAMES.get(uniform.type, f"type 0x{uniform.type:x}")
    if stated in SAMPLERS:
        if name not in given:
            raise CallError(f"{function} reads the uniform {stated} {name}: give it a Texture by its name")
        evaluation.set_sampler(name, given[name])
        return
    if name in evaluation.initial and name not in given:
        evaluation.reset_uniform(name)
        return
    if stated not in _TYPES:
        raise CallError(f"{function} reads the uniform {stated} {name}, which cannot be given")
    length = evaluation.array_length(name)
    kind = _TYPES[stated] if length is None else Array(_TYPES[stated], length)
    if name not in given:
        raise CallError(f"{function} reads the uniform {kind} {name}: give it by its name")
    number, shape = dense(kind)
    value = given[name]
    if length is not None and np.ndim(value) == len(shape):
        value = value[:length]  # the driver counts the elements only up to the last that is read
    try:
        value = array(number, shape, value, name, kind)
    except CallError as error:
        raise CallError(f"the uniform {error.message}") from None
    if value.shape != shape:
        raise CallError(f"uniform {name} is one {kind}, not an array of them")
    evaluation.set_uniform(name, value.astype(_GL_DTYPES[number.base], copy=False))
