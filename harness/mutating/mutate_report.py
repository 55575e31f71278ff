"""What became of the mutants: a table by kind, the survivors as differences, and all of it as JSON."""

from __future__ import annotations

import difflib
import json
import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import HarnessError
from .mutants import KINDS

if TYPE_CHECKING:
    from .mutate import Mutation, Result

STATUSES = ("killed", "timeout", "survived", "equivalent", "same", "invalid")
#: those that tests can notice
_FAIR = ("killed", "timeout", "survived")


def table(results: Sequence[Result]) -> str:
    """Kinds by statuses, and the score."""
    counts = Counter((result.mutant.kind, result.status) for result in results)
    kinds = [kind for kind in KINDS if any(counts[kind, status] for status in STATUSES)]
    rows = [("", "made", *STATUSES)]
    for kind in kinds:
        of_kind = [counts[kind, status] for status in STATUSES]
        rows.append((kind, str(sum(of_kind)), *(str(n or "") for n in of_kind)))
    totals = [sum(counts[kind, status] for kind in kinds) for status in STATUSES]
    rows.append(("all", str(sum(totals)), *map(str, totals)))
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = [
        "  ".join([row[0].ljust(widths[0]), *(cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True))])
        for row in rows
    ]
    fair = sum(result.status in _FAIR for result in results)
    survived = sum(result.status == "survived" for result in results)
    score = f"{fair - survived} of {fair} noticed" + (f", {100 * (1 - survived / fair):.1f} %" if fair else "")
    return "\n".join([*(line.rstrip() for line in lines), score])


def difference(mutation: Mutation, result: Result) -> str:
    """Where a mutant is, its name for the list of equivalent ones, and a unified diff of the file."""
    mutant = result.mutant
    name = f"{Path(mutation.path).name}:{mutant.id}"
    reached = f"reached by {result.tests} test{'s' * (result.tests != 1)}"
    before, after = (text.splitlines(keepends=True) for text in (mutation.text, mutant.apply(mutation.text)))
    diff = "".join(difflib.unified_diff(before, after, mutation.path, name, n=1))
    return f"{mutation.path}:{mutant.line}: {name}: {reached}\n{diff}"


def listing(mutation: Mutation) -> str:
    """One line a mutant: place, name, and the line as it becomes."""
    lines = []
    for result in mutation.results:
        mutant = result.mutant
        after = mutant.apply(mutation.text).split("\n")[mutant.line - 1].strip()
        status = "" if result.status in ("to run", "survived") else f" ({result.status})"
        lines.append(f"{mutation.path}:{mutant.line}:{mutant.column}: {mutant.id}{status}: {after}")
    return "\n".join(lines)


def write_json(mutation: Mutation, path: str | Path) -> None:
    """Writes all results, whole or not at all. HarnessError where that cannot be done."""
    path = Path(path)
    entries = [
        {
            "id": f"{Path(mutation.path).name}:{result.mutant.id}",
            "line": result.mutant.line,
            "column": result.mutant.column,
            "kind": result.mutant.kind,
            "function": result.mutant.function,
            "status": result.status,
            "by": result.by,
            "tests": result.tests,
            "difference": difference(mutation, result),
        }
        for result in mutation.results
    ]
    unfinished = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        unfinished.write_text(json.dumps({"file": mutation.path, "mutants": entries}, indent=1) + "\n")
        unfinished.replace(path)
    except OSError as error:
        unfinished.unlink(missing_ok=True)
        raise HarnessError(f"cannot write the report: {error.strerror}", path) from None
