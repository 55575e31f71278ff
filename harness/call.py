"""Calls GLSL functions by name on numpy arrays: ``shader("brdf.glsl").F_Schlick(F0, LoH)``."""

from __future__ import annotations

import keyword
import math
from collections import namedtuple
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from . import glsl, native, rewrite
from .errors import CallError
from .evaluation import MODES, Evaluation, Leaf, leaves
from .native import Stage, gl_enums
from .signature import DTYPES, Array, Numeric, Parameter, Signature, Struct, Type, signatures


def shader(
    path: str | Path,
    defines: Mapping[str, Any] | None = None,
    include_dirs: Sequence[str | Path] = (),
    mode: str = "as-written",
) -> Shader:
    """The functions of a GLSL file, callable by name.

    ``defines`` are macros, ``include_dirs`` the folders where includes are looked for, before the file's own. ``mode``
    is "as-written" or "precise" (the driver may not rewrite the arithmetic). GlslError when it does not compile.
    """
    path = Path(path)
    macros = {name: str(text) for name, text in (defines or {}).items()}
    source = glsl.load(path, macros, [*include_dirs, path.parent], version=glsl.VERSION)
    try:
        text = rewrite.isolate(native.glsl_preprocess(Stage.FRAGMENT, source.text))
    except native.NativeError as error:
        raise source.error(str(error)) from None
    plain = replace(source, text=text, written=source.text)
    functions = signatures(plain, rewrite.struct_names(text), rewrite.result_names(text))
    return Shader(plain, functions, mode)


class Shader:
    """The functions of one GLSL file as attributes. Made by ``shader``."""

    def __init__(self, source: glsl.Source, functions: Sequence[Signature], mode: str):
        if mode not in MODES:
            raise CallError(f"no mode {mode!r}; there are: {', '.join(MODES)}")
        self._source, self._signatures, self._mode = source, functions, mode
        self._functions = {
            name: Function(source, [s for s in functions if s.name == name], mode)
            for name in dict.fromkeys(s.name for s in functions)
        }

    def with_mode(self, mode: str) -> Shader:
        """The same functions, compiled in another mode."""
        return Shader(self._source, self._signatures, mode)

    def __getattr__(self, name: str) -> Function:
        if name.startswith("__"):
            raise AttributeError(name)
        if name not in self._functions:
            there = ", ".join(sorted(self._functions)) or "none at all"
            raise _NoFunctionError(f"no function {name}; there are: {there}", self._source.path)
        return self._functions[name]

    __getitem__ = __getattr__

    def __dir__(self):
        return [*super().__dir__(), *self._functions]

    def __repr__(self):
        return f"<shader {self._source.path}: {', '.join(self._functions)}>"


class _NoFunctionError(CallError, AttributeError):
    """An AttributeError too, so that hasattr() works."""


class Function:
    """A GLSL function; its overloads are told apart by the arguments. Call it with arrays that broadcast."""

    def __init__(self, source: glsl.Source, overloads: Sequence[Signature], mode: str):
        self._source, self._overloads, self._mode = source, overloads, mode
        self._compiled: dict[Signature, Evaluation] = {}
        self.__name__ = overloads[0].name
        self.__doc__ = "\n".join(f"{s}    [{s.origin[0]}:{s.origin[1]}]" for s in overloads)

    def __repr__(self):
        return f"<GLSL {'; '.join(map(str, self._overloads))}>"

    @property
    def signatures(self) -> tuple[Signature, ...]:
        """The overloads."""
        return tuple(self._overloads)

    def __call__(self, *args, **kwargs):
        """Evaluates the function for every element of the arguments' common batch.

        A vecN argument is an array (..., N), a matrix (..., rows, columns), a struct a dict of its members; what stands
        before broadcasts. Numbers are rounded to float32 once. Names that are not parameters set uniforms. Returns an
        array, or a named tuple where there are out parameters or a struct. CallError when the arguments do not fit.
        """
        signature, arguments, rest = self._overload(args, kwargs)
        if signature not in self._compiled:
            self._compiled[signature] = Evaluation(self._source, signature, self._mode)
        evaluation = self._compiled[signature]
        self._set_uniforms(evaluation, rest)
        return _evaluate(evaluation, arguments)

    def _overload(self, args: tuple, kwargs: dict) -> tuple[Signature, dict[str, list[np.ndarray]], dict]:
        """The overload that the arguments fit best, the numbers of its parameters, and the names left over."""
        fitting, errors = [], []
        for signature in self._overloads:
            try:
                given, rest = _bind(signature, args, kwargs)
                fitting.append((signature, {p.name: _numbers(p, given[p.name]) for p in signature.inputs}, rest))
            except CallError as error:
                errors.append(error)
        if len(fitting) > 1:
            misfits = [(len(rest), _conversions(signature, numbers)) for signature, numbers, rest in fitting]
            fitting = [fit for fit, misfit in zip(fitting, misfits, strict=True) if misfit == min(misfits)]
        if len(fitting) == 1:
            return fitting[0]
        if len(self._overloads) == 1:
            signature = self._overloads[0]
            raise CallError(f"{errors[0].message}; it is {signature}", *signature.origin)
        found = "more than one overload fits" if fitting else "no overload fits"
        listed = "".join(f"\n    {s}" for s in self._overloads)
        raise CallError(f"{self.__name__}: {found} these arguments; there are:{listed}", self._source.path)

    def _set_uniforms(self, evaluation: Evaluation, given: dict) -> None:
        where = evaluation.signature.origin
        for name in given:
            if name not in evaluation.uniforms:
                raise CallError(f"{evaluation.signature} has no parameter {name} and reads no such uniform", *where)
        for name, uniform in evaluation.uniforms.items():
            kind = gl_enums.GLSL_TYPE_NAMES.get(uniform.type, f"type 0x{uniform.type:x}")
            if kind not in _UNIFORM_TYPES:
                raise CallError(f"{self.__name__} reads the uniform {kind} {name}, which cannot be given", *where)
            if uniform.location < 0:
                raise CallError(f"{self.__name__} reads {name} of a uniform block, which cannot be given", *where)
            length = evaluation.array_length(name)
            kind = _UNIFORM_TYPES[kind] if length is None else Array(_UNIFORM_TYPES[kind], length)
            if name not in given:
                raise CallError(f"{self.__name__} reads the uniform {kind} {name}: give it by its name", *where)
            number, shape = _dense(kind)
            value = given[name]
            if length is not None and np.ndim(value) == len(shape):
                value = value[:length]  # the driver counts the elements only up to the last that is read
            try:
                value = _array(number, shape, value, name, kind)
            except CallError as error:
                raise CallError(f"the uniform {error.message}", *where) from None
            if value.shape != shape:
                raise CallError(f"uniform {name} is one {kind}, not an array of them", *where)
            evaluation.set_uniform(name, value.astype(_GL_DTYPES[number.base], copy=False))


