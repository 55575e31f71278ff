"""docs/extremes.md: its numbers are what the shaders do, no form is left out, and its pictures are there.

Numbers of `precise` and `double` have to be as printed. Others may be off by a tenth, and by one in the last digit
printed: another processor rounds `mediump` and `as-written` otherwise.
"""

from __future__ import annotations

import importlib
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

DOCS = Path(__file__).resolve().parents[1] / "docs"
sys.path.insert(0, str(DOCS))
make_extremes = importlib.import_module("make_extremes")
extreme_numbers = importlib.import_module("extreme_numbers")
extreme_drawing = importlib.import_module("extreme_drawing")
FAMILIES = extreme_numbers.FAMILIES

#: what takes longest to measure, by the words that are measured here all the same
SLOW = {
    "lost": r"D_(EXERCISE|CROSS|ONE_MINUS) |SRGB_",
    "furnace_most": r"dielectric \.045 DIFFUSE_FRESNEL",
    "furnace_least": r"metal 1 MULTI_",
}
EXACT = ("precise", "double")


@pytest.fixture(scope="module")
def text():
    return (DOCS / "extremes.md").read_text(encoding="utf-8")


def wrong(printed) -> str | None:
    """What is wrong with a number of the document, in words."""
    measured = FAMILIES[printed.family][printed.words]
    now = format(measured, printed.format).removesuffix("\N{NO-BREAK SPACE}%")
    if now == printed.text:
        return None
    if extreme_numbers.mode_of(printed.words) not in EXACT:
        there, here = (float(shown.replace(",", "").replace("∞", "inf")) for shown in (printed.text, now))
        digit = 10.0 ** -len(printed.text.partition(".")[2])
        if abs(there - here) <= 0.1 * abs(here) + digit:
            return None
    return f"{printed.family}[{printed.words}] is {now}, and printed as {printed.text}"


def test_its_numbers_are_what_the_shaders_do(text):
    found = make_extremes.printed(text)
    fast = [number for number in found if re.match(SLOW.get(number.family, ""), number.words)]
    assert len(fast) > 100
    assert not [line for line in map(wrong, fast) if line]


def test_another_number_is_noticed(text):
    number = next(number for number in make_extremes.printed(text) if number.words == "D_HALF precise .02")
    assert wrong(number) is None
    assert wrong(number._replace(text="3.4"))


def test_another_text_is_noticed(text):
    with pytest.raises(ValueError, match="make extremes"):
        make_extremes.printed(text.replace("magenta", "green", 1))


def test_every_form_of_the_ladder_is_in_both_tables(text, root):
    ladder = (root / "shaders" / "ladder.toml").read_text(encoding="utf-8")
    forms = re.findall(r'^value = "(\w+)"', ladder, re.MULTILINE)
    assert len(forms) == len(set(forms)) > 20
    first = re.findall(r"^\| \[`([A-Z]\w+)`\]", text, re.MULTILINE)
    assert first == forms
    assert re.findall(r"^\| `([A-Z]\w+)`", text, re.MULTILINE) == forms


def test_every_row_leads_to_a_section(text):
    sections = [re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in re.findall("^## (.*)", text, re.M)]
    linked = re.findall(r"\]\(#([^)]+)\)", text)
    assert set(linked) == set(sections) - {"by-precision"}


def test_every_picture_is_used_once_and_is_there(text):
    used = re.findall(r"!\[[^]]{20,}\]\(extremes/([^)]+)\)", text)
    assert len(used) == text.count("\n## ") - 1
    assert sorted(used) == sorted(path.name for path in (DOCS / "extremes").iterdir())


@pytest.mark.parametrize("name", ["capped", "opposite", "decoding"])
def test_a_picture_is_what_the_shaders_do(name, tmp_path):
    """To two codes on average: labels are drawn by Pillow's font, which may change."""
    (tmp_path / "now.png").write_bytes(extreme_drawing.png(make_extremes.PICTURES[name]()))
    there, now = (
        np.asarray(Image.open(path).convert("RGB"), int)
        for path in (DOCS / "extremes" / f"{name}.png", tmp_path / "now.png")
    )
    assert there.shape == now.shape
    assert np.abs(there - now).mean() < 2


