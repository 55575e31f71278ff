"""A GLSL function as a Python callable: by its own name and parameters, on numpy arrays that broadcast."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..errors import CallError, HarnessError, among
from ..language.dialect import MODES
from ..language.signature import Signature
from . import batches, overloads
from .evaluation import Evaluation
from .library import Library
from .texture_argument import Texture
from .uniform_values import set_all

if TYPE_CHECKING:  # what few callers need is loaded when they do
    import inspect

    from ..interpreting.trace import Trace
    from .mode_comparison import ModeComparison


def known_mode(mode: str) -> str:
    """The mode itself. CallError lists those that there are."""
    if mode not in MODES:
        raise CallError(f"no mode {mode!r}{among(str(mode), MODES)}")
    return mode


class _Documentation:
    """``__doc__`` of the class, and of each function its own: made when it is asked for, as it reads the files."""

    def __init__(self, text: str):
        self._text = text

    def __get__(self, function: Function | None, owner: type) -> str:
        return self._text if function is None else function._documentation()


class Function:
    __doc__ = _Documentation(
        """A GLSL function; its overloads are told apart by the arguments. Call it with arrays that broadcast."""
    )

    def __init__(self, library: Library, signatures: Sequence[Signature], mode: str):
        self._library, self._overloads, self._mode = library, tuple(signatures), known_mode(mode)
        self.__name__ = self.__qualname__ = signatures[0].name

    def __repr__(self):
        return f"<GLSL {'; '.join(map(str, self._overloads))}>"

    def _documentation(self) -> str:
        parts = []
        for signature in self._overloads:
            file, line = signature.origin
            comment = self._library.comments[signature]
            parts.append(f"{signature}    [{file}:{line}]" + (f"\n\n{comment}\n" if comment else ""))
        return "\n".join(parts).rstrip("\n")

    @property
    def __signature__(self) -> inspect.Signature:
        from .introspection import python_signature

        return python_signature(self._overloads)

    @property
    def signatures(self) -> tuple[Signature, ...]:
        """The overloads."""
        return self._overloads

    @property
    def origin(self) -> tuple[str, int]:
        """File and line where it is defined; of overloads the first."""
        return self._overloads[0].origin

    @property
    def comment(self) -> str:
        """The comment directly above it in the file, "" where there is none; of overloads the first."""
        return self._library.comments[self._overloads[0]]

    @property
    def mode(self) -> str:
        """The arithmetic that it is evaluated in."""
        return self._mode

    def with_mode(self, mode: str) -> Function:
        """The same function in another mode."""
        return Function(self._library, self._overloads, mode)

    def __getitem__(self, signature: str) -> Function:
        """One overload, by its types: ``f["f(vec3, float)"]``. CallError lists those that there are."""
        return Function(self._library, [overloads.select(self._overloads, signature, self._library.path)], self._mode)

    def __call__(self, /, *args, out: Any = None, **kwargs) -> Any:
        """Evaluates the function for every element of the arguments' common batch.

        A vecN argument is an array (..., N), a matrix (..., rows, columns), a struct a dict of its members; what stands
        before broadcasts. Numbers are rounded to float32 once, beyond its range to infinity. Names that are not
        parameters set uniforms. Returns an array, or a named tuple where there are out parameters or a struct.

        Arguments and ``out`` may be memory-mapped files larger than the memory: they are worked through in blocks.
        ``out`` is an array of the result's shape, or a tuple of them, to write into and return. CallError when the
        arguments do not fit.
        """
        signature, numbers, rest = self._overload(args, kwargs)
        evaluation = self._ready(signature, rest)
        for name, value in numbers.items():
            if isinstance(value, Texture):
                evaluation.set_sampler(name, value)
        return batches.evaluate(evaluation, numbers, out)

    def trace(self, /, *args, precision: str = "float32", **kwargs) -> Trace:
        """Evaluates the function as a call does, and tells every float that it computes on the way.

        Our interpreter does it, not the driver: in strict IEEE arithmetic of ``precision``, "float32", "float64" or
        "float16". ``Trace.first_non_finite()`` finds where a NaN begins that the result hides.
        """
        from ..interpreting.interpretation import PRECISIONS
        from ..interpreting.trace import Tracing

        if precision not in PRECISIONS:
            raise CallError(f"no precision {precision!r}{among(str(precision), PRECISIONS)}")
        signature, numbers, rest = self._overload(args, kwargs)
        tracing = Tracing(self._library.source, signature, precision)
        set_all(tracing, rest)
        return tracing.trace(*batches.at_once(tracing, numbers))

    def stream(self, chunks: Iterable[Mapping[str, Any]], /, **constant) -> Iterator[Any]:
        """Evaluates chunk after chunk, each a dict of arguments by name; yields the results, holding none.

        ``constant`` are arguments and uniforms that all chunks share::

            for result in brdf.D_GGX.stream(({"NoH": chunk} for chunk in chunks), alpha=0.25): ...
        """
        for chunk in chunks:
            if not isinstance(chunk, Mapping):
                raise CallError(
                    f"{self.__name__}.stream: a chunk is a dict of arguments by name, got {type(chunk).__name__}",
                    *self.origin,
                )
            yield self(**constant, **chunk)

    def compare(self, /, *args, modes: Sequence[str] | None = None, **kwargs) -> ModeComparison:
        """The results of one call in several modes: a dict by mode, which prints how far each is from the best.

        Without ``modes`` all are tried, and those that this function cannot be evaluated in are told with the reason.
        """
        from .mode_comparison import ModeComparison

        results, refused = {}, {}
        chosen = self._overload(args, kwargs)
        for mode in modes or MODES:
            try:
                results[mode] = self.with_mode(mode)(*args, **kwargs)
            except HarnessError as error:
                if modes:
                    raise
                refused[mode] = error
        if not results:
            raise next(iter(refused.values()))
        return ModeComparison(chosen, results, refused)

    def command(self, arguments: Mapping[str, Any] | Sequence, index: int | tuple[int, ...] | None = None) -> str:
        """The line for a shell, ``harness call ...``, that evaluates the function once, with the same bits.

        ``arguments`` are those of a call, by name (uniforms too) or in order; ``index`` tells the element of their
        batch, as numpy's indices or counted in C order; it may be left out where there is one only.
        """
        from .command import line

        args, kwargs = ((), arguments) if isinstance(arguments, Mapping) else (arguments, {})
        return line(self._library, self._overload(args, kwargs), self._mode, index)

    def _overload(self, args: Sequence, kwargs: Mapping[str, Any]) -> overloads.Chosen:
        return overloads.choose(self._overloads, args, kwargs, self._library.path)

    def _ready(self, signature: Signature, uniforms: Mapping[str, Any]) -> Evaluation:
        """The compiled function, its uniforms set."""
        place = (signature, self._mode)
        if place not in self._library.compiled:
            self._library.compiled[place] = self._library.engine(self._library.source, signature, self._mode)
        evaluation = self._library.compiled[place]
        if uniforms or evaluation.uniforms:
            set_all(evaluation, uniforms)
        return evaluation