_UNIFORM_TYPES = {
    str(kind): kind
    for kind in (
        *(Numeric(base, rows) for base in ("float", "int", "uint", "bool") for rows in (1, 2, 3, 4)),
        *(Numeric("float", rows, columns) for rows in (2, 3, 4) for columns in (2, 3, 4)),
    )
}


#: base type -> numpy's type of the 4-byte numbers that go through GL
_GL_DTYPES = {base: Leaf("", (), Numeric(base)).dtype for base in DTYPES}


def _bind(signature: Signature, args: tuple, kwargs: dict) -> tuple[dict[str, Any], dict[str, Any]]:
    """Arguments by parameter name, and the keywords that name no parameter."""
    names = [p.name for p in signature.inputs]
    if len(args) > len(names):
        raise CallError(f"{signature.name} takes {len(names)} arguments, got {len(args)}")
    given = dict(zip(names, args, strict=False))
    rest = {}
    for name, value in kwargs.items():
        if name in given:
            raise CallError(f"{signature.name} got {name} twice")
        (given if name in names else rest)[name] = value
    missing = [name for name in names if name not in given]
    if missing:
        raise CallError(f"{signature.name} lacks {', '.join(missing)}")
    return given, rest


def _numbers(parameter: Parameter, value: Any) -> list[np.ndarray]:
    """The leaves of an argument, in the order of ``evaluation.leaves``: arrays (..., *shape of the leaf)."""
    return list(_leaf_arrays(parameter.type, value, parameter.name))


def _conversions(signature: Signature, numbers: Mapping[str, list[np.ndarray]]) -> int:
    """How many leaves of the arguments are not of the parameter's own base type."""
    return sum(
        array.dtype.kind != np.dtype(DTYPES[leaf.type.base]).kind
        for p in signature.inputs
        for leaf, array in zip(leaves(p.type), numbers[p.name], strict=True)
    )


def _dense(kind: Type) -> tuple[Numeric, tuple[int, ...]] | None:
    """The numbers and the shape of a type that is one array in numpy; None for what holds a structure."""
    if isinstance(kind, Array) and (inner := _dense(kind.element)):
        return inner[0], (kind.length, *inner[1])
    return (kind, kind.shape) if isinstance(kind, Numeric) and kind.base in DTYPES else None


