"""The features of pbr.vert and pbr.frag: each compiles to what it needs, and a neutral map changes nothing."""

from __future__ import annotations

import importlib.util
import itertools

import numpy as np
import pytest
from variants import MAPS, ROOT, constant_map, floats, write_small_project

from harness.projects import sprj
from harness.rendering import prepare

#: bytes of constant maps, and the constants that they stand for: white decodes to 1 under every SRGB_DECODE
NEUTRAL = {
    "ALBEDO": (255, 255, 255),
    "ROUGHNESS": (102, 102, 102),
    "METALNESS": (51, 51, 51),
    "NORMAL": (128, 128, 255),
}
CONSTANTS = {"albedo": (1.0, 1.0, 1.0), "roughness": (0.4,), "metalness": (0.2,)}
#: the same numbers by another way into the same arithmetic: filtering a constant map and normalising once more
ATOL = 1e-5


@pytest.fixture
def neutral(tmp_path):
    for name, rgb in NEUTRAL.items():
        constant_map(tmp_path / f"{name}.png", *rgb)
    return tmp_path


def small(folder, maps, macros=None, constants=CONSTANTS, **rest):
    used = {n: v for n, v in constants.items() if n.upper() not in maps and not (n == "metalness" and macros)}
    return sprj.read(write_small_project(folder, {n: f"{n}.png" for n in maps}, used, macros, **rest))


@pytest.mark.parametrize("maps", [c for n in range(1, 5) for c in itertools.combinations(MAPS, n)], ids="-".join)
def test_neutral_maps_change_nothing(neutral, maps):
    """Every combination of maps, so that each finds its own texture whatever else is bound."""
    np.testing.assert_allclose(floats(small(neutral, maps)), floats(small(neutral, ())), rtol=0, atol=ATOL)


@pytest.mark.parametrize("metalness", [0, 1])
def test_a_fixed_metalness_is_the_same_as_a_constant_one(neutral, metalness):
    fixed = floats(small(neutral, (), {"METALNESS": str(metalness)}))
    constant = floats(small(neutral, (), None, CONSTANTS | {"metalness": (float(metalness),)}))
    np.testing.assert_allclose(fixed, constant, rtol=0, atol=ATOL)


@pytest.mark.parametrize(
    "maps", [(), ("ALBEDO",), ("ALBEDO", "ROUGHNESS", "NORMAL"), MAPS], ids=lambda m: "-".join(m) or "none"
)
def test_a_pass_holds_only_what_it_needs(neutral, maps):
    (prepared,) = prepare.prepare(small(neutral, maps))
    uniforms = set(prepared.program.uniforms)
    assert {u for u in uniforms if u.startswith("map_")} == {f"map_{k + 1}" for k in range(len(maps))}
    assert uniforms & {"albedo", "roughness", "metalness"} == {n.lower() for n in MAPS[:3] if n not in maps}
    wanted = {"position", "normal"} | ({"texcoord"} if maps else set()) | ({"tangent"} if "NORMAL" in maps else set())
    assert set(prepared.program.attributes) == wanted


def test_a_directx_map_shows_the_same_surface(tmp_path):
    """The project's own maps, GL against DX with its macro."""
    pictures = []
    for name, macros in (("NormalGL", {}), ("NormalDX", {"NORMAL_MAP_DX": "1"})):
        image = ROOT / "textures" / f"GlazedTiles_1K-PNG_{name}.png"
        (tmp_path / "NORMAL.png").write_bytes(image.read_bytes())
        pictures.append(floats(sprj.read(write_small_project(tmp_path, {"NORMAL": "NORMAL.png"}, CONSTANTS, macros))))
    np.testing.assert_allclose(pictures[0], pictures[1], rtol=0, atol=ATOL)
    assert np.ptp(pictures[0][..., 0]) > 0.2


def test_handedness_from_the_bitangent_changes_nothing_where_nothing_is_mirrored(tmp_path):
    image = ROOT / "textures" / "GlazedTiles_1K-PNG_NormalGL.png"
    (tmp_path / "NORMAL.png").write_bytes(image.read_bytes())
    maps = {"NORMAL": "NORMAL.png"}
    plain = floats(sprj.read(write_small_project(tmp_path, maps, CONSTANTS)))
    handed = floats(sprj.read(write_small_project(tmp_path, maps, CONSTANTS, {"HAS_MIRRORED_UV": "1"})))
    np.testing.assert_allclose(handed, plain, rtol=0, atol=ATOL)


