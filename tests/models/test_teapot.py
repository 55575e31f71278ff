"""The teapot files: Newell's figures, a sound frame at each vertex, an atlas without mirroring, stable bytes.

The files are read here by hand, and the surface is evaluated here by de Casteljau's algorithm, so that
nothing of the script under test judges itself. The unit of length is Newell's: rim of radius 1.4.
"""

import importlib
import json
import math
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

MODELS = Path(__file__).resolve().parents[2] / "models"
SCRIPT = MODELS / "make_models.py"
FILES = ["teapot.glb", "teapot_plain.glb"]

# Figures of the published 28 patches (no bottom), to the digits given there; half a last digit is allowed.
AREA = 45.38
BOUNDS = np.array([[-3.000, 0.000, -2.000], [3.434, 3.000, 2.000]])
HALF_DIGIT_OF_AREA = 0.005
HALF_DIGIT_OF_BOUNDS = 0.0005
FOOT_RADIUS = 1.5

# A component of a unit vector is rounded to float32 by at most half an ulp of [1/2, 1], 2^-25. Its length is
# then wrong by at most sqrt(3) 2^-25 (Cauchy and Schwarz), and the product of two such vectors by twice that.
ROUNDING = math.sqrt(3) * 2**-25


class Glb:
    """A .glb file with one primitive: its JSON `document`, `attributes` by semantic, `triangles` (k, 3)."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, size = struct.unpack_from("<4sII", data, 0)
        assert (magic, version, size) == (b"glTF", 2, len(data))
        json_size, json_kind = struct.unpack_from("<I4s", data, 12)
        binary_size, binary_kind = struct.unpack_from("<I4s", data, 20 + json_size)
        assert (json_kind, binary_kind) == (b"JSON", b"BIN\0")
        assert json_size % 4 == binary_size % 4 == 0
        assert 28 + json_size + binary_size == size
        self.document = json.loads(data[20 : 20 + json_size])
        self.binary = data[28 + json_size :]
        (mesh,) = self.document["meshes"]
        (primitive,) = mesh["primitives"]
        assert primitive["mode"] == 4
        self.attributes = {name: self.array(index) for name, index in primitive["attributes"].items()}
        self.triangles = self.array(primitive["indices"]).reshape(-1, 3)

    def array(self, index):
        accessor = self.document["accessors"][index]
        view = self.document["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        kind = np.dtype({5123: "<u2", 5126: "<f4"}[accessor["componentType"]])
        assert view["byteOffset"] % 4 == 0
        assert view["byteLength"] == accessor["count"] * width * kind.itemsize
        values = np.frombuffer(self.binary, kind, accessor["count"] * width, view["byteOffset"])
        # float64, so that the tests' own arithmetic adds nothing to the errors they measure
        return values.reshape(-1, width).astype(np.float64 if kind.kind == "f" else np.int64)

    def corners(self, semantic):
        """An attribute at the triangles' corners, (triangles, 3, k)."""
        return self.attributes[semantic][self.triangles]


@pytest.fixture(scope="module")
def teapot():
    return Glb(MODELS / "teapot.glb")


@pytest.fixture(scope="module", params=FILES)
def either(request):
    return Glb(MODELS / request.param)


@pytest.fixture(scope="module")
def newell():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(MODELS))
        patch.setattr(sys, "dont_write_bytecode", True)
        return importlib.import_module("newell")


# --- Newell's surface ---------------------------------------------------------------------------------------


def de_casteljau(points, x):
    """A Bezier curve of control points (4, ...) and its derivative at the values x, (len(x), ...)."""
    x = x.reshape(-1, *[1] * (points.ndim - 1))
    levels = [list(points)]
    while len(levels[-1]) > 1:
        levels.append([(1 - x) * a + x * b for a, b in zip(levels[-1], levels[-1][1:], strict=False)])
    before_last = levels[-2]
    return levels[-1][0], 3 * (before_last[1] - before_last[0])


def patch(net, x):
    """Points, dP/ds and dP/dt of a net at the grid x by x, (len(x), len(x), 3) each: [t, s]."""
    along_t, along_t_dt = de_casteljau(net, x)
    point, dP_ds = de_casteljau(along_t.swapaxes(0, 1), x)
    dP_dt, _ = de_casteljau(along_t_dt.swapaxes(0, 1), x)
    return point.swapaxes(0, 1), dP_ds.swapaxes(0, 1), dP_dt.swapaxes(0, 1)