def _leaf_arrays(kind: Type, value: Any, name: str):
    if isinstance(kind, Struct):
        wanted = [member for member, _ in kind.members]
        members = value._asdict() if hasattr(value, "_asdict") else value
        if getattr(value, "_fields", None) == _tuple_type(str(kind), tuple(wanted))._fields:
            members = dict(zip(wanted, value, strict=True))
        if not isinstance(members, Mapping) or set(members) != set(wanted):
            got = ", ".join(map(str, members)) if isinstance(members, Mapping) else type(value).__name__
            raise CallError(f"{name} is a {kind}: a dict of {', '.join(wanted)}, got {got}")
        for member, inner in kind.members:
            yield from _leaf_arrays(inner, members[member], f"{name}.{member}")
    elif isinstance(kind, Numeric) and kind.base in DTYPES:
        yield _array(kind, kind.shape, value, name, kind)
    elif dense := _dense(kind):  # an array of numbers
        whole = _array(*dense, value, name, kind)
        batch = whole.ndim - len(dense[1])
        for place in np.ndindex(dense[1][: len(dense[1]) - len(dense[0].shape)]):
            yield whole[(slice(None),) * batch + place]
    elif isinstance(kind, Array):
        if not isinstance(value, Sequence) or len(value) != kind.length:
            got = len(value) if isinstance(value, Sequence) else type(value).__name__
            raise CallError(f"{name} is a {kind}: {kind.length} values, got {got}")
        for k in range(kind.length):
            yield from _leaf_arrays(kind.element, value[k], f"{name}[{k}]")
    else:
        raise CallError(f"{name} is a {kind}, which cannot be given as an array")


def _array(number: Numeric, shape: tuple[int, ...], value: Any, name: str, kind: Type) -> np.ndarray:
    """A numeric argument as an array whose last dimensions are ``shape`` and whose numbers the type can hold."""
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise CallError(f"{name} is no array: {error}") from None
    allowed = {"float": "fiub", "int": "iu", "uint": "iu", "bool": "b"}[number.base]
    if array.dtype.kind not in allowed:
        raise CallError(f"{name} is a {kind}, got numbers of type {array.dtype}")
    if len(shape) > array.ndim or array.shape[array.ndim - len(shape) :] != shape:
        dimensions = ", ".join(["...", *map(str, shape)])
        raise CallError(f"{name} is a {kind}: an array of shape ({dimensions}), got {array.shape}")
    if number.base in ("int", "uint") and array.size:
        limits = np.iinfo(DTYPES[number.base])
        if array.min() < limits.min or array.max() > limits.max:
            raise CallError(f"{name} is a {kind}: {limits.min} ... {limits.max}, got a number beyond")
    return array


def _evaluate(evaluation: Evaluation, arguments: dict[str, list[np.ndarray]]):
    """Broadcasts, flattens, evaluates, and puts the results in shape."""
    parts = [
        (f"{buffer}", leaf, array, array.shape[: array.ndim - len(leaf.type.shape)])
        for name, buffers in evaluation.inputs
        for (buffer, leaf), array in zip(buffers, arguments[name], strict=True)
    ]
    try:
        batch = np.broadcast_shapes(*(shape for *_, shape in parts))
    except ValueError:
        shapes = ", ".join(
            f"{name} {array.shape[: array.ndim - len(leaf.type.shape)]}"
            for name, buffers in evaluation.inputs
            for (_, leaf), array in zip(buffers, arguments[name], strict=True)
        )
        message = f"the arguments do not broadcast: {shapes}; it is {evaluation.signature}"
        raise CallError(message, *evaluation.signature.origin) from None
    count = math.prod(batch)
    flat = {}
    for buffer, leaf, array, own in parts:
        with np.errstate(over="ignore"):  # beyond float32 is Inf, as in GLSL
            array = array.astype(leaf.dtype, copy=False)
        if math.prod(own) != 1 and own != batch:
            array = np.broadcast_to(array, batch + leaf.type.shape)
        flat[buffer] = np.ascontiguousarray(array).reshape(-1, leaf.size)
    outputs = evaluation.run(flat, count)
    shaped = [
        _shaped(kind, iter(values), batch)
        for (_, kind), values in zip(evaluation.signature.outputs, outputs, strict=True)
    ]
    if len(shaped) == 1:
        return shaped[0]
    return _tuple_type(evaluation.signature.name, tuple(n for n, _ in evaluation.signature.outputs))(*shaped)


def _shaped(kind: Type, values, batch: tuple[int, ...]):
    """The value of a type from its leaves: arrays (*batch, *shape), named tuples for structs."""
    if isinstance(kind, Struct):
        members = [_shaped(inner, values, batch) for _, inner in kind.members]
        return _tuple_type(str(kind), tuple(name for name, _ in kind.members))(*members)
    if isinstance(kind, Array):
        elements = [_shaped(kind.element, values, batch) for _ in range(kind.length)]
        return np.stack(elements, axis=len(batch)) if _dense(kind) else tuple(elements)
    value = next(values).reshape(batch + kind.shape)
    value = value.astype(np.bool_) if kind.base == "bool" else value
    return value if value.ndim else value[()]


@cache  # to make a class takes longer than to evaluate a small batch
def _tuple_type(name: str, fields: tuple[str, ...]) -> type:
    """A named tuple. What Python takes for no name becomes one: that of the type gets a _, of a field its place."""
    return namedtuple(name + "_" * keyword.iskeyword(name), fields, rename=True)
