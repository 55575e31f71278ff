"""The report: one HTML page with all that it shows in it, and no scripts."""

from __future__ import annotations

import html
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import HarnessError
from ..info import info
from ..picture import data_address
from .exercise import Exercise

if TYPE_CHECKING:
    from .evidence import Costs, Quoted, Regions, TestResults, Trade

_TEMPLATE = Path(__file__).with_name("report.html.jinja")
LONG = 26  # lines; what is longer is folded
WIDE = 3  # times as wide as high: a row of things


@dataclass(frozen=True)
class Evidence:
    """``quoted`` are the shader lines of each part; ``tests`` is None where they were not run."""

    quoted: Sequence[Sequence[Quoted]]
    regions: Regions
    tests: TestResults | None
    costs: Costs | None
    trade: Trade | None


def write(
    project: Path,
    exercise: Exercise,
    evidence: Evidence,
    picture: np.ndarray,
    findings: Sequence[Mapping[str, Any]],
    files: Sequence[str],
) -> str:
    """The page. ``picture`` is (h, w, 4) uint8, ``findings`` are those of the check as JSON has them, ``files`` what
    the archive holds besides. HarnessError without jinja2."""
    try:
        import jinja2
    except ImportError:
        raise HarnessError("the report needs jinja2: pip install 'shader-harness[submission]'") from None
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["glsl"] = lambda text: jinja2.utils.markupsafe.Markup(highlighted(text))
    environment.filters["sentence"] = sentence
    parts = [
        {
            "part": part,
            "quoted": quoted,
            "crops": [_crop(evidence.regions.crop(picture, region), region.caption) for region in part.regions],
            "tests": [(test, evidence.tests and evidence.tests.of(exercise, test)) for test in part.tests],
        }
        for part, quoted in zip(exercise.parts, evidence.quoted, strict=True)
    ]
    return environment.from_string(_TEMPLATE.read_text()).render(
        project=project.name,
        exercise=exercise,
        parts=parts,
        picture=data_address(picture),
        size=picture.shape[1::-1],
        tests=evidence.tests and evidence.tests.all,
        findings=findings,
        costs=evidence.costs,
        trade=evidence.trade,
        files=files,
        driver=info()["driver"],
        long=LONG,
    )


def _crop(pixels: np.ndarray, caption: str) -> tuple[str, str, bool]:
    """A figure, and whether it takes the width of the page."""
    height, width = pixels.shape[:2]
    return data_address(pixels), caption, width > WIDE * height


def sentence(test: str) -> str:
    """What the name of a test says: FILE::test_D_is_the_formula as "D is the formula"."""
    words = test.partition("::")[2].removeprefix("test_").replace("_", " ")
    return words[:1].upper() + words[1:]


_WORDS = {
    "keyword": r"\b(?:if|else|for|while|return|const|uniform|in|out|inout|struct|void)\b",
    "type": r"\b(?:float|int|uint|bool|[iub]?vec[234]|mat[234]|sampler\w+|Material)\b",
    "number": r"\b\d+\.?\d*(?:e[+-]?\d+)?\b",
}
_GLSL = re.compile(
    r"(?P<comment>//[^\n]*|/\*.*?\*/)|(?P<directive>^[ \t]*#[^\n]*)|"
    + "|".join(f"(?P<{kind}>{pattern})" for kind, pattern in _WORDS.items()),
    re.MULTILINE | re.DOTALL,
)


def highlighted(text: str) -> str:
    """GLSL as HTML, its words marked by kind."""
    done, at = [], 0
    for match in _GLSL.finditer(text):
        done.append(html.escape(text[at : match.start()]))
        done.append(f'<span class="{match.lastgroup}">{html.escape(match[0])}</span>')
        at = match.end()
    return "".join([*done, html.escape(text[at:])])