def test_surface_area_is_the_published_one(newell):
    nodes, weights = np.polynomial.legendre.leggauss(32)
    x, w = (nodes + 1) / 2, weights / 2
    total = 0
    for nets, copies in [(newell.QUARTERS, 4), (newell.HALVES, 2)]:
        for net in nets.values():
            _, dP_ds, dP_dt = patch(net, x)
            total += copies * (w[:, None] * w * np.linalg.norm(np.cross(dP_ds, dP_dt), axis=-1)).sum()
    assert abs(total - AREA) <= HALF_DIGIT_OF_AREA


def test_surface_bounds_are_the_published_ones(newell):
    x = np.linspace(0, 1, 301)
    quarters = np.concatenate([patch(net, x)[0].reshape(-1, 3) for net in newell.QUARTERS.values()])
    halves = np.concatenate([patch(net, x)[0].reshape(-1, 3) for net in newell.HALVES.values()])
    points = np.concatenate([quarters * [-1, 1, 1], quarters, halves])
    points = np.concatenate([points, points * [1, -1, 1]])
    lower, upper = points.min(axis=0), points.max(axis=0)
    assert np.allclose([lower[0], upper[0]], BOUNDS[:, 0], rtol=0, atol=HALF_DIGIT_OF_BOUNDS)
    assert np.allclose([lower[1], upper[1]], BOUNDS[:, 2], rtol=0, atol=HALF_DIGIT_OF_BOUNDS)
    assert abs(upper[2] - lower[2] - BOUNDS[1, 1]) <= HALF_DIGIT_OF_BOUNDS


def test_rim_has_radius_1_4(newell):
    assert newell.QUARTERS["rim"][0, 0].tolist() == [1.4, 0, 2.4]


# --- The mesh -----------------------------------------------------------------------------------------------


def test_mesh_bounds_are_the_published_ones(either):
    """Also as declared in the file. Chords cut the one extreme between vertices, at the spout, by 0.0006."""
    position = either.attributes["POSITION"]
    bounds = np.array([position.min(axis=0), position.max(axis=0)])
    assert np.all(np.abs(bounds - BOUNDS) <= HALF_DIGIT_OF_BOUNDS)
    primitive = either.document["meshes"][0]["primitives"][0]
    accessor = either.document["accessors"][primitive["attributes"]["POSITION"]]
    assert np.array_equal([accessor["min"], accessor["max"]], bounds)