def test_a_picture_comes_out_the_same_twice():
    rows = make_extremes.PICTURES["decoding"]()
    assert extreme_drawing.png(rows) == extreme_drawing.png(rows)


# ---- The measures, against what follows from formulas ----------------------------------------------------------------


def test_a_capped_peak_is_one_that_a_half_can_hold():
    """60000 of 1/(pi alpha^2), and no cap where that is smaller; float32 rounds to 6e-8."""
    for roughness in (0.03, 0.1):
        share = min(60000 * math.pi * roughness**4, 1)
        assert FAMILIES["peak"][f"D_HALF precise {roughness}"] == pytest.approx(share, rel=1e-6)


def test_where_a_half_cannot_hold_the_peak():
    """1/(pi r^4) = 60000 at r = 0.048, and k^2 = 1/r^4 = 65504 at r = 0.0625, down to thousandths."""
    assert FAMILIES["brightest"]["D_HALF precise 6e4"] == math.floor((60000 * math.pi) ** -0.25 * 1000) / 1000
    assert FAMILIES["brightest"]["D_CROSS mediump"] == math.floor(65504**-0.25 * 1000) / 1000


def test_a_shorter_normal_in_the_exercises_form():
    """At its peak 1 - 0.999^2 is left of the squared sine: alpha^4/(1 + 0.999^2 (alpha^2 - 1))^2 of the peak.

    1 + x (alpha^2 - 1) is rounded by 1e-7 of 2e-3."""
    alpha2 = 0.1**4
    share = (alpha2 / (1 + 0.999**2 * (alpha2 - 1))) ** 2
    assert FAMILIES["peak"]["D_EXERCISE double .1 .999"] == pytest.approx(share, rel=2e-4)


def test_half_rounds_a_cosine_to_one_as_far_as_it_does():
    """n.h = 1 from 1 - 2^-12 up, halfway between 1 and the half below it; found in steps of 0.001 degrees."""
    assert FAMILIES["dot_angle"]["mediump"] == pytest.approx(math.degrees(math.acos(1 - 2**-12)), abs=0.002)
    assert FAMILIES["dot_angle"]["precise"] == 0


def test_kelemens_against_smiths():
    """At roughness 1 Smith's V is 1/(2 (NoL + NoV)), and opposite sides have LoH = cos of the mean angle."""
    cosine = math.cos(math.acos(0.01))
    assert FAMILIES["visibility_ratio"]["V_KELEMEN double .01 .01 1"] == pytest.approx(
        0.25 / cosine**2 / (0.5 / 0.02), rel=1e-6
    )


def test_a_white_metal_of_roughness_one_keeps_one_less_log_two():
    assert FAMILIES["furnace_least"]["metal 1 MULTI_NONE"] == pytest.approx(1 - math.log(2), abs=1e-5)


def test_the_codes_that_a_power_changes():
    """By numpy, from the standard's formulas."""
    code = np.arange(256)
    linear = (code / 255) ** 2.2
    shown = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    off = np.rint(255 * shown) - code
    assert FAMILIES["codes_changed"]["SRGB_POWER double"] == np.count_nonzero(off)
    assert FAMILIES["code_off"]["SRGB_POWER double"] == np.abs(off).max()


# ---- Files -----------------------------------------------------------------------------------------------------------


def test_a_file_is_written_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "docs" / "extremes.md"
    make_extremes.write(path, b"old")

    def fails(*_):
        raise OSError("full")

    monkeypatch.setattr(make_extremes.os, "replace", fails)
    with pytest.raises(OSError, match="full"):
        make_extremes.write(path, b"new")
    assert path.read_bytes() == b"old"
    assert [file.name for file in path.parent.iterdir()] == ["extremes.md"]
