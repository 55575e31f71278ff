"""The numeric parts of a type."""

from __future__ import annotations

import pytest

from harness import CallError
from harness.language.leaf import leaves
from harness.language.signature import Array, Numeric, Opaque, Struct

FLOAT, VEC3 = Numeric("float"), Numeric("float", 3)


def test_the_leaves_of_a_type_are_its_numbers_from_first_to_last():
    light = Struct((("direction", VEC3), ("on", Numeric("bool"))), "Light")
    scene = Struct((("lights", Array(light, 2)), ("m", Numeric("float", 3, 2)), ("w", Array(FLOAT, 2))), "Scene")
    assert [(leaf.path, str(leaf.type)) for leaf in leaves(scene)] == [
        (".lights[0].direction", "vec3"),
        (".lights[0].on", "bool"),
        (".lights[1].direction", "vec3"),
        (".lights[1].on", "bool"),
        (".m", "mat2x3"),
        (".w[0]", "float"),
        (".w[1]", "float"),
    ]


@pytest.mark.parametrize(
    ("rows", "columns", "components", "texels"),
    [(1, 1, 1, 1), (2, 1, 2, 1), (3, 1, 3, 1), (4, 1, 4, 1), (2, 2, 4, 1), (3, 3, 3, 3), (3, 2, 3, 2), (4, 4, 4, 4)],
)
def test_a_leaf_fills_its_texels_evenly(rows, columns, components, texels):
    (leaf,) = leaves(Numeric("float", rows, columns))
    assert (leaf.components, leaf.texels) == (components, texels)
    assert leaf.components * leaf.texels == leaf.size == rows * columns


@pytest.mark.parametrize("kind", [Opaque("sampler2D"), Numeric("double", 2), Array(Opaque("image2D"), 2)])
def test_what_is_no_data_has_none(kind):
    with pytest.raises(CallError, match="cannot be passed as arrays"):
        list(leaves(kind))
