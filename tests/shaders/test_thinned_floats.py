"""The exhaustive tests of tests/exhaustive at every 4099th float: what a change breaks shows at once."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "exhaustive"))

from checks import CHECKS  # noqa: E402

STRIDE = 4099  # a prime: no place among the binary digits is left out


@pytest.mark.parametrize("name", CHECKS)
def test_at_every_4099th_float(name):
    found = CHECKS[name].run(STRIDE)
    assert found.count > 250_000
    CHECKS[name].hold(found)
