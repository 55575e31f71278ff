"""Functions of one float at every float32 in 0 ... 1, a thousand million of them: ``make test-exhaustive``."""

from __future__ import annotations

import numpy as np
import pytest
from checks import CHECKS

VALUES = int(np.float32(1).view(np.uint32)) + 2  # 0 ... 1, both included, and -0


@pytest.mark.parametrize("name", CHECKS)
def test_at_every_float(name):
    found = CHECKS[name].run()
    assert found.count == VALUES
    CHECKS[name].hold(found)
