"""What scenes can do without, by what their .sprj says afterwards."""

from __future__ import annotations

import re

import numpy as np
import pytest
import tune_scenes
from PIL import Image
from tune_scenes import ROOT, SIZE, attribute, bound, define

from harness import ladder
from harness.check import check
from harness.projects import sprj
from harness.rendering.prepare import prepare
from harness.tune import Budget, needs, tune

EXACT = {"SRGB_DECODE": "SRGB_PIECEWISE"}


def without(path) -> str:
    """The project without what it does not need, layouts last."""
    data = path.read_bytes()
    for need in needs.find(path, data, ladder.load(path.parent / "shaders" / "ladder.toml"), EXACT):
        data = need.apply(data)
    project = sprj.read(path, data=data)
    for need in needs.find_layouts(project, prepare(project), data):
        data = need.apply(data)
    return data.decode()


def image(folder, name: str, *color: int) -> None:
    Image.new("RGB", (4, 4), color).save(folder / name)


def test_a_constant_base_colour_becomes_a_linear_uniform(tmp_path):
    """By the curve of IEC 61966-2-1: 51/255 = 0.2 is ((0.2 + 0.055) / 1.055)^2.4."""
    image(tmp_path, "Color.png", 255, 51, 0)
    constants = {"roughness": (0.5,), "metalness": (0.5,)}
    path = tune_scenes.write(
        tmp_path,
        tune_scenes.text(constants, {"HAS_ALBEDO_MAP": "1"}, ("Color.png",), ("Position", "Normal", "Texcoord")),
    )
    text = without(path)
    (line,) = re.findall(r'name="albedo"><row>(.*)</row>', text)
    values = [float(v) for v in re.findall(r"<value>(.*?)</value>", line)]
    np.testing.assert_allclose(values, [1, ((0.2 + 0.055) / 1.055) ** 2.4, 0], rtol=1e-6)
    assert re.sub(r"\n.*name=\"albedo\".*", "", text) == tune_scenes.text(constants)


def test_a_metalness_between_the_two_becomes_a_uniform(tmp_path):
    image(tmp_path, "Metalness.png", 51, 51, 51)
    constants = {"albedo": (1, 1, 1), "roughness": (0.5,)}
    path = tune_scenes.write(
        tmp_path,
        tune_scenes.text(constants, {"HAS_METALNESS_MAP": "1"}, ("Metalness.png",), ("Position", "Normal", "Texcoord")),
    )
    assert without(path) == tune_scenes.text(constants | {"metalness": (0.2,)})


def test_values_of_items_go_with_a_uniform_that_takes_a_maps_place(tmp_path):
    image(tmp_path, "Roughness.png", 51, 51, 51)
    constants = {"albedo": (1, 1, 1), "metalness": (0.5,), "roughness": (0.9,)}
    first = '\n        <value variable="roughness" for="Ball"><row><value>1</value></row></value>'
    other = '\n        <value variable="metalness" for="Ball"><row><value>0.3</value></row></value>'
    items, values = "\n      </items>", "\n      <itemvalues>{}\n      </itemvalues>"
    text = tune_scenes.text(
        constants, {"HAS_ROUGHNESS_MAP": "1"}, ("Roughness.png",), ("Position", "Normal", "Texcoord")
    )
    path = tune_scenes.write(tmp_path, text.replace(items, items + values.format(first + other)))
    wanted = tune_scenes.text(constants | {"roughness": (0.2,)}).replace(items, items + values.format(other))
    assert without(path) == wanted


def test_a_texture_that_nothing_reads_is_not_bound(tmp_path):
    """METALNESS is fixed, and the map is still there; the one after it keeps its sampler."""
    image(tmp_path, "Metalness.png", 10, 200, 60)
    Image.fromarray(np.random.default_rng(1).integers(100, 160, (8, 8, 3), np.uint8)).save(tmp_path / "NormalGL.png")
    constants = {"albedo": (1, 1, 1), "roughness": (0.5,)}
    layout = ("Position", "Normal", "Texcoord", "Tangent")
    macros = {"METALNESS": "1", "HAS_METALNESS_MAP": "1", "HAS_NORMAL_MAP": "1"}
    path = tune_scenes.write(tmp_path, tune_scenes.text(constants, macros, ("Metalness.png", "NormalGL.png"), layout))
    wanted = tune_scenes.text(constants, {"METALNESS": "1", "HAS_NORMAL_MAP": "1"}, ("x.png", "NormalGL.png"), layout)
    assert without(path) == wanted.replace(bound("x.png", 0), "")


@pytest.mark.parametrize("color", [(200, 128, 220), (128, 140, 255)])
def test_a_tilted_normal_map_is_needed(tmp_path, color):
    image(tmp_path, "NormalGL.png", *color)
    constants = {"albedo": (1, 1, 1), "roughness": (0.5,), "metalness": (0.5,)}
    text = tune_scenes.text(
        constants, {"HAS_NORMAL_MAP": "1"}, ("NormalGL.png",), ("Position", "Normal", "Texcoord", "Tangent")
    )
    assert without(tune_scenes.write(tmp_path, text)) == text


