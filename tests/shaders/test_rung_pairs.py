"""Any two rungs of the ladder go together.

Apart from the other tests of shade(), for it compiles many models: what they notice of a fault in the shaders needs a
rung or two alone, and trying each fault in all of these would take long.
"""

from __future__ import annotations

import pytest
from rungs import name, pairs
from test_shade_rungs import assert_is_its_terms

from harness import shader


@pytest.mark.parametrize("model", pairs(), ids=name)
def test_any_two_rungs_go_together(root, model):
    assert_is_its_terms(shader(root / "shaders" / "brdf.glsl", defines=model), model)
