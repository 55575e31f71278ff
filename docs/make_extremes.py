"""Make docs/extremes.md and its pictures, or check that they are what the shaders do now.

    python docs/make_extremes.py            measure and draw all anew
    python docs/make_extremes.py --check    compare with what is there; write nothing

The texts are in extremes.toml, the measurements in extreme_numbers.py, the pictures in extreme_pictures.py.
"""

from __future__ import annotations

import argparse
import os
import re
import string
import sys
import tempfile
import textwrap
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from extreme_drawing import png
from extreme_numbers import FAMILIES
from extreme_pictures import PICTURES
from extreme_precision import COUNT
from extreme_scenes import MODES, TERMS

from harness import HarnessError

FOLDER = Path(__file__).resolve().parent
DOCUMENT = "extremes.md"
TEXTS = tomllib.loads((FOLDER / "extremes.toml").read_text(encoding="utf-8"))
PRECISION = """\
The share of {} inputs (of the 256 codes, for the decodings) where the term by itself is more than 1 % off its own \
formula in double, or not finite; inputs rounded to half first for `mediump`. Directions are where the highlight is, \
roughness from 0.003 to 1 evenly in its logarithm, cosines from 0.001 likewise. The last column: formula against \
formula, both in double, where a form is more than 1 % off the one that the ladder calls exact."""
WIDTH = 120


class Printed(NamedTuple):
    """A number in the document: what measures it, with which words, how it is printed, and as what it stands there."""

    family: str
    words: str
    format: str
    text: str


# ---- The document ----------------------------------------------------------------------------------------------------


def _anchor(title: str) -> str:
    """The name that GitHub gives to a heading."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def _table(head: list[str], rows: list[list[str]]) -> str:
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows])


def _forms() -> str:
    rows = [
        [f"[`{row['name']}`](#{_anchor(row['section'])})", row["breaks"], row["measured"], row["instead"]]
        for row in TEXTS["form"]
    ]
    return _table(["Form", "Breaks", "Measured", "The default instead"], rows)


def _precisions() -> Iterator[str]:
    yield "## By precision"
    yield PRECISION.format(COUNT)
    rows = []
    for term in TERMS.values():
        for rung in term.rungs:
            shares = [f"{{lost[{rung.value} {mode}]:.1%}}" for mode in MODES]
            rows.append([f"`{rung.value}`", *shares[:3], "exact" if rung.value == term.exact else shares[3]])
    yield _table(["Form", "`as-written`", "`precise`", "`mediump`", "against the exact form"], rows)


def blocks() -> Iterator[str]:
    """The document's paragraphs, headings and tables, numbers still to be filled in."""
    yield f"# {TEXTS['title']}"
    yield from TEXTS["intro"].strip().split("\n\n")
    yield _forms()
    for section in TEXTS["section"]:
        yield f"## {section['title']}"
        yield f"![{section['alt']}](extremes/{section['picture']}.png)"
        yield section["text"].strip()
    yield from _precisions()
    yield f"*Made by [`{Path(__file__).name}`]({Path(__file__).name}); do not edit: `make extremes` makes it anew.*"


def document() -> str:
    """All of it, measured now."""
    return "\n\n".join(_wrapped(block.format_map(FAMILIES)) for block in blocks()) + "\n"


def _wrapped(block: str) -> str:
    if block.startswith(("#", "![", "| ")):
        return block
    return textwrap.fill(block, WIDTH, break_long_words=False, break_on_hyphens=False)


def printed(text: str) -> list[Printed]:
    """The numbers that a document has where these texts ask for them. ValueError where it has another text."""
    asked, pattern = [], ""
    for literal, field, form, _ in string.Formatter().parse(_even("\n\n".join(blocks()))):
        pattern += re.escape(literal)
        if field is not None:
            family, words = field.removesuffix("]").split("[")
            asked.append((family, words, form))
            pattern += r"(\S+?) %" if form.endswith("%") else r"(\S+?)"
    found = re.fullmatch(pattern, _even(text))
    if not found:
        raise ValueError("its text is not that of extremes.toml; make extremes makes it anew")
    return [Printed(*query, shown) for query, shown in zip(asked, found.groups(), strict=True)]


def _even(text: str) -> str:
    return re.sub(r"\s+", " ", text).strip()


# ---- Files -----------------------------------------------------------------------------------------------------------


def files() -> Iterator[tuple[Path, bytes]]:
    """What belongs into a folder such as docs/: paths in it, and contents."""
    for name, rows in PICTURES.items():
        yield Path("extremes", f"{name}.png"), png(rows())
    yield Path(DOCUMENT), document().encode()


def write(path: Path, content: bytes) -> None:
    """Replace a file in one step, so that no reader ever meets half of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=path.name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.chmod(temporary, 0o644)  # mkstemp lets no one else read it
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def main() -> int:
    """Command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--check", action="store_true", help="compare instead of writing; name each file that differs")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="where the files are (default: beside this script)")
    options = parser.parse_args()
    differing = 0
    try:
        for name, content in files():
            path = options.folder / name
            if not options.check:
                write(path, content)
                print(f"{name}: {len(content)} bytes")
            elif not path.exists() or path.read_bytes() != content:
                print(f"{path}: not what the shaders do now; run make extremes", file=sys.stderr)
                differing += 1
    except (OSError, HarnessError) as error:
        print(f"make_extremes.py: {error}", file=sys.stderr)
        return 1
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
