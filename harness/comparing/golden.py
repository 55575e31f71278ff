"""Pictures and arrays that are kept in files, and compared with what a test gets."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image

from ..errors import HarnessError
from ..language.glsl import shown_path
from ..picture import write, write_png

UPDATE = "--update-golden"  # the option of pytest that writes the files


class Golden:
    """The golden files of one test, in ``folder``. Made by the fixture ``golden``.

    ``output`` is where a failure leaves what was got. ``written`` are the files that this session has written:
    with ``update``, others are written where they are missing or do not agree.
    """

    def __init__(self, folder: Path, output: Path, update: bool, written: set[Path]):
        self._folder, self._output, self._update, self._written = folder, output, update, written

    def __call__(self, name: str, got: np.ndarray, *, atol: float = 0.0, rtol: float = 0.0) -> None:
        """Fails unless each value of ``got`` is within atol + rtol * |golden value| of the file ``name``.

        "NAME.png" keeps a picture, (h, w), (h, w, 3) or (h, w, 4) uint8 with tolerances in its levels; "NAME.npy" any
        array. NaN agrees with NaN, infinity with itself. Shapes and dtypes have to be the same.

        A failure writes what was got, and of pictures the difference, made so bright that its largest is white.
        """
        __tracebackhide__ = True  # pytest shows the line of the test instead
        path = self._folder / name
        got = np.asarray(got)
        write_it = _writer(path, got)
        if not path.is_file():
            difference = f"there is no golden file {shown_path(path)}"
        else:
            difference = _difference(path, got, atol, rtol)
        if difference is None:
            return
        if self._update and path not in self._written:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_it(path)
            self._written.add(path)
            return
        kept = self._output / name
        write_it(kept)
        message = [difference, f"got: {kept}"]
        if path in self._written:
            message.append("it was written in this run, by this test in another mode or by another test of this name")
        elif path.is_file():
            message += _difference_picture(path, got, self._output)
        message.append(f"if what was got is right: pytest {UPDATE}")
        raise AssertionError("\n  ".join(message))


def _writer(path: Path, got: np.ndarray) -> Callable[[Path], None]:
    """What writes ``got`` as a file of this kind, whole or not at all."""
    if path.suffix == ".png":
        if got.dtype != np.uint8 or not (got.ndim == 2 or (got.ndim == 3 and got.shape[2] in (3, 4))):
            raise HarnessError(
                f"{path.name} keeps a picture, (h, w), (h, w, 3) or (h, w, 4) uint8; got {got.shape} of {got.dtype}; "
                f'other arrays go into "{path.stem}.npy"'
            )
        return lambda to: write_png(to, got)
    if path.suffix == ".npy":
        return lambda to: write(to, lambda file: np.save(file, got, allow_pickle=False))
    raise HarnessError(f'a golden file is a "NAME.png" or a "NAME.npy", got {path.name!r}')


def _read(path: Path) -> np.ndarray:
    try:
        return np.asarray(Image.open(path)) if path.suffix == ".png" else np.load(path, allow_pickle=False)
    except (OSError, ValueError) as error:
        raise HarnessError(f"cannot read the golden file: {error}", shown_path(path)) from None


def _difference(path: Path, got: np.ndarray, atol: float, rtol: float) -> str | None:
    """What is wrong with ``got``; None when nothing is."""
    want = _read(path)
    if (got.shape, got.dtype) != (want.shape, want.dtype):
        return f"got {got.shape} of {got.dtype}; {shown_path(path)} has {want.shape} of {want.dtype}"
    difference = _distance(got, want)
    bad = difference > atol + rtol * np.where(np.isfinite(want), np.abs(want.astype(np.float64)), 0)
    if not bad.any():
        return None
    worst = np.unravel_index(np.argmax(np.where(bad, difference, -1)), difference.shape)
    allowed = f"{atol:g}" + (f" + {rtol:g} * |golden value|" if rtol else "")
    return (
        f"{bad.sum()} of {bad.size} values are more than {allowed} from {shown_path(path)}; "
        f"the worst, at {tuple(map(int, worst))}: got {got[worst]!s}, golden {want[worst]!s}"
    )


def _distance(got: np.ndarray, want: np.ndarray) -> np.ndarray:
    """|got - want|; 0 between NaN and NaN, inf between anything else that is not finite and not the same."""
    got, want = got.astype(np.float64), want.astype(np.float64)
    same = (got == want) | (np.isnan(got) & np.isnan(want))
    with np.errstate(invalid="ignore", over="ignore"):
        distance = np.abs(got - want)
    return np.where(same, 0.0, np.where(np.isnan(distance), np.inf, distance))


def _difference_picture(path: Path, got: np.ndarray, folder: Path) -> list[str]:
    want = _read(path)
    if got.shape != want.shape or not (got.ndim == 2 or (got.ndim == 3 and got.shape[2] in (1, 3, 4))):
        return []
    distance = _distance(got, want).reshape(*got.shape[:2], -1)
    if distance.shape[2] == 4:  # where the alpha differs, all three show it: that of this picture has to be opaque
        distance = np.maximum(distance[..., :3], distance[..., 3:])
    largest = distance[np.isfinite(distance)].max(initial=0) or 1
    bright = np.rint(np.minimum(distance / largest, 1) * 255).astype(np.uint8)
    picture = folder / f"{path.stem}-difference.png"
    write_png(picture, bright[..., 0] if bright.shape[2] == 1 else bright)
    return [f"difference, white where it is {largest:g}: {picture}"]
