"""What a texture is for, by names: of its file, of its sampler, of what its texels are assigned to or given to."""

from __future__ import annotations

import re

COLOR, NORMAL, ROUGHNESS, METALNESS = "colour", "normal", "roughness", "metalness"
#: role -> beginnings of words that say so
_WORDS = {
    COLOR: ("albedo", "basecolor", "basecolour", "color", "colour", "diffuse", "diff", "col", "emissive", "emission"),
    NORMAL: ("normal", "nrm", "nor", "norm", "bump"),
    ROUGHNESS: ("rough", "rgh"),
    METALNESS: ("metal", "mtl"),
}
#: those that count only as whole words
_SHORT = {"diff", "col", "nrm", "nor", "norm", "rgh", "mtl", "bump"}
_PARTS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")


def words(name: str) -> list[str]:
    """The words of a name in lower case: PaintedMetal_1K-PNG_BaseColor -> painted metal 1 k png base color."""
    return [part.lower() for part in _PARTS.findall(name)]


def of_file(path: str) -> str | None:
    """The role of a texture file by its name's last telling word, in which such names end."""
    stem = path.rpartition("/")[2].rpartition(".")[0] or path
    # What stands before the last _ or - names the material, which may well be a metal.
    for part in reversed(re.split(r"[_\-. ]+", stem)):
        if role := of_name(part):
            return role
    return None


def of_name(name: str) -> str | None:
    """The role by the last telling word of a name."""
    parts = words(name)
    for k in range(len(parts) - 1, -1, -1):
        for role, known in _WORDS.items():
            if any(parts[k] == w if w in _SHORT else parts[k].startswith(w) for w in known):
                return role
    return None
