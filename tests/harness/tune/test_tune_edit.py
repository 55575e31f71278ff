"""Edits of a .sprj. Expected: the file as a text editor would change it, byte for byte."""

from __future__ import annotations

import pytest

from harness import ProjectError
from harness.tune import edit

#: \r\n, a tab, a comment, single quotes, an entity, a declaration of Latin-1 and a letter of it
TEXT = """<?xml version='1.0' encoding='ISO-8859-1'?>\r
<project  version="2"><!-- <pass name="A"> \xe4 -->\r
  <pipeline>\r
    <pass name="A&amp;B" type="shader" active="true">\r
\t<inputlayout>\r
\t  <item value="Position" semantic="POSITION" />\r
\t  <item value="Normal" semantic="a > b" />\r
\t  <item value="Texcoord" semantic="TEXCOORD0" />\r
\t</inputlayout>\r
\t<itemvalues>\r
\t  <value variable="albedo" for="X"><row><value>1</value></row></value>\r
\t  <value variable="other" for="X"><row><value>2</value></row></value>\r
\t</itemvalues>\r
\t<variables>\r
\t  <variable type='float' name='albedo'><row><value>1</value></row></variable>\r
\t  <variable type='float' name='other'><row><value>1</value></row></variable>\r
\t</variables>\r
\t<macros>\r
\t  <define name="ONE" active="true">1</define>\r
\t  <define name="OFF" active="false">7</define> <!-- off -->\r
\t  <define name="EMPTY" active="true" />\r
\t</macros>\r
    </pass>\r
    <pass name="Bare" active="true"><shader type="vs" path="x" entry="main" /></pass>\r
    <pass name="None">\r
      <shader type="vs" path="x" entry="main" />\r
      <macros />\r
    </pass>\r
  </pipeline>\r
  <objects>\r
    <object type="texture" path="a.png">\r
      <bind slot="0" name="A&amp;B" />\r
      <bind slot="3" name="Bare" />\r
    </object>\r
    <object type="texture" path="b.png"><bind slot="1" name="A&amp;B" /></object>\r
    <object type="rendertexture" name="rt" rsize="1,1"><bind slot="2" name="A&amp;B" /></object>\r
  </objects>\r
</project>\r
"""
DATA = TEXT.encode("latin-1")
NAME = "A&B"


def replaced(old: str, new: str) -> bytes:
    """The file with one text replaced."""
    assert TEXT.count(old) == 1
    return TEXT.replace(old, new).encode("latin-1")


