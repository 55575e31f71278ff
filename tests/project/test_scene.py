"""The scene of the exercise, as project.sprj shows it."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image
from variants import PROJECT, floats, only, read_project, with_fragment, with_item_values, with_values

from harness import render, render_floats

GOLDEN = "golden-320x180.png"
#: Codes of 255 by which another processor's picture may differ. Between vendors pow and normalize differ by some ulps,
#: relative 1e-5 at most; the encoding turns that into less than 0.01 of a code, and the sharpest highlight, of alpha
#: 0.0025, 3e-7 of a normal into 0.2 of one. So a code can tip over to its neighbour, and no more.
GOLDEN_TOLERANCE = 1
ROWS = {"Metals": "Metal", "Dielectrics": "Dielectric"}
#: so little light that the sharpest highlight stays in the linear piece of the sRGB curve, which is a factor of 12.92
DIM = 1e-8


@pytest.fixture(scope="module")
def project():
    return read_project()


def roughness_of(project, row):
    (shader_pass,) = (p for p in project.passes if p.name == row)
    return {v.item: v.value[0] for v in shader_pass.item_values if v.variable.name == "roughness"}


def test_the_picture_is_the_golden_one(request):
    golden = np.asarray(Image.open(request.path.parent / GOLDEN).convert("RGB"), int)
    got = render(PROJECT, (320, 180))[..., :3].astype(int)
    assert np.abs(got - golden).max() <= GOLDEN_TOLERANCE


@pytest.mark.parametrize("row", ROWS)
def test_a_row_has_at_least_six_teapots(project, row):
    assert len(roughness_of(project, row)) >= 6


@pytest.mark.parametrize("row", ROWS)
def test_roughness_increases_from_right_to_left_over_the_useful_range(project, row):
    (shader_pass,) = (p for p in project.passes if p.name == row)
    roughness = roughness_of(project, row)
    from_right = [roughness[i.name] for i in sorted(shader_pass.items, key=lambda i: -i.position[0])]
    assert from_right == sorted(from_right)
    assert len(set(from_right)) == len(from_right)
    assert from_right[0] <= 0.05
    assert from_right[-1] == 1


def test_metals_stand_behind_dielectrics(project):
    depth = {p.name: [i.position[2] for i in p.items] for p in project.passes}
    assert max(depth["Metals"]) < min(depth["Dielectrics"])


def highlight(project, row, item, roughness):
    """The linear radiance of one teapot under the key light alone, less its diffuse part: (h, w)."""
    lit = with_values(
        only(project, row, [item]), key_irradiance=(DIM,) * 3, fill_irradiance=(0, 0, 0), rim_irradiance=(0, 0, 0)
    )
    lit = with_item_values(lit, "albedo", lambda _: (0.8, 0.8, 0.8))
    shiny, dull = (
        floats(with_item_values(lit, "roughness", lambda _, r=r: (r,)), (640, 360)) for r in (roughness, 0.0)
    )
    return (shiny - dull)[..., 0] / (12.92 * DIM)


@pytest.mark.parametrize("row", ROWS)
def test_highlights_widen_with_roughness_along_a_row(project, row):
    """On one and the same teapot, so that only roughness differs: how many pixels share the highlight's light, counted
    as (sum s)^2 / sum s^2."""
    roughnesses = sorted(r for r in roughness_of(project, row).values() if r > 0)
    shapes = [highlight(project, row, f"{ROWS[row]}4", r) for r in roughnesses]
    areas = [s.sum() ** 2 / (s**2).sum() for s in shapes]
    assert areas == sorted(areas)
    assert areas[-1] > 20 * areas[0]


@pytest.mark.parametrize("row", ROWS)
def test_highlights_grow_dimmer_with_roughness(project, row):
    """The same light spread wider."""
    roughnesses = sorted(r for r in roughness_of(project, row).values() if r >= 0.15)
    peaks = [highlight(project, row, f"{ROWS[row]}4", r).max() for r in roughnesses]
    assert peaks == sorted(peaks, reverse=True)


def test_metals_show_no_diffuse_light(project):
    """At roughness 0 only a diffuse part could be seen, and there is none: black to the last bit."""
    smooth = with_item_values(only(project, "Metals"), "roughness", lambda _: (0.0,))
    assert (floats(smooth)[..., :3] == 0).all()


def test_dielectrics_show_their_diffuse_colour(project):
    """The same of the front row is not black: that the test above can fail."""
    smooth = with_item_values(only(project, "Dielectrics"), "roughness", lambda _: (0.0,))
    assert (floats(smooth)[..., :3].sum(-1) > 0.1).mean() > 0.05


def test_the_framebuffer_holds_only_numbers_that_a_screen_shows():
    pixels = render_floats(PROJECT, (640, 360))
    assert np.isfinite(pixels).all()
    assert pixels.min() >= 0
    assert pixels.max() <= 1


def test_the_teapot_of_roughness_zero_is_clean(project):
    """No light without extent in a mirror: nothing brighter than a Lambertian surface that faces all three lights."""
    pixels = floats(only(project, "Dielectrics", ["Dielectric7"]), (640, 360))[..., :3]
    (shader_pass,) = (p for p in project.passes if p.name == "Dielectrics")
    lights = np.sum([v.value for v in shader_pass.variables if v.name.endswith("irradiance")], axis=0)
    (albedo,) = (v.value for v in shader_pass.item_values if (v.variable.name, v.item) == ("albedo", "Dielectric7"))
    brightest = 1.055 * (np.array(albedo) * lights / np.pi) ** (1 / 2.4) - 0.055
    assert (pixels <= brightest + 1e-6).all()
    assert pixels.max() > 0.1


INPUTS_FRAG = """#version 330
in vec3 world_position;
in vec3 world_normal;
uniform vec3 albedo;
uniform float roughness;
layout(location = 0) out vec4 color;
void main() {{ color = vec4({}, 1.0); }}
"""


def shaded(position, normal, albedo, roughness, metalness, lights, eye):
    """The exercise's formulas in float64, for arrays (n, 3) and (n, 1): linear radiance."""

    def unit(a):
        return a / np.linalg.norm(a, axis=-1, keepdims=True)

    def dot(a, b):
        return (a * b).sum(-1, keepdims=True)

    n, v = unit(normal), unit(eye - position)
    NoV = dot(n, v)
    a2 = roughness**4
    F0 = 0.04 * (1 - metalness) + albedo * metalness
    total = np.zeros_like(position)
    for direction, irradiance in lights:
        l = unit(np.broadcast_to(np.array(direction, float), v.shape))  # noqa: E741
        NoL = dot(n, l)
        h = unit(l + v)
        F = F0 + (1 - F0) * (1 - dot(l, h)) ** 5
        with np.errstate(divide="ignore", invalid="ignore"):
            D = a2 / (np.pi * (1 - dot(n, h) ** 2 * (1 - a2)) ** 2)
            V = 0.5 / (NoV * np.sqrt(a2 + NoL**2 * (1 - a2)) + NoL * np.sqrt(a2 + NoV**2 * (1 - a2)))
            highlight = np.where(a2 > 0, D * V, 0)
        specular = F * np.where(np.isfinite(highlight), highlight, 0)
        value = (specular + (1 - F) * (1 - metalness) * albedo / np.pi) * NoL * irradiance
        total += np.where((NoL > 0) & (NoV > 0), value, 0)
    return total


