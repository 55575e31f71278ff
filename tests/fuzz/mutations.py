"""Spoils files at random: XML by its structure, GLSL by its lines and words, anything by its bytes."""

from __future__ import annotations

import io
import random
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable

#: what stands for a number, a name or a path somewhere, and should not
VALUES = (
    *("", " ", "-1", "0", "1", "-0", "3", "1e400", "1e-400", "nan", "-inf", "0x10", "1_000", "1,5", "1 2", ".", "+"),
    *("2147483647", "2147483648", "-2147483648", "4294967296", "9" * 30, "9" * 400, "1e38", "3.5e38", "16384", "65536"),
    *("\u0661", "\uff11", "true", "TRUE", "false", "yes", "vs", "ps", "gs", "model", "Cube", "float4x4", "Time", "rt"),
    *("..", "/", "../../../etc/passwd", "/proc/self/mem", "/proc/self/environ", "\\", "a" * 70, "a" * 600, "%s%n"),
    *("\u00e9", "\u202e", "\ud7ff", "\U0001f600", "name with spaces", "*.frag", "?", "con", "#", '"', "<", "&", "]]>"),
)
TOKENS = (
    *(
        '#include "a"',
        '#include "../a"',
        "#include <>",
        '#include "',
        "#include",
        '#include "inner.glsl"',
        "# include x",
    ),
    *("/*", "*/", "//", "\\\n", "\\\r\n", "\\", '"', "'", "\n", "\r", "\r\n", "\f", "\0", "\ufeff", "\u00e9", "\x1a"),
    *("#define A", "#define A A", "#define F(x", "#define F(x) x##x", "#define", "A", "F(", "F(1)", "#undef A", "##"),
    *(
        "#if",
        "#if 1",
        "#if A(",
        "#ifdef",
        "#else",
        "#elif 1",
        "#endif",
        "#error x",
        "#pragma x",
        "#line 0",
        "#line 9 9",
    ),
    *("#version 330", "#version 450", "#version", "#extension all : require", "#extension GL_ARB_gpu_shader5 : enable"),
    *("{", "}", "(", ")", ";", "[", "]", ",", "=", "+", ".", ":", "?", "1e999", "0x", "99999999999", "1.0f", "08", "u"),
    *(
        "uniform sampler2D a, b;",
        "uniform sampler2D a [ 3 ] ;",
        "in",
        "out",
        "inout",
        "const",
        "struct S { float x; };",
    ),
    *("layout(location = 99999999999)", "layout(binding = -1)", "void main() {}", "float f(float x) { return f(x); }"),
    *("precision mediump float;", "discard;", "gl_FragColor", "float a[2147483647];", "mat4", "vec3", "subroutine"),
)
_WORD = re.compile(r"\w+")
_NUMBER = re.compile(r"(?<!\w)\d+(\.\d*)?(?!\w)")

Chance = random.Random


def spoil(data: bytes, kind: str, chance: Chance) -> bytes:
    """``data`` with one to six faults; ``kind`` is "xml", "glsl" or "bytes"."""
    if kind == "xml" and chance.random() < 0.8:
        data = _spoil_xml(data, chance)
    elif kind == "glsl" and chance.random() < 0.8:
        data = _spoil_glsl(data, chance)
    if kind == "bytes" or chance.random() < 0.3:
        data = _spoil_bytes(data, chance)
    return data


# ---- XML -------------------------------------------------------------------------------------------------------------


def _spoil_xml(data: bytes, chance: Chance) -> bytes:
    try:
        root = ET.fromstring(data)
    except ET.ParseError:  # the corpus has files that are no XML to begin with
        return _spoil_bytes(data, chance)
    for _ in range(chance.randint(1, 4)):
        chance.choice(_XML)(root, chance)
    written = io.BytesIO()
    encoding = chance.choice(["utf-8"] * 6 + ["utf-16", "iso-8859-1", "us-ascii"])
    ET.ElementTree(root).write(written, encoding, xml_declaration=chance.random() < 0.8)
    return chance.choice(_FRAMES)(written.getvalue())


def _element(root: ET.Element, chance: Chance) -> ET.Element:
    return chance.choice(list(root.iter()))


def _parent(root: ET.Element, chance: Chance) -> ET.Element:
    return chance.choice([e for e in root.iter() if len(e)] or [root])


def _some_value(root: ET.Element, chance: Chance) -> str:
    """One of VALUES, or what stands elsewhere."""
    if chance.random() < 0.5:
        return chance.choice(VALUES)
    other = _element(root, chance)
    return chance.choice([other.text or "", other.tag, *other.attrib.values()])


def _drop(root: ET.Element, chance: Chance) -> None:
    parent = _parent(root, chance)
    if len(parent):
        parent.remove(chance.choice(list(parent)))


def _repeat(root: ET.Element, chance: Chance) -> None:
    parent = _parent(root, chance)
    if len(parent):
        child = chance.choice(list(parent))
        for _ in range(chance.choice((1, 1, 2, 40))):
            parent.insert(chance.randint(0, len(parent)), child)


