"""Tuning whole scenes. What is written is looked at with the renderer and the costs alone, rung by rung, without what
the search knew."""

from __future__ import annotations

import functools
import itertools

import numpy as np
import pytest
import tune_scenes
from tune_scenes import SIZE

from harness import HarnessError, ladder
from harness.check import check
from harness.projects import sprj
from harness.projects.project import Macro, Project
from harness.rendering.render import Renderer
from harness.tune import Budget, edit, tune
from harness.tune.stage_cost import Costs

VIEWS = 4
#: scene -> largest change of a channel in 1/255 that it may have
SCENES = {tune_scenes.rough_dielectric: 2, tune_scenes.smooth_metal: 1, tune_scenes.textured: 6}


def under(**macros: str):
    """A change of a project: all its passes under other macros."""

    def change(project: Project) -> Project:
        passes = []
        for p in project.passes:
            kept = [m for m in p.macros if m.name not in macros]
            passes.append(type(p)(**{**vars(p), "macros": (*kept, *(Macro(n, v, 1) for n, v in macros.items()))}))
        return type(project)(**{**vars(project), "passes": tuple(passes)})

    return change


def pictures(path, cameras, change=None) -> np.ndarray:
    """(view, h, w, 3): what the renderer shows from each camera."""
    renderer = Renderer(path, SIZE, change=change)
    found = []
    for camera in cameras:
        renderer.look(camera)
        renderer.draw()
        found.append(renderer.picture()[..., :3].astype(int))
    return np.stack(found)


def costs(path, *changes) -> list[float]:
    """Cycles on navi21 of the scene's one pass, after each of some changes."""
    projects = [change(sprj.read(path)) for change in changes]
    passes = [p.passes[0] for p in projects]
    return [c.cycles for c in Costs(projects[0], passes[:1], "navi21").of(passes)]


class Tuned:
    """A scene before and after."""

    def __init__(self, make, folder):
        self.limit = SCENES[make]
        self.path = make(folder)
        self.before = self.path.with_name("before.sprj")
        self.before.write_bytes(self.path.read_bytes())
        self.findings = {(f.code, f.message) for f in check(self.path)}
        self.tuning = tune(self.path, Budget(self.limit), n_views=VIEWS, size=SIZE, write_back=True)
        self.ladder = ladder.load(folder / "shaders" / "ladder.toml")
        self.exact = under(**self.ladder.preset("exact").macros)
        self.cameras = self.tuning.views
        self.reference = pictures(self.before, self.cameras, self.exact)

    def off(self, change=None) -> int:
        """The largest change of a channel of the scene as it was written."""
        return int(np.abs(pictures(self.path, self.cameras, change) - self.reference).max())


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    """Each scene, tuned once."""
    return functools.cache(lambda make: Tuned(make, tmp_path_factory.mktemp(make.__name__)))


@pytest.fixture(params=SCENES, ids=lambda make: make.__name__)
def scene(request, scenes):
    return scenes(request.param)


def test_the_choice_is_within_the_budget(scene):
    assert scene.off() <= scene.limit
    assert scene.off() == scene.tuning.chosen.max


def test_the_scene_is_in_the_pictures(scene):
    assert len(scene.cameras) == VIEWS
    assert all((view.max(axis=-1) > 40).mean() > 0.02 for view in scene.reference)
    assert all((a != b).any() for a, b in itertools.combinations(scene.reference, 2))


def test_the_choice_is_cheaper_than_the_exact_preset(scene):
    (before,), (after,) = costs(scene.before, scene.exact), costs(scene.path, under())
    assert after < before
    (counted,) = scene.tuning.costs
    assert (counted.reference, counted.chosen) == (before, after)
    assert sum(choice.saves for choice in scene.tuning.choices) == pytest.approx(before - after)


def test_no_single_further_step_is_within_the_budget(scene):
    rungs = [(term.macro, rung.value) for term in scene.ladder.terms for rung in term.rungs]
    chosen, *others = costs(scene.path, under(), *(under(**dict([step])) for step in rungs))
    further = [step for step, cost in zip(rungs, others, strict=True) if cost < chosen]
    within = [step for step in further if scene.off(under(**dict([step]))) <= scene.limit]
    assert within == []
    assert {(r.macro, r.rung) for r in scene.tuning.refused} == set(further)


def test_what_is_written_brings_no_new_finding(scene):
    assert {(f.code, f.message) for f in check(scene.path)} <= scene.findings
    assert not any(f.code.startswith("HS6") for f in check(scene.path))


def test_writing_again_changes_nothing(scenes):
    scene = scenes(tune_scenes.textured)
    there = scene.path.read_bytes()
    again = tune(scene.path, Budget(scene.limit), n_views=VIEWS, size=SIZE, write_back=True)
    assert scene.path.read_bytes() == there
    assert not again.changes and [c for c in again.choices if c.macro is None] == []


def test_only_the_choices_are_other_bytes(tmp_path):
    path = tune_scenes.textured(tmp_path)
    tuning = tune(path, Budget(1), n_views=2, size=SIZE, write_back=True)
    wanted = tune_scenes.text(
        {"roughness": (0.6,)},
        {"HAS_ALBEDO_MAP": "1", "METALNESS": "0"},
        ("Color.png",),
        ("Position", "Normal", "Texcoord"),
    )
    written = path.read_text()
    rungs = [tune_scenes.define(*rung) for rung in tuning.macros["Balls"].items()]
    assert any(rung in written for rung in rungs)
    for rung in rungs:
        written = written.replace(rung, "")
    assert written == wanted


def test_a_budget_by_flip(tmp_path):
    """It lets through what a budget for each pixel does not."""
    path = tune_scenes.rough_dielectric(tmp_path)
    tuning = tune(path, Budget(flip=0.05), n_views=1, size=(48, 27))
    assert 0 < tuning.chosen.flip <= 0.05 and tuning.chosen.max > SCENES[tune_scenes.rough_dielectric]
    assert all(r.more_than.flip > 0.05 for r in tuning.refused)


def test_a_file_that_changes_meanwhile_is_left_alone(tmp_path):
    path = tune_scenes.rough_dielectric(tmp_path)
    other = path.read_bytes().replace(b"by hand", b"by another hand")
    with pytest.raises(HarnessError, match="has changed"):
        tune(path, Budget(1), n_views=1, size=(16, 9), write_back=True, drawn=lambda: path.write_bytes(other))
    assert path.read_bytes() == other


def test_what_would_not_render_as_found_is_not_written(tmp_path, monkeypatch):
    """An edit that goes wrong."""
    path = tune_scenes.smooth_metal(tmp_path)
    there, right = path.read_bytes(), edit.set_macro
    wrong = {"METALNESS": "1", "TONE_CURVE": "TONE_REINHARD"}

    def set_macro(data, pass_name, name, value):
        name = name if name == "METALNESS" else "TONE_CURVE"
        return right(data, pass_name, name, wrong[name])

    monkeypatch.setattr(edit, "set_macro", set_macro)
    with pytest.raises(HarnessError, match="does not render"):
        tune(path, Budget(1), n_views=1, size=(16, 9), write_back=True)
    assert path.read_bytes() == there
