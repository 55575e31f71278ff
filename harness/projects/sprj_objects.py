"""Reads the ``<object>``s of a .sprj: textures, cube maps, render textures, images and buffers, and their binds."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

from ..errors import ProjectError
from ..rendering import states
from .project import Bind, Buffer, CubeMap, Image, KeyboardTexture, Object, RenderTexture, TextureObject
from .sprj_values import choice, flag, integer, limited, real, relative_path, strict_real
from .xml_lines import Element

MIN_FILTERS = (
    "Nearest",
    "Linear",
    "Nearest_MipmapNearest",
    "Linear_MipmapNearest",
    "Nearest_MipmapLinear",
    "Linear_MipmapLinear",
)
MAG_FILTERS = ("Nearest", "Linear")
WRAPS = ("ClampToEdge", "Repeat", "MirroredRepeat")
#: faces of a cube map in GL's order: +x -x +y -y +z -z
FACES = ("right", "left", "top", "bottom", "back", "front")

LARGEST_SIDE = 16384
MOST_SLOTS = 1024
#: bytes of a buffer
LARGEST_BUFFER = 1 << 28
FORMAT_LIMIT, NAME_LIMIT = 255, 511
_KINDS_V1 = ("texture", "rendertexture", "audio")
_KINDS = (*_KINDS_V1, "image", "image3d", "buffer", "pluginobject")
#: what a row of a buffer can be of
BUFFER_TYPES = ("bool", "byte", "int", "float", *(f"{t}{n}" for t in ("bvec", "bool", "byte") for n in (2, 3, 4))) + (
    *(f"{t}{n}" for t in ("ivec", "int", "vec", "float") for n in (2, 3, 4)),
    *(f"{t}{n}" for t in ("mat",) for n in (2, 3, 4)),
    *(f"float{n}x{n}" for n in (2, 3, 4)),
)


@dataclass(frozen=True)
class PassNames:
    """The passes that an object can be bound to: those that are drawn, and of those the compute passes; and all."""

    drawn: Collection[str]
    compute: Collection[str]
    all: Collection[str]


def names_of_render_textures(objects: list[Element]) -> set[str]:
    """The names that a pass can draw to."""
    return {o.get("name") for o in objects if o.get("type") == "rendertexture"}


def read_objects(elements: list[Element], passes: PassNames, needed: Collection[str], *, v1: bool) -> list[Object]:
    """The objects that a drawn pass is given, and those named ``needed``. An object that is not supported costs its
    passes that object alone."""
    found: dict[str, Object] = {}
    for element in elements:
        name = _name(element)
        if element.get("type") not in (_KINDS_V1 if v1 else _KINDS):
            element.warn(f'there are no objects of type "{element.get("type")}", and SHADERed leaves "{name}" out')
            continue
        try:
            if name in found:
                _merge(element, name, found, passes, v1)
            else:
                binds = _binds(element, name, passes)
                if binds or name in needed:
                    found[name] = _read(element, name, binds, v1)
        except ProjectError as error:
            element.traps.survive(error)
    return list(found.values())


def _name(element: Element) -> str:
    """What SHADERed calls the object: its path where it is a file."""
    by_path = element.get("type") in ("texture", "audio") and not (
        flag(element, "cube", False) or flag(element, "keyboard_texture", False)
    )
    return element.get("path").replace("\\", "/") if by_path else element.get("name")


def _merge(element: Element, name: str, found: dict[str, Object], passes: PassNames, v1: bool) -> None:
    """A second object of a name: SHADERed makes none, but gives the first its properties and binds."""
    first = found[name]
    second = _read(element, name, _binds(element, name, passes), v1)
    element.warn(f'"{name}" has an object already, in line {first.line}: SHADERed adds this one\'s binds to it')
    if type(first) is not type(second):
        raise element.error(f'"{name}" is an object of another type already, in line {first.line}: SHADERed crashes')
    binds = first.binds + second.binds
    if isinstance(first, TextureObject):
        given = {
            key: getattr(second, key)
            for key in ("min_filter", "mag_filter", "wrap_s", "wrap_t")
            if key in element.attributes
        }
        found[name] = replace(first, binds=binds, vflip=first.vflip != second.vflip, **given)
    elif isinstance(first, CubeMap | KeyboardTexture):
        found[name] = replace(first, binds=binds)
    else:
        found[name] = replace(second, binds=binds, line=first.line)


def _read(element: Element, name: str, binds: tuple[Bind, ...], v1: bool) -> Object:
    kind = element.get("type")
    common = {"name": name, "binds": binds, "line": element.line}
    if kind == "texture":
        return _texture(element, common, v1)
    if not name and kind in ("rendertexture", "image", "image3d", "buffer"):
        raise element.error(f'<object type="{kind}"> has no name: SHADERed crashes')
    if kind == "rendertexture":
        return _render_texture(element, common, v1)
    if kind in ("image", "image3d"):
        return _image(element, kind, common)
    if kind == "buffer":
        return _buffer(element, common)
    raise element.error(f'<object type="{kind}"> "{name}" is not supported')


# ---- Binds -------------------------------------------------------------------------------------------------


def _binds(element: Element, name: str, passes: PassNames) -> tuple[Bind, ...]:
    return tuple(bind for e in element.all("bind") if (bind := _bind(e, element, name, passes)) is not None)


def _bind(element: Element, owner: Element, name: str, passes: PassNames) -> Bind | None:
    pass_name = element.get("name")
    if pass_name not in passes.all:
        element.warn(f'"{name}" is bound to pass "{pass_name}", which there is not')
        return None
    if pass_name not in passes.drawn:
        return None
    slot = integer(element, element.get("slot", "0"), "the slot")
    if not 0 <= slot < MOST_SLOTS:
        raise element.error(f"the slot is {slot}; slots are 0 to {MOST_SLOTS - 1}")
    kind = owner.get("type")
    storage = kind == "buffer"
    if kind in ("image", "image3d"):
        as_image = integer(element, element.attributes["uav"], "uav") if "uav" in element.attributes else -1
        if as_image not in (-1, 0, 1):
            element.warn(f'"{name}" is not bound to pass "{pass_name}": uav is {as_image}, neither 0 nor 1')
            return None
        storage = as_image == 1 or (as_image == -1 and pass_name in passes.compute)
    return Bind(pass_name, slot, element.line, storage)


def warn_of_binds(objects: Collection[Object], at: Element) -> None:
    """Of the objects in one slot the last holds, and of the slots of one object the first."""
    taken: dict[tuple[str, bool, int], str] = {}
    placed: set[tuple[str, bool, str]] = set()
    for bind, name in sorted(((b, o.name) for o in objects for b in o.binds), key=lambda pair: pair[0].line):
        slot = bind.pass_name, bind.storage, bind.slot
        if taken.get(slot, name) != name:
            at.traps.warn(
                f'slot {bind.slot} of pass "{bind.pass_name}" has "{taken[slot]}", which SHADERed then leaves out',
                at.file,
                bind.line,
            )
        taken[slot] = name
        if (bind.pass_name, bind.storage, name) in placed:
            at.traps.warn(
                f'"{name}" is bound to pass "{bind.pass_name}" twice; SHADERed binds it once', at.file, bind.line
            )
        placed.add((bind.pass_name, bind.storage, name))


# ---- Kinds of objects --------------------------------------------------------------------------------------


def _texture(element: Element, common: dict, v1: bool) -> Object:
    if flag(element, "cube", False):
        what = f'the cube map "{common["name"]}"'
        return CubeMap(
            **common, faces=tuple(relative_path(element, element.get(face), f"{face} of {what}") for face in FACES)
        )
    if flag(element, "keyboard_texture", False) and not v1:
        return KeyboardTexture(**common)
    path = relative_path(element, element.get("path"), '<object type="texture">')
    if v1:
        return TextureObject(**common, path=path)

    def named(attribute: str, choices: tuple[str, ...], default: str) -> str:
        return choice(element, element.get(attribute, default), choices, default, attribute)

    volume = flag(element, "is_3d", False)
    wrap_t = named("wrap_t", WRAPS, "Repeat")
    if volume and "wrap_r" in element.attributes:
        element.warn(f'wrap_r of "{path}" sets wrap_t in SHADERed; along the depth it repeats')
        wrap_t = named("wrap_r", WRAPS, wrap_t)
    return TextureObject(
        **common,
        path=path,
        vflip=flag(element, "vflip", False),
        min_filter=named("min_filter", MIN_FILTERS, "Linear"),
        mag_filter=named("mag_filter", MAG_FILTERS, "Nearest"),
        wrap_s=named("wrap_s", WRAPS, "Repeat"),
        wrap_t=wrap_t,
        volume=volume,
    )


def _pair(element: Element, attribute: str, what: str) -> tuple[float, float]:
    """Two numbers with a comma between; one number without a comma is both."""
    text = element.get(attribute)
    first, comma, rest = text.partition(",")
    x, y = (strict_real(element, part, f"{attribute} of {what}") for part in (first, rest if comma else text))
    return x, y


def _render_texture(element: Element, common: dict, v1: bool) -> RenderTexture:
    what = f'the render texture "{common["name"]}"'
    size = ratio = None
    if element.get("fsize"):
        width, height = _pair(element, "fsize", what)
        size = int(width), int(height)
        if not all(1 <= side <= LARGEST_SIDE for side in size):
            raise element.error(f"{what} is {size[0]} x {size[1]} pixels, not 1 to {LARGEST_SIDE} a side")
    elif element.get("rsize"):
        ratio = _pair(element, "rsize", what)
    else:
        raise element.error(f"{what} has neither rsize nor fsize: SHADERed crashes")

    def component(name: str) -> float:
        if v1:
            return integer(element, element.get(name, "0"), f"{name} of {what}") / 255
        return real(element, element.get(name, "0"), f"{name} of {what}")

    return RenderTexture(
        **common,
        size=size,
        ratio=ratio,
        format="RGBA" if v1 else _format(element, "RGBA", what),
        clear=v1 or flag(element, "clear", True),
        color=(component("r"), component("g"), component("b"), component("a")),
    )


def _format(element: Element, default: str, what: str) -> str:
    name = element.get("format", default)
    if name in states.INTEGER_FORMATS:
        raise element.error(f"{what}: the format {name} is not supported: SHADERed itself cannot make it")
    return choice(element, name, tuple(states.FORMATS), default, f"the format of {what}")


def _image(element: Element, kind: str, common: dict) -> Image:
    what = f'the image "{common["name"]}"'
    axes = ("width", "height", "depth")[: 3 if kind == "image3d" else 2]
    size = tuple(integer(element, element.get(axis, "1"), f"{axis} of {what}") for axis in axes)
    if not all(1 <= side <= LARGEST_SIDE for side in size):
        raise element.error(f"{what} is {' x '.join(map(str, size))} pixels, not 1 to {LARGEST_SIDE} a side")
    if element.get("data"):
        element.warn(f"{what}: its data are loaded by hand in SHADERed; it starts as zeros")
    return Image(**common, size=size, format=_format(element, "R32G32B32A32_FLOAT", what))


def _buffer(element: Element, common: dict) -> Buffer:
    what = f'the buffer "{common["name"]}"'
    size = integer(element, element.get("size", "0"), f"the size of {what}")
    if not 0 <= size <= LARGEST_BUFFER:
        raise element.error(f"{what} has {size} bytes; 0 to {LARGEST_BUFFER} work")
    text = limited(element, element.get("format", "float"), FORMAT_LIMIT, f"the format of {what}")
    for part in text.rstrip(";").split(";"):
        choice(element, part.strip(), BUFFER_TYPES, "float", f"a type in the format of {what}")
    limited(element, common["name"], NAME_LIMIT, "the name of the buffer")
    if "/" in common["name"] or "\0" in common["name"]:
        raise element.error(f"{what}: its name cannot be that of a file")
    return Buffer(**common, size=size, format=text)
