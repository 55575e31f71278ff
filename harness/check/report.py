"""Findings as text for people, as JSON, and as SARIF 2.1.0 for services that show them beside the code."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from pathlib import PurePath

from .findings import RULES, SEVERITIES, Finding

FORMATS = ("text", "json", "sarif")
SCHEMA_VERSION = 1  # of the JSON; grows when a member changes its meaning or goes
_SARIF_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_COLORS = {"error": "31", "warning": "33", "note": "36"}


def counts(findings: Sequence[Finding]) -> dict[str, int]:
    """Severity -> how many."""
    there = Counter(f.severity for f in findings)
    return {severity: there[severity] for severity in SEVERITIES}


def text(findings: Sequence[Finding], *, color: bool = False) -> str:
    """A line for each finding, as compilers print them, why it bites and the fix below, and a line of counts."""

    def painted(what: str, code: str) -> str:
        return f"\033[{code}m{what}\033[0m" if color else what

    lines = []
    for f in findings:
        place = painted(f"{f.file}:{f.line}:" if f.line else f"{f.file}:", "1")
        lines.append(f"{place} {painted(f'{f.severity} {f.code}', _COLORS[f.severity])}: {f.message}")
        lines.append(f"    why: {f.why}")
        lines.append(f"    fix: {f.fix}")
    lines.append(summary(findings))
    return "\n".join(lines) + "\n"


def summary(findings: Sequence[Finding]) -> str:
    """How many of which severity."""
    there = [f"{n} {severity}{'s' * (n != 1)}" for severity, n in counts(findings).items() if n]
    return ", ".join(there) or "nothing found"


def as_json(project: str, findings: Sequence[Finding]) -> str:
    """The findings as docs/check.md describes them."""
    return (
        json.dumps(
            {
                "version": SCHEMA_VERSION,
                "project": project,
                "counts": counts(findings),
                "findings": [
                    {
                        "code": f.code,
                        "severity": f.severity,
                        "file": PurePath(f.file).as_posix(),
                        "line": f.line,
                        "message": f.message,
                        "why": f.why,
                        "fix": f.fix,
                    }
                    for f in findings
                ],
            },
            indent=1,
        )
        + "\n"
    )


def as_sarif(findings: Sequence[Finding], version: str) -> str:
    """The findings as a SARIF 2.1.0 log of one run, with the rules that were broken."""
    codes = sorted({f.code for f in findings})
    driver = {
        "name": "harness check",
        "version": version,
        "rules": [
            {
                "id": code,
                "shortDescription": {"text": RULES[code].title},
                "fullDescription": {"text": RULES[code].why},
                "defaultConfiguration": {"level": RULES[code].severity},
            }
            for code in codes
        ],
    }
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "results": [_result(f, codes) for f in findings],
    }
    return json.dumps({"$schema": _SARIF_SCHEMA, "version": "2.1.0", "runs": [run]}, indent=1) + "\n"


def _result(finding: Finding, codes: list[str]) -> dict:
    path = PurePath(finding.file)
    place: dict = {"artifactLocation": {"uri": path.as_uri() if path.is_absolute() else _relative_uri(path)}}
    if finding.line:
        place["region"] = {"startLine": finding.line}
    return {
        "ruleId": finding.code,
        "ruleIndex": codes.index(finding.code),
        "level": finding.severity,
        "message": {"text": f"{finding.message}. Fix: {finding.fix}."},
        "locations": [{"physicalLocation": place}],
    }


def _relative_uri(path: PurePath) -> str:
    from urllib.parse import quote

    return quote(path.as_posix())


def rules() -> str:
    """All codes with a line each."""
    return "\n".join(f"{code} {rule.severity:<7} {rule.title}" for code, rule in RULES.items())


def explain(code: str) -> str:
    """What there is to say of a code."""
    rule = RULES[code]
    return f"{code} ({rule.severity}): {rule.title}\n{rule.why}\n"
