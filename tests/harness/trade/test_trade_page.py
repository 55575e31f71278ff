"""The page: all that it shows is in it, as text where it is text."""

from __future__ import annotations

import base64
import io
import re
import sys
from html.parser import HTMLParser

import numpy as np
import pytest
import trade_data
from PIL import Image

from harness import HarnessError
from harness.trade import images, page


@pytest.fixture
def data():
    return trade_data.trade()


def made(data):
    return page.page(data, trade_data.pictures(), trade_data.maps())


@pytest.fixture(scope="module")
def html():
    return made(trade_data.trade())


class Tags(HTMLParser):
    """What a page refers to, its tags, and those that were never closed."""

    EMPTY = {"meta", "img", "br", "link", "line", "circle", "polyline", "image", "use"}

    def __init__(self, text):
        super().__init__()
        self.tags, self.targets, self.open, self.astray = set(), [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        self.targets += [value for name, value in attributes if name in ("src", "href", "xlink:href", "action", "data")]
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in self.EMPTY:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.astray.append(tag)


def text(html):
    return re.sub(r"\s+", " ", re.sub(r"<style>.*?</style>|<[^>]*>", " ", html, flags=re.DOTALL))


def test_it_needs_nothing_but_itself(html):
    tags = Tags(html)
    assert len(tags.targets) > 10
    assert all(target.startswith(("data:image/png;base64,", "#")) for target in tags.targets)
    assert not tags.tags & {"script", "link", "iframe", "object", "embed"}
    assert "@import" not in html and "url(" not in html


def test_every_tag_is_closed(html):
    tags = Tags(html)
    assert tags.open == [] and tags.astray == []


def test_it_begins_with_the_answers(html):
    said = text(html)
    for use, name in (("a phone", "mobile"), ("a desktop", "desktop"), ("ground truth", "offline")):
        assert said.index(f"For {use} {name}") < said.index("The presets")


def test_names_are_text_and_no_tags(html):
    assert "Some GPU &lt;&amp; more&gt;" in html and "Some GPU <& more>" not in html


def test_there_is_a_plot_for_each_target(html):
    assert re.findall(r'aria-label="Cost on (\w+) against error"', html) == list(trade_data.TARGETS)


def test_the_dominated_are_said_to_be_by_whom(html):
    assert "V_KARIS by V_HAMMON" in text(html)
    assert html.count("; dominated by V_HAMMON</title>") == 3 * len(trade_data.TARGETS)


def shown(html, alt):
    sources = re.findall(rf'<img src="data:image/png;base64,([^"]+)" alt="{alt}">', html)
    return [np.asarray(Image.open(io.BytesIO(base64.b64decode(source))).convert("RGBA")) for source in sources]


def test_each_preset_but_the_reference_is_beside_it_with_the_difference_amplified(html):
    pictures = trade_data.pictures()
    others = {"exercise": 16, "desktop": 128, "mobile": 8, "offline": 16}  # 9, 1, 23 and 12 of 255
    differences = shown(html, "The difference of the two")
    assert len(differences) == len(others)
    for (name, factor), difference in zip(others.items(), differences, strict=True):
        (picture,) = shown(html, f"The scene by {name}")
        assert np.array_equal(picture, pictures[name])
        assert np.array_equal(difference, images.difference(pictures[name], pictures["exact"], factor))
    assert "difference × 8: at most 23/255" in text(html)
    assert html.count('href="#reference"') == len(others) and html.count('id="reference"') == 1


def test_each_rung_has_its_map(html):
    for name, kinds in trade_data.maps().items():
        for kind, errors in kinds.items():
            (shown_map,) = shown(html, f"{kind} of {name}")
            assert np.array_equal(shown_map, images.heat(errors))


def test_each_device_has_a_table_of_its_own(html):
    times = text(html[html.index("<h2>Time</h2>") :])
    assert times.index("0.85 (0.765–1.02)") < times.index("Some GPU") < times.index("0.0085 (0.00773–0.00944)")


def test_what_is_missing_is_said(data):
    said = text(made(trade_data.without(data, "cost", "no driver: make cost")))
    assert "Not measured" in said and "cost: no driver: make cost" in said
    assert "No cycles were measured." in said


@pytest.mark.parametrize("part", ["roundoff", "model", "scene", "extremes", "energy", "cost", "time"])
def test_it_is_made_whatever_is_missing(data, part):
    assert Tags(made(trade_data.without(data, part, "reason"))).open == []


def test_without_pictures_and_maps_it_is_made_of_the_rest(data):
    said = text(page.page(data, {}, {}))
    assert "What one sees of it" not in said and "Where it is wrong" not in said and "At the extremes" in said


def test_the_head_of_a_table_groups_what_belongs_together():
    table = page.Table(("", "navi21, cycles", "navi21, latency", "SPIR-V"), ())
    assert page.headed(table) == ([("", 1), ("navi21", 2), ("", 1)], ["", "cycles", "latency", "SPIR-V"])
    assert page.headed(page.Table(("", "cycles"), ())) == ([], ["", "cycles"])


def test_without_jinja2_it_is_told_what_to_install(data, monkeypatch):
    monkeypatch.setitem(sys.modules, "jinja2", None)
    with pytest.raises(HarnessError, match=r"shader-harness\[trade\]"):
        page.page(data, {}, {})
