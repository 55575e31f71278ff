"""The Utah teapot as a triangle mesh with normals, tangents and an atlas for tileable textures.

Coordinates: y up, spout toward +x, foot at y = 0, Newell's unit (rim of radius 1.4); x from -3 to 3.434,
height 3, depth 4.

Openings that are Newell's: the slot between lid (radius 1.3) and rim (1.4), the mouth of the spout, and the
ends of spout and handle, which pass through the body's wall or lie in it. He gave no bottom; here a flat disc
closes the body at its lower edge, so the pot keeps his height. (The rounded bottom of later listings reaches
down another 0.15.) The foot, where disc and body meet at a right angle, is the only crease.

Atlas: within a part, u runs once around over a whole number of repeats, to the right for one who looks from
outside with the part's upper end up; so a tileable texture shows no seam on a part, and nothing is mirrored.
It starts anew only from part to part. As in glTF, v = 0 is the image's upper edge: v falls to 0 at a part's
upper end.
"""

from typing import NamedTuple

import bezier
import newell
import numpy as np

SEGMENTS = 16
"""Spans along each side of a patch. The body is a 64-gon: at 700 px for the pot's width (109 px per unit) its
silhouette is at most 2 * 109 * (1 - cos(pi/64)) = 0.26 px from the true one."""

TILE_LENGTH = 2.0
"""Arc length along a part, in units of the mesh, of one repeat of the texture in v."""


class Mesh(NamedTuple):
    """Vertex attributes as glTF 2.0 defines them, float32, and triangles, counter-clockwise from outside."""

    position: np.ndarray
    """(vertices, 3)"""
    normal: np.ndarray
    """(vertices, 3), unit, outward"""
    tangent: np.ndarray
    """(vertices, 4): xyz unit, toward increasing u; w = +1, as cross(normal, xyz) is toward decreasing v"""
    texcoord: np.ndarray
    """(vertices, 2)"""
    triangles: np.ndarray
    """(triangles, 3), uint16"""


class Part(NamedTuple):
    """A ring of columns, each a stack of nets; s runs to the right and t up, seen from outside."""

    columns: list[list[np.ndarray]]
    """Nets (4, 4, 3), y up: [place around the part][place from its lower end up]"""
    repeats: int
    """Repeats of the texture once around the part"""


def y_up(net: np.ndarray) -> np.ndarray:
    """From Newell's axes (z up) to glTF's (y up), foot on y = 0; the spout stays toward +x."""
    x, y, z = net[..., 0], net[..., 1], net[..., 2]
    return np.stack([x, z - newell.FOOT_HEIGHT, -y], axis=-1)


def turned(net: np.ndarray, quarter_turns: int) -> np.ndarray:
    """The net turned about the axis y, counter-clockwise from above; exact, unlike a rotation matrix."""
    for _ in range(quarter_turns):
        net = np.stack([net[..., 2], net[..., 1], -net[..., 0]], axis=-1)
    return net


def mirrored(net: np.ndarray) -> np.ndarray:
    """The net mirrored in the plane z = 0, s reversed so that the outside stays outside."""
    return net[:, ::-1] * np.array([1, 1, -1])


def disc(foot: np.ndarray) -> np.ndarray:
    """The flat net from the axis (t = 0) out to the (4, 3) control points of the foot (t = 1)."""
    centre = np.zeros_like(foot)
    return np.stack([centre, foot / 3, foot * 2 / 3, foot])