def test_a_map_that_is_on_by_default_is_switched_off(tmp_path):
    path = tune_scenes.write(
        tmp_path,
        tune_scenes.text(
            {"albedo": (1, 1, 1), "metalness": (0.5,)},
            {"HAS_ROUGHNESS_MAP": "1"},
            ("Roughness.png",),
            ("Position", "Normal", "Texcoord"),
        ),
    )
    image(tmp_path, "Roughness.png", 51, 51, 51)
    features = tmp_path / "shaders" / "features.glsl"
    features.write_text(features.read_text().replace("#define HAS_ROUGHNESS_MAP 0", "#define HAS_ROUGHNESS_MAP 1"))
    assert define("HAS_ROUGHNESS_MAP", "0") in without(path)


def two_passes(folder, second_layout: tuple[str, ...], path: str = "models/pot.glb") -> tuple:
    """Pots without maps in one pass, which has the layout of a pass with a normal map; and that pass."""
    (folder / "models").mkdir()
    (folder / "models" / "pot.glb").symlink_to(ROOT / "models" / "teapot.glb")
    (folder / "models" / "other.glb").symlink_to(ROOT / "models" / "teapot.glb")
    Image.fromarray(np.random.default_rng(1).integers(100, 160, (8, 8, 3), np.uint8)).save(folder / "NormalGL.png")
    full = ("Position", "Normal", "Texcoord", "Tangent")
    constants = {"albedo": (1, 1, 1), "roughness": (0.5,), "metalness": (0.5,)}
    plain = tune_scenes.text(constants, layout=full)
    mapped = tune_scenes.text(constants, {"HAS_NORMAL_MAP": "1"}, ("NormalGL.png",), second_layout)
    model = '<item name="{}" type="model"><filepath>{}</filepath></item>'
    plain = re.sub(r'<item name="Box".*', model.format("Pot", "models/pot.glb"), plain)
    mapped = re.sub(r'<item name="Ball".*', "", re.sub(r'<item name="Box".*', model.format("Pot2", path), mapped))
    second = re.search(r"\n    <pass.*</pass>", mapped, re.DOTALL)[0].replace('"Balls"', '"Bumps"')
    text = plain.replace("\n  </pipeline>", f"{second}\n  </pipeline>")
    text = text.replace("\n  </objects>", bound("NormalGL.png", 0).replace('"Balls"', '"Bumps"') + "\n  </objects>")
    return tune_scenes.write(folder, text), text


def test_passes_that_share_a_model_keep_what_one_of_them_reads(tmp_path):
    path, text = two_passes(tmp_path, ("Position", "Normal", "Texcoord", "Tangent"))
    assert without(path) == text


def test_passes_with_models_of_their_own_do_not(tmp_path):
    path, text = two_passes(tmp_path, ("Position", "Normal", "Texcoord", "Tangent"), "models/other.glb")
    taken = attribute("Texcoord") + attribute("Tangent")
    assert without(path) == text.replace(taken, "", 1)


def test_passes_that_share_a_model_are_trimmed_alike(tmp_path):
    full = ("Position", "Normal", "Texcoord", "Tangent", "Bitangent")
    path, text = two_passes(tmp_path, full)
    text = text.replace(attribute("Tangent"), attribute("Tangent") + attribute("Bitangent"), 1)  # of the first pass
    text = text.replace(attribute("Bitangent") * 2, attribute("Bitangent"))
    path.write_text(text)
    assert text.count(attribute("Bitangent")) == 2
    assert without(path) == text.replace(attribute("Bitangent"), "")
    assert not any(f.code == "HS506" for f in check(path))


def test_what_shows_in_the_picture_is_kept(tmp_path):
    """A map that is constant but for its last bit, of a mirror: by default the budget lets its constant through, with
    a budget of nothing at all it does not."""
    image = np.full((8, 8, 3), 102, np.uint8)
    image[:, ::2] = 103
    Image.fromarray(image).save(tmp_path / "Roughness.png")
    path = tune_scenes.write(
        tmp_path,
        tune_scenes.text(
            {"albedo": (1, 1, 1), "metalness": (0.5,)},
            {"HAS_ROUGHNESS_MAP": "1"},
            ("Roughness.png",),
            ("Position", "Normal", "Texcoord"),
        ),
    )
    (tmp_path / "shaders" / "ladder.toml").unlink()  # the rungs are another matter
    loose, strict = (tune(path, Budget(limit), n_views=2, size=SIZE) for limit in (8, 0))
    assert [c.text.split()[0] for c in loose.choices] == ["Roughness.png", "Texcoord"]
    assert loose.choices[0].alone.max > 0
    assert strict.choices == () and not strict.changes