def test_mesh_area_is_the_surface_and_the_bottom(either):
    """Less what chords cut: of a circle's length (pi/k)^2 / 6, so 0.04 % of the body, 0.16 % of the tubes."""
    a, b, c = either.corners("POSITION").swapaxes(0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    expected = AREA + math.pi * FOOT_RADIUS**2
    assert 0.998 * expected < area < expected


def test_every_value_is_finite(either):
    for values in either.attributes.values():
        assert np.isfinite(values).all()


def test_every_triangle_has_area(either):
    a, b, c = either.corners("POSITION").swapaxes(0, 1)
    # far below the smallest here, about 1e-4, and far above the rounding of 3-unit coordinates squared, 1e-13
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-6


def test_normals_are_unit(either):
    assert np.abs(np.linalg.norm(either.attributes["NORMAL"], axis=1) - 1).max() <= ROUNDING


def test_tangents_are_unit(teapot):
    assert np.abs(np.linalg.norm(teapot.attributes["TANGENT"][:, :3], axis=1) - 1).max() <= ROUNDING


def test_tangents_are_orthogonal_to_normals(teapot):
    products = (teapot.attributes["TANGENT"][:, :3] * teapot.attributes["NORMAL"]).sum(axis=1)
    assert np.abs(products).max() <= 2 * ROUNDING


def test_normals_agree_with_the_winding(either):
    """Within the turn of the surface over a triangle: 21 degrees (cosine 0.93) at the edge of the lid.

    The lip of the spout is sharper: 47 degrees (0.68) over a few hundredths of a unit.
    """
    a, b, c = either.corners("POSITION").swapaxes(0, 1)
    face = np.cross(b - a, c - a)
    face /= np.linalg.norm(face, axis=1, keepdims=True)
    cosine = (either.corners("NORMAL") * face[:, None]).sum(axis=2).min(axis=1)
    middle = (a + b + c) / 3
    at_lip = (middle[:, 0] > 2.7) & (middle[:, 1] > 2.25)
    assert cosine[~at_lip].min() > 0.92
    assert cosine[at_lip].min() > 0.65


def test_each_shell_encloses_a_positive_volume(either):
    """By Gauss's theorem about each shell's own middle, openings left out; a shell inside out is negative."""
    corners = either.corners("POSITION")
    shell = shells(either)
    assert len(set(shell)) == 4  # body, lid with knob, handle, spout
    for name in set(shell):
        a, b, c = (corners[shell == name] - corners[shell == name].mean(axis=(0, 1))).swapaxes(0, 1)
        assert (a * np.cross(b, c)).sum() / 6 > 0.1


def test_poles_have_the_axis_as_normal(either):
    position, normal = either.attributes["POSITION"], either.attributes["NORMAL"]
    for height, up in [(3, 1), (0, -1)]:
        at_pole = np.all(np.abs(position - [0, height, 0]) < 1e-6, axis=1)
        assert at_pole.sum() == 4 * 17
        assert np.abs(normal[at_pole] - [0, up, 0]).max() <= ROUNDING


# --- Borders: edges are told by the positions of their ends, since patches do not share vertices ------------


def half_edges(glb):
    """(place of start, place of end) (3k, 2) of every triangle's sides, and the vertices there (3k, 2)."""
    _, place = np.unique(glb.attributes["POSITION"], axis=0, return_inverse=True)
    vertices = np.stack([glb.triangles, np.roll(glb.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    return place.reshape(-1)[vertices], vertices


def twins(glb):
    """Indices (k,) of the half edges along which another one runs in the other direction, and of that one."""
    places, _ = half_edges(glb)
    number = {tuple(edge): index for index, edge in enumerate(places.tolist())}
    pairs = [(index, number.get((end, start))) for (start, end), index in number.items()]
    return np.array([pair for pair in pairs if pair[1] is not None]).T


def at_twins(glb, semantic):
    """An attribute at both ends of the half edges with a twin, and there at the twin, (k, 2, n) each."""
    _, vertices = half_edges(glb)
    here, there = twins(glb)
    values = glb.attributes[semantic]
    return values[vertices[here]], values[vertices[there][:, ::-1]]


def shells(glb):
    """A number for every triangle (k,), the same for triangles that share an edge."""
    here, there = twins(glb) // 3
    shell = np.arange(len(glb.triangles))
    while True:  # the smallest number spreads over edges, and jumps along the chains that it leaves
        spread = shell.copy()
        np.minimum.at(spread, here, shell[there])
        spread = spread[spread]
        if np.array_equal(spread, shell):
            return shell
        shell = spread


def radius(position):
    """Distance from the pot's axis."""
    return np.hypot(position[..., 0], position[..., 2])


def test_the_only_crease_is_the_foot(either):
    here, there = at_twins(either, "NORMAL")
    position, _ = at_twins(either, "POSITION")
    differs = np.linalg.norm(here - there, axis=2).max(axis=1) > 1e-3
    at_foot = np.all((position[..., 1] == 0) & (radius(position) > 1.49), axis=1)
    assert np.array_equal(differs, at_foot)


def test_no_edge_has_more_than_two_triangles(either):
    places, _ = half_edges(either)
    assert len(np.unique(places, axis=0)) == len(places)


def test_the_only_openings_are_newells(either):
    places, vertices = half_edges(either)
    known = set(map(tuple, places.tolist()))
    is_open = np.array([(end, start) not in known for start, end in places.tolist()])
    x, y, z = either.attributes["POSITION"][vertices[is_open]].reshape(-1, 3).T
    off_axis = np.hypot(x, z)

    def near(value, expected):
        return np.abs(value - expected) < 0.01  # quarter turns are not quite circles

    openings = {
        "rim": near(y, 2.25) & near(off_axis, 1.4),
        "lid": near(y, 2.25) & near(off_axis, 1.3),
        "mouth of the spout": near(y, 2.25) & (x > 2.75),
        "spout in the body": near(x, 1.7) & (y > 0.44) & (y < 1.28),
        "upper end of the handle": (x > -1.61) & (x < -1.49) & (y > 1.87) & (np.abs(z) < 0.23),
        "lower end of the handle": (x > -2.01) & (x < -1.89) & (y < 0.76) & (np.abs(z) < 0.23),
    }
    edges = {name: int(found.sum()) // 2 for name, found in openings.items()}
    assert edges == dict.fromkeys(["rim", "lid"], 64) | dict.fromkeys(list(openings)[2:], 32)
    assert is_open.sum() == sum(edges.values())


# --- The atlas ----------------------------------------------------------------------------------------------


def uv_gradients(glb):
    """dP/du and dP/dv of every triangle, (k, 3) each, and the signed area of the triangles in uv (k,)."""
    a, b, c = glb.corners("POSITION").swapaxes(0, 1)
    uv_a, uv_b, uv_c = glb.corners("TEXCOORD_0").swapaxes(0, 1)
    (du1, dv1), (du2, dv2) = (uv_b - uv_a).T[..., None], (uv_c - uv_a).T[..., None]
    determinant = du1 * dv2 - du2 * dv1
    dP_du = ((b - a) * dv2 - (c - a) * dv1) / determinant
    dP_dv = ((c - a) * du1 - (b - a) * du2) / determinant
    return dP_du, dP_dv, determinant[:, 0] / 2


def test_nothing_is_mirrored(teapot):
    """Counter-clockwise outside is clockwise in (u, v), since v points down the image."""
    assert (uv_gradients(teapot)[2] < 0).all()


def test_handedness_is_plus_one(teapot):
    assert (teapot.attributes["TANGENT"][:, 3] == 1).all()


def test_tangents_point_along_increasing_u(teapot):
    """Within the turn of the surface over a triangle: 16 degrees (cosine 0.96) at the handle's upper bend."""
    dP_du, _, _ = uv_gradients(teapot)
    dP_du /= np.linalg.norm(dP_du, axis=1, keepdims=True)
    cosines = (teapot.corners("TANGENT")[..., :3] * dP_du[:, None]).sum(axis=2)
    assert cosines.min() > 0.95


def test_bitangents_point_up_the_image(teapot):
    _, dP_dv, _ = uv_gradients(teapot)
    tangent = teapot.corners("TANGENT")
    bitangent = np.cross(teapot.corners("NORMAL"), tangent[..., :3]) * tangent[..., 3:]
    assert (bitangent * dP_dv[:, None]).sum(axis=2).max() < 0


def test_texture_runs_on_across_every_border_but_the_neck_of_the_knob(teapot):
    """Up to whole repeats in u. At the poles u is any; uv up to 6 are rounded to float32 by at most 2^-22."""
    here, there = at_twins(teapot, "TEXCOORD_0")
    position, _ = at_twins(teapot, "POSITION")
    step = here - there
    step[..., 0] -= np.round(step[..., 0])
    step[radius(position) == 0, 0] = 0
    breaks = np.abs(step).max(axis=(1, 2)) > 2 * 2**-22
    at_neck = (np.abs(position[..., 1] - 2.55) < 1e-6) & (radius(position) < 0.21)
    assert np.array_equal(breaks, at_neck.all(axis=1))


def test_texture_density_is_even(teapot):
    """Repeats per unit of length are within a factor of 2 of 1/2 in all directions on 90 % of the area.

    The rest are the middle of the bottom, lid and knob, where u converges, and parts of handle and spout. A
    texture is nowhere stretched to less than 1/4.
    """
    dP_du, dP_dv, _ = uv_gradients(teapot)
    density = 1 / np.linalg.svd(np.stack([dP_du, dP_dv], axis=-1), compute_uv=False)
    a, b, c = teapot.corners("POSITION").swapaxes(0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert density.min() > 1 / 4
    assert area[density.max(axis=1) < 1].sum() > 0.9 * area.sum()


# --- The files ----------------------------------------------------------------------------------------------


def test_full_file_has_just_what_passes_with_maps_need(teapot):
    assert list(teapot.attributes) == ["POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"]


def test_plain_file_is_the_same_mesh_with_position_and_normal_only(teapot):
    plain = Glb(MODELS / "teapot_plain.glb")
    assert list(plain.attributes) == ["POSITION", "NORMAL"]
    assert len(plain.document["accessors"]) == 3
    for name, values in plain.attributes.items():
        assert np.array_equal(values, teapot.attributes[name])
    assert np.array_equal(plain.triangles, teapot.triangles)


def test_no_node_has_a_transform(either):
    """SHADERed ignores it."""
    assert all(not {"matrix", "translation", "rotation", "scale"} & set(n) for n in either.document["nodes"])


def make_models(*arguments):
    command = [sys.executable, "-B", str(SCRIPT), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("name", FILES)
def test_regenerated_bytes_equal_the_committed_files(name, tmp_path):
    assert make_models("--directory", str(tmp_path)).returncode == 0
    assert (tmp_path / name).read_bytes() == (MODELS / name).read_bytes()


def test_generation_leaves_no_other_file(tmp_path):
    make_models("--directory", str(tmp_path))
    assert sorted(path.name for path in tmp_path.iterdir()) == FILES


def test_check_accepts_the_committed_files():
    assert make_models("--check").returncode == 0


@pytest.mark.parametrize("name", FILES)
def test_check_names_a_changed_file(name, tmp_path):
    make_models("--directory", str(tmp_path))
    content = bytearray((tmp_path / name).read_bytes())
    content[-1] ^= 1
    (tmp_path / name).write_bytes(content)
    outcome = make_models("--check", "--directory", str(tmp_path))
    assert outcome.returncode == 1
    assert name in outcome.stderr
    assert (tmp_path / name).read_bytes() == content
