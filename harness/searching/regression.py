"""A pytest test of what was found: it passes ``ruff format`` at any usual width, and fails until that is mended."""

from __future__ import annotations

import os
import re
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..comparing.failure import hexadecimal
from .hunt import Finding

_SHORT = 60  # characters of a value that stays on one line

_HEAD = '''"""Inputs found by a hunt:

{command}
"""
{imports}
'''
_NAMES = {
    "nonfinite": "is_finite",
    "negative": "is_not_negative",
    "ulp": "is_accurate",
    "monotone": "is_monotone",
    "symmetric": "is_symmetric",
}


def test_module(
    findings: Sequence[Finding],
    file: str,
    defines: Mapping[str, str],
    include_dirs: Sequence[str],
    mode: str,
    command: str,
    beside: Path | None = None,
) -> str:
    """A Python module with one test for each finding.

    ``file`` and ``include_dirs`` are taken from the working folder; the module that is to lie at ``beside`` finds them
    from its own place.
    """
    tests = [_test(finding, file, defines, include_dirs, mode, beside) for finding in findings]
    body = "\n\n".join(tests)
    ours = sorted({"shader", *re.findall(r"\b(assert_finite|assert_ulp|ulp_difference)\(", body)})
    imports = ["from pathlib import Path", ""] if beside else []
    imports += [f"from harness import {', '.join(ours)}"]
    shown = textwrap.fill(command, 80, break_long_words=False, break_on_hyphens=False, subsequent_indent="    ")
    shown = shown.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    return _HEAD.format(command=shown, imports="\n" + "\n".join(imports) + "\n") + "\n" + body


# A name that begins with test_ would be collected where it is imported.
test_module.__test__ = False


def _test(
    finding: Finding,
    file: str,
    defines: Mapping[str, str],
    include_dirs: Sequence[str],
    mode: str,
    beside: Path | None,
) -> str:
    name = finding.inputs.signature.name
    goal = finding.goal
    suffix = "_in_".join([_NAMES[goal.kind], *(re.sub(r"\W+", "_", n) for n in goal.names)])
    options = [_path(file, beside)]
    options += [f"defines={_literal(dict(defines), 2)}"] if defines else []
    options += [f"include_dirs=[{', '.join(_path(d, beside) for d in include_dirs)}]"] if include_dirs else []
    options += [f"mode={_quoted(mode)}"] if mode != "as-written" else []
    lines = [f"def test_{name}_{suffix}():", "    function = shader("]
    lines += [f"        {option}," for option in options]
    lines += [f"    )[{_quoted(name)}]", f"    inputs = {_inputs(finding)}", *_assertions(finding)]
    return "\n".join(lines) + "\n"


def _assertions(finding: Finding) -> list[str]:
    goal = finding.goal
    limit = f"{goal.max_ulp:g}"
    if goal.kind == "ulp":
        return [
            '    double = function.with_mode("double")',
            f"    assert_ulp(function, double, max_ulp={limit}, inputs=inputs)",
        ]
    if goal.kind == "symmetric":
        a, b = goal.names
        return [
            "    swapped = dict(inputs)",
            f"    swapped[{_quoted(a)}], swapped[{_quoted(b)}] = inputs[{_quoted(b)}], inputs[{_quoted(a)}]",
            f"    assert_ulp(function(**inputs), function(**swapped), max_ulp={limit})",
        ]
    if goal.kind == "monotone":
        lower, upper, start, end = (v[0] for v in finding.trial.path(goal.names[0]))
        k = int(np.argmax(_back(lower, upper, start, end)))
        lines = [f"    first, second = function(**inputs).reshape(2, -1)[:, {k}].astype(float)"]
        if start[k] == end[k]:
            return [*lines, "    assert first == second"]
        onward = "first <= second" if start[k] < end[k] else "first >= second"
        return [*lines, f"    assert {onward} or ulp_difference(second, first) <= {limit}"]
    nonnegative = ", nonnegative=True" if goal.kind == "negative" else ""
    return [f"    assert_finite(function, inputs{nonnegative}, intermediates=False)"]


def _back(lower: np.ndarray, upper: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """How far each number goes back from the lower to the upper value, where it should go from start to end."""
    direction = np.sign(end - start)
    return np.where(direction == 0, np.abs(upper - lower), (lower - upper) * direction)


def _inputs(finding: Finding) -> str:
    """The inputs as a dict; of one that moves both values."""
    given = finding.inputs.arguments()
    if finding.goal.kind == "monotone":
        *outer, last = finding.goal.names[0].split(".")
        place = given
        for name in outer:
            place = place[name]
        place[last] = np.array([float(v[0, 0]) for v in finding.trial.steps(finding.goal.names[0])], np.float32)
    return _literal(given, 1)


def _literal(value: Any, depth: int) -> str:
    """A Python literal, over several lines where it is long; floats with their hexadecimal form above them."""
    indent = "    " * (depth + 1)
    if isinstance(value, Mapping):
        entries = []
        for name, member in value.items():
            shown = np.asarray(member) if not isinstance(member, Mapping | str) else None
            if shown is not None and shown.dtype.kind == "f" and shown.size <= 4:
                entries.append(f"{indent}# {' '.join(hexadecimal(v) for v in shown.ravel())}\n")
            entries.append(f"{indent}{_quoted(name)}: {_literal(member, depth + 1)},\n")
        return "{\n" + "".join(entries) + "    " * depth + "}"
    if isinstance(value, str):
        return _quoted(value)
    if np.ndim(value) == 0:
        return str(value)
    flat = f"[{', '.join(_literal(v, 0) for v in value)}]"
    if len(flat) <= _SHORT and "\n" not in flat:
        return flat
    return "[\n" + "".join(f"{indent}{_literal(v, depth + 1)},\n" for v in value) + "    " * depth + "]"


def _quoted(text: str) -> str:
    """As ruff writes it: in double quotes, unless it has some itself."""
    return repr(text) if '"' in text else f'"{repr(text)[1:-1]}"'


def _path(path: str, beside: Path | None) -> str:
    if beside is None:
        return _quoted(path)
    relative = os.path.relpath(path, beside.resolve().parent)
    return f"Path(__file__).parent / {_quoted(Path(relative).as_posix())}"
