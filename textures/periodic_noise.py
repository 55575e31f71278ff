"""Periodic noise and neighbourhood operations: everything in this file lives on a torus.

A picture tiles exactly when it is made only of functions with the picture's own period. Positions are `x` (to
the right) and `y` (downwards) in units of the whole picture, so the period is 1 in both; they may be any
arrays that broadcast together. Pictures are float64 arrays of shape (rows, columns).

Only + - * / sqrt and floor are used on floats. IEEE 754 rounds these correctly, so that every machine gets
the same last bit; sin, exp and pow differ between builds of numpy, and sums depend on the order in which they
are added.
"""

from dataclasses import dataclass

import numpy as np

# Sixteen gradients almost evenly round the circle (22.6 degrees apart instead of 22.5), exact without sin and
# cos: 5² + 12² = 13². A few fixed directions instead of random ones avoid clumps, after Perlin 2002.
_QUARTER = np.array([(1.0, 0.0), (12 / 13, 5 / 13), (np.sqrt(0.5), np.sqrt(0.5)), (5 / 13, 12 / 13)])
_HALF = np.concatenate([_QUARTER, np.stack([-_QUARTER[:, 1], _QUARTER[:, 0]], axis=1)])
GRADIENTS = np.concatenate([_HALF, -_HALF])  # (16, 2): x, y


def texel_grid(size):
    """Centres of the texels of a size x size picture: x (1, size) and y (size, 1), in (0, 1)."""
    centres = (np.arange(size) + 0.5) / size
    return centres[np.newaxis, :], centres[:, np.newaxis]


def mix(a, b, t):
    """Linear interpolation: a where t = 0, b where t = 1."""
    return a + (b - a) * t


def smoothstep(low, high, value):
    """0 below low, 1 above high, the cubic 3t² - 2t³ between; low > high turns it round."""
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def perlin(rng, x, y, frequency):
    """Gradient noise (K. Perlin, An Image Synthesizer, 1985; fade curve of Improving Noise, 2002).

    `frequency` is the number of lattice cells across the picture, one number or (along x, along y).
    Range about ±0.7 (bounded by ±1), mean 0.
    """
    columns, rows = np.broadcast_to(frequency, 2)
    gradient_x, gradient_y = np.moveaxis(GRADIENTS[rng.integers(len(GRADIENTS), size=(rows, columns))], -1, 0)

    u, v = x * columns, y * rows
    left, above = np.floor(u), np.floor(v)
    u, v = u - left, v - above
    column, row = left.astype(np.int64) % columns, above.astype(np.int64) % rows
    next_column, next_row = (column + 1) % columns, (row + 1) % rows

    def ramp(i, j, du, dv):
        return gradient_x[j, i] * du + gradient_y[j, i] * dv

    fade_u = u * u * u * (u * (u * 6.0 - 15.0) + 10.0)
    fade_v = v * v * v * (v * (v * 6.0 - 15.0) + 10.0)
    upper = mix(ramp(column, row, u, v), ramp(next_column, row, u - 1.0, v), fade_u)
    lower = mix(ramp(column, next_row, u, v - 1.0), ramp(next_column, next_row, u - 1.0, v - 1.0), fade_u)
    return mix(upper, lower, fade_v)


def fbm(rng, x, y, frequency, octaves):
    """Fractal sum of `octaves` Perlin noises, of doubling frequency and halving amplitude; range about ±1."""
    frequency = np.broadcast_to(frequency, 2)
    return sum(perlin(rng, x, y, frequency * 2**octave) / 2**octave for octave in range(octaves))


@dataclass(frozen=True)
class Cells:
    """What cellular noise tells of each texel (arrays of their shape) and of each cell (cells, cells).

    nearest, second: distance to the nearest and the second nearest site, in units of a cell's width, >= 0.
    row, column: the cell of the nearest site, to index the per-cell arrays with.
    site_x, site_y: the sites, in units of the picture.
    """

    nearest: np.ndarray
    second: np.ndarray
    row: np.ndarray
    column: np.ndarray
    site_x: np.ndarray
    site_y: np.ndarray


def cellular(rng, x, y, cells, jitter=0.9):
    """Cellular noise (S. Worley, A Cellular Texture Basis Function, 1996), a site in each of cells² squares.

    `jitter` in [0, 1] is how far sites stray from the middle of their square. Searching the 3 x 3 squares
    about a texel gives `nearest` exactly but for rare texels with jitter near 1.
    """
    offset = 0.5 + (rng.random((2, cells, cells)) - 0.5) * jitter
    u, v = np.broadcast_arrays(x * cells, y * cells)
    home_u, home_v = np.floor(u), np.floor(v)

    nearest = np.full(u.shape, np.inf)
    second = np.full(u.shape, np.inf)
    row = np.zeros(u.shape, np.int64)
    column = np.zeros(u.shape, np.int64)
    for dv in (-1, 0, 1):
        for du in (-1, 0, 1):
            i = (home_u + du).astype(np.int64) % cells
            j = (home_v + dv).astype(np.int64) % cells
            across = home_u + du + offset[0, j, i] - u
            down = home_v + dv + offset[1, j, i] - v
            squared = across * across + down * down
            closer = squared < nearest
            second = np.where(closer, nearest, np.minimum(second, squared))
            nearest = np.where(closer, squared, nearest)
            row = np.where(closer, j, row)
            column = np.where(closer, i, column)

    index = np.arange(cells)
    site_x = (index[np.newaxis, :] + offset[0]) / cells
    site_y = (index[:, np.newaxis] + offset[1]) / cells
    return Cells(np.sqrt(nearest), np.sqrt(second), row, column, site_x, site_y)


def blur(picture, times):
    """Smooth with weights 1 2 1 along both axes, `times` over; standard deviation sqrt(times / 2) texels."""
    for _ in range(times):
        for axis in (0, 1):
            neighbours = np.roll(picture, 1, axis) + np.roll(picture, -1, axis)
            picture = 0.5 * picture + 0.25 * neighbours
    return picture


def distance_to(mask, reach):
    """Distance in texels from each texel's centre to the nearest True one's, at most `reach`.

    Exact: the Euclidean distance transform as a minimum along columns, then along rows, of squares in whole
    numbers.
    """
    along_column = np.where(mask, 0, reach)
    for _ in range(reach - 1):
        above_or_below = np.minimum(np.roll(along_column, 1, 0), np.roll(along_column, -1, 0))
        along_column = np.minimum(along_column, above_or_below + 1)

    squared = along_column * along_column
    nearest = squared
    for step in range(1, reach):
        beside = np.minimum(np.roll(squared, step, 1), np.roll(squared, -step, 1))
        nearest = np.minimum(nearest, beside + step * step)
    return np.sqrt(np.minimum(nearest, reach * reach).astype(np.float64))
