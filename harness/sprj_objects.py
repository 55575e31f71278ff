"""Reads the ``<object>``s of a .sprj that are textures of drawn passes, and its ``<settings>``."""

from __future__ import annotations

from collections.abc import Collection

from .project import ArcballCamera, Bind, FirstPersonCamera, Settings, TextureObject
from .sprj_values import flag, integer, real, relative_path
from .xml_lines import Element

#: the camera of SHADERed's start-up project, left in place by a project without a camera entry
DEFAULT_CAMERA = ArcballCamera(distance=4.0, pitch=28.0, yaw=317.0, roll=0.0)

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


def read_textures(objects: list[Element], passes: Collection[str]) -> tuple[TextureObject, ...]:
    """The textures that are bound to one of ``passes``."""
    textures = []
    paths: dict[str, int] = {}
    taken: dict[tuple[str, int], str] = {}
    for element in objects:
        path = element.attributes.get("path", "").replace("\\", "/")
        if path in paths:
            raise element.error(f'"{path}" has an object already, in line {paths[path]}: add the binds to that')
        if path:
            paths[path] = element.line
        binds = [b for b in element.all("bind") if b.attributes.get("name") in passes]
        if binds:
            textures.append(_texture(element, tuple(_bind(b, path, taken) for b in binds)))
    return tuple(textures)


def _texture(element: Element, binds: tuple[Bind, ...]) -> TextureObject:
    kind = element.attributes.get("type", "")
    name = element.attributes.get("name") or element.attributes.get("path", "")
    if kind != "texture":
        raise element.error(f'<object type="{kind}"> "{name}" is not supported')
    for special in ("cube", "keyboard_texture"):
        if flag(element, special, False):
            raise element.error(f'<object type="texture" {special}="true"> "{name}" is not supported')
    return TextureObject(
        path=relative_path(element, element.attributes.get("path", ""), '<object type="texture">'),
        vflip=flag(element, "vflip", False),
        min_filter=_choice(element, "min_filter", MIN_FILTERS, "Linear"),
        mag_filter=_choice(element, "mag_filter", MAG_FILTERS, "Nearest"),
        wrap_s=_choice(element, "wrap_s", WRAPS, "Repeat"),
        wrap_t=_choice(element, "wrap_t", WRAPS, "Repeat"),
        binds=binds,
        line=element.line,
    )


def _bind(element: Element, path: str, taken: dict[tuple[str, int], str]) -> Bind:
    """One ``<bind>``; ``taken`` maps the (pass, slot)s so far to their paths."""
    name = element.attributes["name"]
    slot = integer(element, element.attributes.get("slot", "0"), "the slot")
    if slot < 0:
        raise element.error(f"the slot is {slot}, but slots start at 0")
    if (name, slot) in taken:
        raise element.error(f'slot {slot} of pass "{name}" has "{taken[name, slot]}" already')
    if any(pass_name == name and other == path for (pass_name, _), other in taken.items()):
        raise element.error(f'"{path}" is bound to pass "{name}" twice; SHADERed binds it once')
    taken[name, slot] = path
    return Bind(name, slot, element.line)


def _choice(element: Element, name: str, choices: Collection[str], default: str) -> str:
    value = element.attributes.get(name, default)
    if value not in choices:
        raise element.error(f'{name} is "{value}"; there are {", ".join(choices)}')
    return value


def read_settings(entries: list[Element]) -> Settings:
    """The settings; of several entries of a kind the last holds, as in SHADERed."""
    camera, color, use_alpha, include_paths = DEFAULT_CAMERA, {}, False, ()
    for entry in entries:
        kind = entry.attributes.get("type", "")
        if kind == "camera":
            camera = _camera(entry)
        elif kind == "clearcolor":
            color |= {
                c: real(entry, entry.attributes[c], f"{c} of the clear colour") for c in "rgba" if c in entry.attributes
            }
        elif kind == "usealpha":
            use_alpha = flag(entry, "val", False)
        elif kind == "ipaths":
            include_paths = tuple(path.text for path in entry.all("path"))
    clear_color = tuple(color.get(c, 0.0) for c in "rgba")
    return Settings(camera, clear_color, use_alpha, include_paths)


def _camera(entry: Element) -> ArcballCamera | FirstPersonCamera:
    def number(name: str) -> float:
        found = entry.child(name)
        if found is None:
            raise entry.error(f"the camera has no <{name}>, without which SHADERed crashes")
        return real(found, found.text, f"<{name}> of the camera")

    if flag(entry, "fp", False):
        position = number("positionX"), number("positionY"), number("positionZ")
        return FirstPersonCamera(position, number("pitch"), number("yaw"), entry.line)
    return ArcballCamera(number("distance"), number("pitch"), number("yaw"), number("roll"), entry.line)