@pytest.mark.parametrize(
    ("edited", "old", "new"),
    [
        (edit.set_macro(DATA, NAME, "ONE", "V_X"), ">1</define>", ">V_X</define>"),
        (edit.set_macro(DATA, NAME, "ONE", "a<b"), ">1</define>", ">a&lt;b</define>"),
        (edit.set_macro(DATA, NAME, "OFF", "2"), '"OFF" active="false">7<', '"OFF" active="true">2<'),
        (edit.set_macro(DATA, NAME, "EMPTY", "2"), '"EMPTY" active="true" />', '"EMPTY" active="true">2</define>'),
        (
            edit.set_macro(DATA, NAME, "NEW", "2"),
            '"EMPTY" active="true" />',
            '"EMPTY" active="true" />\r\n\t  <define name="NEW" active="true">2</define>',
        ),
        (
            edit.set_macro(DATA, "None", "NEW", "2"),
            "\r\n      <macros />",
            '\r\n      <macros>\r\n        <define name="NEW" active="true">2</define>\r\n      </macros>',
        ),
        (
            edit.set_macro(DATA, "Bare", "NEW", "2"),
            'entry="main" /></pass>',
            'entry="main" /><macros><define name="NEW" active="true">2</define></macros></pass>',
        ),
        (edit.remove_macro(DATA, NAME, "ONE"), '\r\n\t  <define name="ONE" active="true">1</define>', ""),
        (edit.remove_macro(DATA, NAME, "OFF"), '\r\n\t  <define name="OFF" active="false">7</define>', ""),
        (
            edit.set_variable(DATA, NAME, "gloss", "float2", ["0.5", "1"]),
            "name='other'><row><value>1</value></row></variable>",
            "name='other'><row><value>1</value></row></variable>"
            "\r\n\t  <variable type='float2' name='gloss'><row><value>0.5</value><value>1</value></row></variable>",
        ),
        (
            edit.trim_layout(DATA, NAME, 1),
            '\r\n\t  <item value="Normal" semantic="a > b" />\r\n\t  <item value="Texcoord" semantic="TEXCOORD0" />',
            "",
        ),
        (edit.trim_layout(DATA, NAME, 3), "\r\n  <objects>", "\r\n  <objects>"),
        (edit.unbind(DATA, NAME, "path", "a.png"), '\r\n      <bind slot="0" name="A&amp;B" />', ""),
        (
            edit.unbind(DATA, NAME, "path", "b.png"),
            '\r\n    <object type="texture" path="b.png"><bind slot="1" name="A&amp;B" /></object>',
            "",
        ),
        (edit.unbind(DATA, NAME, "name", "rt"), '<bind slot="2" name="A&amp;B" />', ""),
        (edit.unbind(DATA, "Bare", "path", "b.png"), "\r\n  <objects>", "\r\n  <objects>"),
    ],
)
def test_nothing_else_changes(edited, old, new):
    assert edited == replaced(old, new)


def test_a_variable_that_is_set_is_the_same_for_all_items():
    text = TEXT.replace('\r\n\t  <value variable="albedo" for="X"><row><value>1</value></row></value>', "").replace(
        "<variable type='float' name='albedo'><row><value>1</value>",
        "<variable type='float' name='albedo'><row><value>0.25</value>",
    )
    assert edit.set_variable(DATA, NAME, "albedo", "float", ["0.25"]) == text.encode("latin-1")


def test_a_variable_goes_with_the_values_of_items():
    text = TEXT.replace('\r\n\t  <value variable="albedo" for="X"><row><value>1</value></row></value>', "").replace(
        "\r\n\t  <variable type='float' name='albedo'><row><value>1</value></row></variable>", ""
    )
    assert edit.remove_variable(DATA, NAME, "albedo") == text.encode("latin-1")


@pytest.mark.parametrize("value", ["1", "V_X"])
def test_an_edit_made_twice_is_made_once(value):
    once = edit.set_macro(DATA, NAME, "NEW", value)
    assert edit.set_macro(once, NAME, "NEW", value) == once
    once = edit.set_variable(DATA, NAME, "gloss", "float", [value])
    assert edit.set_variable(once, NAME, "gloss", "float", [value]) == once


def test_a_mark_of_utf8_stays_first():
    data = b"\xef\xbb\xbf" + DATA.replace(b"ISO-8859-1", b"UTF-8").replace(b"\xe4", "ä".encode())
    assert edit.set_macro(data, NAME, "ONE", "2") == data.replace(b">1</define>", b">2</define>")


def test_sixteen_bits_a_letter_are_refused():
    with pytest.raises(ProjectError, match="UTF-16"):
        edit.set_macro(TEXT.replace("ISO-8859-1", "UTF-16").encode("utf-16"), NAME, "ONE", "2")


def test_layouts_are_those_that_are_written_out():
    assert edit.layouts(DATA) == {NAME: ("Position", "Normal", "Texcoord")}


def test_users_of_a_model_are_told_by_its_path():
    model = '<items><item name="M" type="model"><filepath>m\\pot.glb</filepath></item></items>'
    data = replaced('entry="main" /></pass>', f'entry="main" />{model}</pass>')
    assert edit.users_of_model(data, "m/pot.glb") == ["Bare"]
    assert edit.users_of_model(data, "pot.glb") == []