def write_quad(path, mirrored):
    """A square facing +z whose image is upright, or mirrored left to right; w says which."""
    spec = importlib.util.spec_from_file_location("glb", ROOT / "models" / "glb.py")
    glb = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(glb)
    x, y = np.float32([-1, 1, 1, -1]), np.float32([-1, -1, 1, 1])
    u = (1 - x if mirrored else 1 + x) / 2
    sign = -1 if mirrored else 1
    attributes = {
        "POSITION": np.stack([x, y, np.zeros(4)], -1).astype(np.float32),
        "NORMAL": np.tile(np.float32([0, 0, 1]), (4, 1)),
        "TANGENT": np.tile(np.float32([sign, 0, 0, sign]), (4, 1)),
        "TEXCOORD_0": np.stack([u, (1 - y) / 2], -1).astype(np.float32),
    }
    path.write_bytes(glb.pack("quad", attributes, np.array([[0, 1, 2], [0, 2, 3]], np.uint16), {}))


def test_a_mirrored_map_on_mirrored_uv_shows_the_same_surface(tmp_path):
    from PIL import Image

    bytes_ = np.random.default_rng(1).integers(30, 227, (16, 16, 3)).astype(np.uint8)
    bytes_[..., 2] = 220
    mirrored = bytes_[:, ::-1].copy()
    mirrored[..., 0] = 256 - mirrored[..., 0].astype(int)
    pictures = []
    for image, turned in ((bytes_, False), (mirrored, True)):
        Image.fromarray(image).save(tmp_path / "NORMAL.png")
        (tmp_path / "models").mkdir(exist_ok=True)
        write_quad(tmp_path / "models" / "quad.glb", turned)
        item = '<item name="Quad" type="model"><filepath>models/quad.glb</filepath><yaw>0.3</yaw></item>'
        macros = {"HAS_MIRRORED_UV": "1"}
        project = sprj.read(write_small_project(tmp_path, {"NORMAL": "NORMAL.png"}, CONSTANTS, macros, item))
        pictures.append(floats(project))
    np.testing.assert_allclose(pictures[0], pictures[1], rtol=0, atol=ATOL)
    assert np.ptp(pictures[0][..., 0]) > 0.2


VARYING_FRAG = """#version 330
in vec3 world_position;
in vec3 world_normal;
layout(location = 0) out vec4 color;
void main() {{ color = vec4({}, 1.0); }}
"""


def test_normals_are_perpendicular_under_non_uniform_scale(tmp_path):
    """A sphere scaled to the ellipsoid (x/a)^2 + (y/b)^2 + (z/c)^2 = 1 has the normal (x/a^2, y/b^2, z/c^2)."""
    scale = np.array([0.5, 1.0, 2.0])
    item = (
        '<item name="Egg" type="geometry"><type>Sphere</type><width>1</width>'
        "<scaleX>0.5</scaleX><scaleY>1</scaleY><scaleZ>2</scaleZ><topology>TriangleList</topology></item>"
    )
    project = sprj.read(write_small_project(tmp_path, {}, {}, None, item))
    images = []
    for varying in ("normalize(world_normal)", "world_position"):
        (tmp_path / "shaders" / "pbr.frag").write_text(VARYING_FRAG.format(varying))
        images.append(floats(project, (200, 200))[..., :3])
    normals, positions = images
    seen = np.abs(normals).sum(-1) > 0
    assert seen.mean() > 0.1

    def degrees(a, b):
        cosine = (a * b).sum(-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
        return np.degrees(np.arccos(np.clip(cosine, -1, 1))).max()

    want = positions[seen] / scale**2
    # Between the vertices of 20 x 20 facets, interpolated normals and flat positions part by some degrees
    assert degrees(normals[seen], want) < 8
    assert degrees(positions[seen], want) > 30  # what an untransformed normal gives
