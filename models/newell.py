"""Newell's teapot: the control points of its bicubic Bezier patches, in the compact form of nine nets.

Source: M. Newell, "The Utilization of Procedure Models in Digital Image Synthesis", PhD thesis, University
of Utah, 1975; the numbers as they circulate since F. Crow, "The Origins of the Teapot", IEEE Computer
Graphics and Applications 7(1), 1987.

Coordinates: z up, spout toward +x, handle toward -x, rim of radius 1.4, foot at z = FOOT_HEIGHT, top of the
knob at z = 3.15. Each net has four rows along the profile, each of four points (x, y, z) across it. The pot
has 28 patches and no bottom: each net of QUARTERS is used four times, turned about the z axis, and each net
of HALVES twice, mirrored in the plane y = 0.

One known misprint is avoided: some listings have y = +0.15 for the third point of the spout's last row, where
the half spout lies at y <= 0; that folds the spout's tip.
"""

import numpy as np

FOOT_HEIGHT = 0.15
"""z of the body's lower edge, on which the pot stands."""

RIM = [
    [(1.4, 0, 2.4), (1.4, -0.784, 2.4), (0.784, -1.4, 2.4), (0, -1.4, 2.4)],
    [(1.3375, 0, 2.53125), (1.3375, -0.749, 2.53125), (0.749, -1.3375, 2.53125), (0, -1.3375, 2.53125)],
    [(1.4375, 0, 2.53125), (1.4375, -0.805, 2.53125), (0.805, -1.4375, 2.53125), (0, -1.4375, 2.53125)],
    [(1.5, 0, 2.4), (1.5, -0.84, 2.4), (0.84, -1.5, 2.4), (0, -1.5, 2.4)],
]

BODY_UPPER = [
    [(1.5, 0, 2.4), (1.5, -0.84, 2.4), (0.84, -1.5, 2.4), (0, -1.5, 2.4)],
    [(1.75, 0, 1.875), (1.75, -0.98, 1.875), (0.98, -1.75, 1.875), (0, -1.75, 1.875)],
    [(2, 0, 1.35), (2, -1.12, 1.35), (1.12, -2, 1.35), (0, -2, 1.35)],
    [(2, 0, 0.9), (2, -1.12, 0.9), (1.12, -2, 0.9), (0, -2, 0.9)],
]

BODY_LOWER = [
    [(2, 0, 0.9), (2, -1.12, 0.9), (1.12, -2, 0.9), (0, -2, 0.9)],
    [(2, 0, 0.45), (2, -1.12, 0.45), (1.12, -2, 0.45), (0, -2, 0.45)],
    [(1.5, 0, 0.225), (1.5, -0.84, 0.225), (0.84, -1.5, 0.225), (0, -1.5, 0.225)],
    [(1.5, 0, 0.15), (1.5, -0.84, 0.15), (0.84, -1.5, 0.15), (0, -1.5, 0.15)],
]

KNOB = [
    [(0, 0, 3.15), (0, 0, 3.15), (0, 0, 3.15), (0, 0, 3.15)],
    [(0.8, 0, 3.15), (0.8, -0.45, 3.15), (0.45, -0.8, 3.15), (0, -0.8, 3.15)],
    [(0, 0, 2.85), (0, 0, 2.85), (0, 0, 2.85), (0, 0, 2.85)],
    [(0.2, 0, 2.7), (0.2, -0.112, 2.7), (0.112, -0.2, 2.7), (0, -0.2, 2.7)],
]

LID = [
    [(0.2, 0, 2.7), (0.2, -0.112, 2.7), (0.112, -0.2, 2.7), (0, -0.2, 2.7)],
    [(0.4, 0, 2.55), (0.4, -0.224, 2.55), (0.224, -0.4, 2.55), (0, -0.4, 2.55)],
    [(1.3, 0, 2.55), (1.3, -0.728, 2.55), (0.728, -1.3, 2.55), (0, -1.3, 2.55)],
    [(1.3, 0, 2.4), (1.3, -0.728, 2.4), (0.728, -1.3, 2.4), (0, -1.3, 2.4)],
]

HANDLE_UPPER = [
    [(-1.6, 0, 2.025), (-1.6, -0.3, 2.025), (-1.5, -0.3, 2.25), (-1.5, 0, 2.25)],
    [(-2.3, 0, 2.025), (-2.3, -0.3, 2.025), (-2.5, -0.3, 2.25), (-2.5, 0, 2.25)],
    [(-2.7, 0, 2.025), (-2.7, -0.3, 2.025), (-3, -0.3, 2.25), (-3, 0, 2.25)],
    [(-2.7, 0, 1.8), (-2.7, -0.3, 1.8), (-3, -0.3, 1.8), (-3, 0, 1.8)],
]

HANDLE_LOWER = [
    [(-2.7, 0, 1.8), (-2.7, -0.3, 1.8), (-3, -0.3, 1.8), (-3, 0, 1.8)],
    [(-2.7, 0, 1.575), (-2.7, -0.3, 1.575), (-3, -0.3, 1.35), (-3, 0, 1.35)],
    [(-2.5, 0, 1.125), (-2.5, -0.3, 1.125), (-2.65, -0.3, 0.9375), (-2.65, 0, 0.9375)],
    [(-2, 0, 0.9), (-2, -0.3, 0.9), (-1.9, -0.3, 0.6), (-1.9, 0, 0.6)],
]

SPOUT_LOWER = [
    [(1.7, 0, 1.425), (1.7, -0.66, 1.425), (1.7, -0.66, 0.6), (1.7, 0, 0.6)],
    [(2.6, 0, 1.425), (2.6, -0.66, 1.425), (3.1, -0.66, 0.825), (3.1, 0, 0.825)],
    [(2.3, 0, 2.1), (2.3, -0.25, 2.1), (2.4, -0.25, 2.025), (2.4, 0, 2.025)],
    [(2.7, 0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0, 2.4)],
]

SPOUT_UPPER = [
    [(2.7, 0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0, 2.4)],
    [(2.8, 0, 2.475), (2.8, -0.25, 2.475), (3.525, -0.25, 2.49375), (3.525, 0, 2.49375)],
    [(2.9, 0, 2.475), (2.9, -0.15, 2.475), (3.45, -0.15, 2.5125), (3.45, 0, 2.5125)],
    [(2.8, 0, 2.4), (2.8, -0.15, 2.4), (3.2, -0.15, 2.4), (3.2, 0, 2.4)],
]

QUARTERS = {
    name: np.array(net, dtype=np.float64)
    for name, net in {
        "rim": RIM,
        "body_upper": BODY_UPPER,
        "body_lower": BODY_LOWER,
        "knob": KNOB,
        "lid": LID,
    }.items()
}
"""Nets (4, 4, 3) of a quarter turn: rows go down the profile, columns from the +x axis to the -y axis."""

HALVES = {
    name: np.array(net, dtype=np.float64)
    for name, net in {
        "handle_upper": HANDLE_UPPER,
        "handle_lower": HANDLE_LOWER,
        "spout_lower": SPOUT_LOWER,
        "spout_upper": SPOUT_UPPER,
    }.items()
}
"""Nets (4, 4, 3) of the half at y <= 0. Rows go along the tube: down the handle, up the spout."""
