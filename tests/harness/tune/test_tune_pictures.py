"""Pictures of one project under many sets of macros. Expected: what the renderer shows of a project of these macros."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import tune_scenes
from tune_scenes import SIZE

from harness import GlslError
from harness.projects import sprj
from harness.projects.project import Macro
from harness.rendering.render import Renderer
from harness.tune import views
from harness.tune.pictures import Pictures, with_macros


def rendered(path, view, **macros: str) -> np.ndarray:
    def change(project):
        (only,) = project.passes
        kept = tuple(m for m in only.macros if m.name not in macros)
        return replace(project, passes=(replace(only, macros=kept + tuple(Macro(n, v, 1) for n, v in macros.items())),))

    renderer = Renderer(path, SIZE, change=change)
    renderer.look(view)
    renderer.draw()
    return renderer.picture()


@pytest.fixture
def textured(tmp_path):
    path = tune_scenes.textured(tmp_path)
    project = sprj.read(path)
    counted = []
    return path, Pictures(project, views.orbit(project, 2), SIZE, lambda: counted.append(1)), counted


#: one changes the arithmetic, one what a texture's numbers mean, one which textures are read at all
SETS = [{}, {"BRDF_V": "V_HAMMON"}, {"SRGB_DECODE": "SRGB_PIECEWISE", "HAS_MIRRORED_UV": "0"}, {"METALNESS": "1"}]


def test_each_set_shows_what_the_renderer_shows(textured):
    path, pictures, counted = textured
    for macros in [*SETS, *SETS]:  # and again, after the others
        look = pictures.look({"Balls": macros})
        for view in (1, 0):
            np.testing.assert_array_equal(look(view)[..., :3], rendered(path, pictures.views[view], **macros)[..., :3])
    assert len(counted) == 2 * 2 * len(SETS)
    assert len({pictures.look({"Balls": macros})(0).tobytes() for macros in SETS}) == len(SETS)


def test_a_pass_is_linked_once_a_set(textured):
    _, pictures, _ = textured
    first, again = (pictures.passes({"Balls": {"BRDF_V": "V_HAMMON"}}) for _ in range(2))
    assert first[0] is again[0] is not pictures.passes({})[0]
    assert first[0].textures[0].texture is pictures.passes({})[0].textures[0].texture


def test_macros_that_do_not_compile_are_the_users_error(textured):
    _, pictures, _ = textured
    with pytest.raises(GlslError, match='in pass "Balls"'):
        pictures.look({"Balls": {"METALNESS": "nonsense"}})


def test_a_pass_keeps_the_order_of_its_macros():
    before = sprj.read(tune_scenes.ROOT / "project.sprj").passes[1]
    after = with_macros(before, {"METALNESS": "0", "X": "1"})
    assert [m.name for m in after.macros] == [*(m.name for m in before.macros), "X"]
    assert [m.value for m in after.macros if m.name in ("METALNESS", "X")] == ["0", "1"]