def parts() -> list[Part]:
    """Body with rim and bottom, lid, knob, handle, spout."""
    # Newell's quarters run down the profile and clockwise from above: both directions are reversed.
    quarter = {name: y_up(net)[::-1, ::-1] for name, net in newell.QUARTERS.items()}
    # The halves at z >= 0. The image's up is toward the handle's upper end and toward the spout's mouth.
    half = {name: y_up(net) for name, net in newell.HALVES.items()}
    handle_lower, handle_upper = half["handle_lower"][::-1, ::-1], half["handle_upper"][::-1, ::-1]
    bottom = disc(quarter["body_lower"][0])

    def revolved(*stack: np.ndarray) -> list[list[np.ndarray]]:
        # u = 0 lies behind the handle.
        return [[turned(net, turns) for net in stack] for turns in (3, 0, 1, 2)]

    def both_halves(*stack: np.ndarray) -> list[list[np.ndarray]]:
        # u = 0 lies at the handle's inner side and at the underside of the spout.
        return [[mirrored(net) for net in stack], list(stack)]

    # The repeats keep the density around the parts near that along them, 1 / TILE_LENGTH.
    return [
        Part(revolved(bottom, quarter["body_lower"], quarter["body_upper"], quarter["rim"]), repeats=6),
        Part(revolved(quarter["lid"]), repeats=3),
        Part(revolved(quarter["knob"]), repeats=1),
        Part(both_halves(handle_lower, handle_upper), repeats=1),
        Part(both_halves(half["spout_lower"], half["spout_upper"]), repeats=1),
    ]


def mean_arc_length(points: np.ndarray) -> np.ndarray:
    """Length of the polylines along axis 0 of (m, k, 3) up to each point, mean over axis 1, (m,)."""
    chords = bezier.length(points[1:] - points[:-1])[..., 0]
    mean = chords[:, 0] * 0.0
    for k in range(chords.shape[1]):
        mean = mean + chords[:, k] / chords.shape[1]
    return np.concatenate([[0.0], np.cumsum(mean)])


def grid_triangles(position: np.ndarray) -> np.ndarray:
    """Triangles (k, 3) over (m, n, 3) points, s to the right and t up, less those that a pole collapses."""
    rows, columns = position.shape[:2]
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    triangles = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    corners = position.reshape(-1, 3)[triangles]
    is_collapsed = np.all(corners == np.roll(corners, 1, axis=1), axis=2).any(axis=1)
    return triangles[~is_collapsed]


def part_mesh(part: Part) -> Mesh:
    """Tessellate a part; patches keep their own vertices along shared borders."""
    columns = [[bezier.evaluate(net, SEGMENTS) for net in stack] for stack in part.columns]
    # u and v depend on s and t alone, so that dP/du is along dP/ds; v is common to all columns by symmetry.
    whole = np.concatenate([grid.position for grid in columns[0]])
    height = mean_arc_length(whole)
    v = (height[-1] - height) / TILE_LENGTH
    meshes = []
    for place, stack in enumerate(columns):
        across = mean_arc_length(np.concatenate([grid.position for grid in stack]).swapaxes(0, 1))
        u = (place + across / across[-1]) * part.repeats / len(columns)
        for grid, v_of_patch in zip(stack, v.reshape(len(stack), -1), strict=True):
            texcoord = np.stack(np.meshgrid(u, v_of_patch), axis=-1)
            handedness = np.ones((*texcoord.shape[:2], 1))
            tangent = np.concatenate([grid.tangent, handedness], axis=-1)
            triangles = grid_triangles(grid.position)
            meshes.append(Mesh(grid.position, grid.normal, tangent, texcoord, triangles))
    return joined(meshes)


def joined(meshes: list[Mesh]) -> Mesh:
    """One mesh of many; attributes (..., k) become (vertices, k) of float32 without negative zeros."""
    attributes = []
    for arrays in zip(*(mesh[:-1] for mesh in meshes), strict=True):
        whole = np.concatenate([array.reshape(-1, array.shape[-1]) for array in arrays])
        attributes.append(whole.astype(np.float32) + np.float32(0))  # -0 + 0 is +0
    triangles, first = [], 0
    for mesh in meshes:
        triangles.append(mesh.triangles.astype(np.int64) + first)
        first += mesh.position.size // 3
    if first > 65535:
        raise ValueError(f"{first} vertices do not fit 16-bit indices (65535 is glTF's restart value)")
    return Mesh(*attributes, np.concatenate(triangles).astype(np.uint16))


def teapot() -> Mesh:
    """The whole teapot."""
    return joined([part_mesh(part) for part in parts()])
