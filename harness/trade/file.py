"""A trade in a file: JSON as docs/trade.md describes it."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import HarnessError

SCHEMA = 1
#: what Python writes of numbers that JSON has no word for, and what JSON has: 1e999 is read as an infinity again
_WORDS = {"NaN": "null", "Infinity": "1e999", "-Infinity": "-1e999"}
_WORD = re.compile(r"(?<=[\s\[:])(?:NaN|-?Infinity)(?=[,\s\]}])")


def text(data: Mapping[str, Any]) -> str:
    """The trade as JSON, a member a line."""
    return _WORD.sub(lambda word: _WORDS[word[0]], json.dumps(data, indent=1, ensure_ascii=False)) + "\n"


def read(path: Path) -> dict[str, Any]:
    """The trade in a file. HarnessError when it is not there, or not one that this version writes."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise HarnessError(f"cannot read the trade ({error.strerror}); `make trade` writes it", path) from None
    except ValueError as error:
        raise HarnessError(f"is no JSON ({error}); `make trade` writes it anew", path) from None
    found = data.get("schema") if isinstance(data, dict) else None
    if found != SCHEMA:
        raise HarnessError(f"has schema {found}, not {SCHEMA}; `make trade` writes it anew", path)
    return data