def _swap(root: ET.Element, chance: Chance) -> None:
    parent = _parent(root, chance)
    children = list(parent)
    chance.shuffle(children)
    parent[:] = children


def _move(root: ET.Element, chance: Chance) -> None:
    parent, other = _parent(root, chance), _element(root, chance)
    if len(parent):
        child = chance.choice(list(parent))
        if other not in child.iter():
            parent.remove(child)
            other.append(child)


def _rename(root: ET.Element, chance: Chance) -> None:
    element, other = _element(root, chance), _element(root, chance)
    element.tag = other.tag


def _text(root: ET.Element, chance: Chance) -> None:
    leaves = [e for e in root.iter() if not len(e)]
    chance.choice(leaves).text = _some_value(root, chance)


def _attribute(root: ET.Element, chance: Chance) -> None:
    element = chance.choice([e for e in root.iter() if e.attrib] or [root])
    name = chance.choice([*element.attrib, *_element(root, chance).attrib, "name"])
    if chance.random() < 0.2:
        element.attrib.pop(name, None)
    else:
        element.set(name, _some_value(root, chance))


def _deep(root: ET.Element, chance: Chance) -> None:
    inner = _element(root, chance)
    tag = inner.tag
    for _ in range(chance.choice((1, 5, 300))):
        inner = ET.SubElement(inner, tag)


_XML: tuple[Callable, ...] = (_drop, _repeat, _swap, _move, _rename, _text, _text, _text, _attribute, _attribute, _deep)
#: what surrounds a document
_FRAMES: tuple[Callable[[bytes], bytes], ...] = (
    *[lambda data: data] * 8,
    lambda data: data.replace(b"\n", b"\r\n"),
    lambda data: b"\xef\xbb\xbf" + data,
    lambda data: data.replace(b"utf-8", b"utf-16"),
    lambda data: data.replace(b"utf-8", b"no-such-thing"),
    lambda data: b"\n" + data,
    lambda data: b'<!DOCTYPE project [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;">]>' + data.partition(b"?>")[2],
)


# ---- GLSL ------------------------------------------------------------------------------------------------------------


def _spoil_glsl(data: bytes, chance: Chance) -> bytes:
    text = data.decode("utf-8", errors="replace")
    for _ in range(chance.randint(1, 5)):
        text = chance.choice((_of_lines, _of_words, _of_tokens, _of_tokens, _of_numbers))(text, chance)
    return text.encode("utf-8", errors="replace")


def _of_lines(text: str, chance: Chance) -> str:
    lines = text.split("\n")
    k = chance.randrange(len(lines))
    match chance.randrange(5):
        case 0:
            del lines[k]
        case 1:
            lines.insert(chance.randint(0, len(lines)), lines[k])
        case 2:
            lines[k] += "\\"
        case 3:
            lines[k], lines[-1] = lines[-1], lines[k]
        case _:
            lines[k] = lines[k][: chance.randint(0, len(lines[k]))]
    return "\n".join(lines)


def _of_words(text: str, chance: Chance) -> str:
    words = list(_WORD.finditer(text))
    if not words:
        return text
    at, other = chance.choice(words), chance.choice(words)
    return text[: at.start()] + other[0] + text[at.end() :]


def _of_tokens(text: str, chance: Chance) -> str:
    token = chance.choice(TOKENS)
    if token.startswith("#") and chance.random() < 0.7:
        token = f"\n{token}\n"
    at = chance.randint(0, len(text))
    return text[:at] + token + text[at:]


def _of_numbers(text: str, chance: Chance) -> str:
    numbers = list(_NUMBER.finditer(text))
    if not numbers:
        return text
    at = chance.choice(numbers)
    return text[: at.start()] + chance.choice(VALUES[:27]) + text[at.end() :]


# ---- Bytes -----------------------------------------------------------------------------------------------------------


def _spoil_bytes(data: bytes, chance: Chance) -> bytes:
    spoilt = bytearray(data)
    for _ in range(chance.randint(1, 4)):
        at = chance.randint(0, len(spoilt))
        match chance.randrange(6):
            case 0 if at < len(spoilt):
                spoilt[at] ^= 1 << chance.randrange(8)
            case 1 if at < len(spoilt):
                spoilt[at] = chance.choice(b"\x00\xff\x80\x7f<>&\"'\\/#\n")
            case 2:
                del spoilt[at : at + chance.choice((1, 4, 100))]
            case 3:
                spoilt[at:at] = chance.choice(
                    (b"\x00", b"\xff\xff\xff\xff", b"<", b"&#0;", b"<![CDATA[", b"\xc3", b"9" * 20)
                )
            case 4:
                spoilt[at:at] = spoilt[at : at + chance.choice((1, 10, 1000))]
            case _:
                del spoilt[max(at, len(spoilt) // 2) :]
    return bytes(spoilt)