@pytest.mark.parametrize(("row", "metalness"), [("Metals", 1.0), ("Dielectrics", 0.0)])
def test_every_pixel_of_a_row_is_the_model(project, tmp_path, row, metalness):
    """From the mesh's own positions and normals: at grazing angles, in highlights, at roughness 0. A NaN that became
    black or an Inf that became white would stand out."""
    size = (640, 360)
    shown = only(project, row)
    inputs = {}
    for name in ("world_position", "world_normal", "albedo", "vec3(roughness)"):
        path = tmp_path / "inputs.frag"
        path.write_text(INPUTS_FRAG.format(name))
        inputs[name] = floats(with_fragment(shown, path), size)[..., :3].astype(float)
    covered = np.abs(inputs["world_normal"]).sum(-1) > 0
    position, normal, albedo, roughness = (image[covered] for image in inputs.values())
    variables = {v.name: v.value for v in shown.passes[0].variables}
    lights = [(variables[f"{n}_direction"], np.array(variables[f"{n}_irradiance"])) for n in ("key", "fill", "rim")]
    pitch = np.radians(shown.settings.camera.pitch)
    eye = shown.settings.camera.distance * np.array([0, np.sin(pitch), np.cos(pitch)])  # yaw 180: on +z

    linear = np.clip(shaded(position, normal, albedo, roughness[:, :1], metalness, lights, eye), 0, 1)
    want = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    got = floats(shown, size)[..., :3][covered]
    assert covered.mean() > 0.04
    # float32 vectors leave D an error of 5e-4 at roughness 0.05, less at others: far below a code
    assert np.abs(got - want).max() < 1 / 255
    assert np.median(np.abs(got - want)) < 1e-5
