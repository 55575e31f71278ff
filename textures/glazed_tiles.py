"""Glazed tiles: a hand-laid hexagonal mosaic of glossy, slightly domed tiles in rough grout."""

import numpy as np
from material_maps import SIZE, MaterialMaps, linear_rgb
from periodic_noise import cellular, fbm, mix, perlin, smoothstep, texel_grid

SEED = 1917

# Seven hexagons across and eight rows make 8 / 7 = 1.143 of sqrt(4 / 3) = 1.155: within 1 % of regular
# hexagons, and an even number of rows lets every other row be shifted by half a tile.
COLUMNS, ROWS = 7, 8

# Each letter is the glaze of a tile; odd rows are shifted half a tile to the right. Rosettes of cream round
# terracotta.
PATTERN = (
    "CTCpdbp",
    "CCbCCdb",
    "dpdCTCp",
    "CCpCCdb",
    "CTCdpbp",
    "CCbCCdb",
    "dbdCTCp",
    "CCbCCdb",
)
GLAZES = {  # linear albedo, given as sRGB bytes
    "C": linear_rgb(226, 211, 181),
    "T": linear_rgb(186, 96, 62),
    "d": linear_rgb(52, 78, 124),
    "b": linear_rgb(92, 144, 172),
    "p": linear_rgb(42, 108, 116),
}
GROUT = linear_rgb(116, 107, 96)
IRON = linear_rgb(78, 58, 46)  # specks in the glaze
CLAY = linear_rgb(168, 112, 80)  # the body, seen through thin glaze at the edges

# Lengths and heights in texels.
GROUT_HALF_WIDTH = 5.5
CORNER = 14.0  # how far corners are rounded
EDGE_WIDTH = 17.0
EDGE_HEIGHT = 6.0
DOME_HEIGHT = 4.0
TILT = 0.05  # slope by which a tile may lie crooked: it makes each catch the light in its own way


def smooth_minimum(a, b, width):
    """The lesser of a and b, rounded off where they differ by less than `width` (I. Quilez, 2013)."""
    overlap = np.maximum(width - np.abs(a - b), 0.0)
    return np.minimum(a, b) - overlap * overlap / (4.0 * width)


def lay_tiles(rng):
    """Lay the mosaic: which texel belongs to which tile, and where in it.

    Returns inside (distance in texels to the tile's edge, positive inside it, with rounded corners), tile
    (row-major index into the pattern), and right, down (offset in texels from the tile's middle), all of
    shape (SIZE, SIZE). Edges are halfway between neighbours' middles: the Voronoi diagram of a hexagonal
    lattice, a little disturbed.
    """
    pitch_x, pitch_y = SIZE / COLUMNS, SIZE / ROWS
    row, column = np.divmod(np.arange(COLUMNS * ROWS), COLUMNS)
    middle_x = (column + 0.5 + 0.5 * (row % 2)) * pitch_x + (rng.random(row.size) - 0.5) * 0.09 * pitch_x
    middle_y = (row + 0.5) * pitch_y + (rng.random(row.size) - 0.5) * 0.09 * pitch_y

    inside = np.full((SIZE, SIZE), -np.inf)
    tile = np.zeros((SIZE, SIZE), np.int64)
    right = np.zeros((SIZE, SIZE))
    down = np.zeros((SIZE, SIZE))
    half = int(0.75 * pitch_x)
    window = np.arange(-half, half + 1)
    for this in range(row.size):
        i, j = int(middle_x[this]) + window, int(middle_y[this]) + window
        dx = (i + 0.5 - middle_x[this])[np.newaxis, :]
        dy = (j + 0.5 - middle_y[this])[:, np.newaxis]

        edge = np.full((window.size, window.size), np.inf)
        # The nearest copy of every other tile, by the torus; beyond the second ring none can touch this one.
        to_x = (middle_x - middle_x[this] + SIZE / 2) % SIZE - SIZE / 2
        to_y = (middle_y - middle_y[this] + SIZE / 2) % SIZE - SIZE / 2
        away = np.sqrt(to_x * to_x + to_y * to_y)
        for other in np.flatnonzero((away > 0) & (away < 1.5 * pitch_x)):
            along = (dx * to_x[other] + dy * to_y[other]) / away[other]
            edge = smooth_minimum(edge, away[other] / 2 - along, CORNER)

        place = np.ix_(j % SIZE, i % SIZE)
        mine = edge > inside[place]
        inside[place] = np.where(mine, edge, inside[place])
        tile[place] = np.where(mine, this, tile[place])
        right[place] = np.where(mine, dx, right[place])
        down[place] = np.where(mine, dy, down[place])
    return inside, tile, right, down


def make():
    """The whole material as pictures of SIZE x SIZE texels."""
    rng = np.random.Generator(np.random.PCG64(SEED))
    x, y = texel_grid(SIZE)
    inside, tile, right, down = lay_tiles(rng)
    count = COLUMNS * ROWS

    # Hand-cut edges are wavy, and chipped a little.
    wobble = 2.2 * perlin(rng, x, y, 22) + 0.8 * perlin(rng, x, y, 70)
    inside = inside - GROUT_HALF_WIDTH + wobble
    glazed = smoothstep(-0.8, 0.8, inside)

    # Height: a rounded edge that ends level, times a dome that lies slightly crooked.
    step = np.clip(inside / EDGE_WIDTH, 0.0, 1.0)
    edge = step * (2.0 - step)
    radius = 0.5 * SIZE / ROWS
    dome = 1.0 - (right * right + down * down) / (radius * radius)
    tilt_x, tilt_y = (rng.random((2, count)) - 0.5) * 2.0 * TILT
    lie = tilt_x[tile] * right + tilt_y[tile] * down
    ripple = fbm(rng, x, y, 14, 2)
    sand = fbm(rng, x, y, 90, 2)
    pitted = fbm(rng, x, y, 24, 3)
    tile_height = edge * (EDGE_HEIGHT + DOME_HEIGHT * dome + lie + 0.7 * ripple)
    grout_height = 0.5 * sand + 0.4 * pitted
    height = mix(grout_height, tile_height, glazed)

    # Colour: the glaze of the pattern, lighter or darker from tile to tile, pooling darker in the middle, and
    # breaking to the clay's colour at the edge where it is thin.
    glaze = np.array([GLAZES[letter] for letter in "".join(PATTERN)])
    shade = 0.77 + 0.25 * rng.random(count)
    warmth = 0.06 * (rng.random(count) - 0.5)
    tint = np.stack([shade * (1.0 + warmth), shade, shade * (1.0 - warmth)], axis=-1)
    flow = fbm(rng, x, y, 9, 3)
    pool = 0.94 + 0.14 * flow + 0.14 * smoothstep(0.55, 0.1, dome)
    thin = smoothstep(9.0, 0.0, inside + 5.0 * pitted) * 0.7
    speck = cellular(rng, x, y, 60)
    spot_size = np.maximum(rng.random((60, 60)) - 0.72, 0.0)[speck.row, speck.column] + 1e-6
    iron = smoothstep(spot_size, 0.5 * spot_size, speck.nearest) * smoothstep(0.0, 0.3, pitted)
    color = []
    for c in range(3):
        body = (glaze * tint)[tile, c] * pool
        body = mix(body, CLAY[c], thin)
        body = mix(body, IRON[c], 0.8 * iron)
        bed = GROUT[c] * (1.0 + 0.25 * pitted + 0.2 * sand)
        color.append(mix(bed, body, glazed))

    # Not glossier than 0.13: the lobe of a smoother glaze is narrower than a step of the 8-bit normals, 0.45
    # degrees, which would show as facets.
    gloss = 0.15 + 0.08 * rng.random(count)
    glaze_roughness = gloss[tile] + 0.03 * flow + 0.3 * thin
    roughness = mix(0.88 + 0.06 * sand, glaze_roughness, glazed)
    return MaterialMaps(np.stack(color, axis=-1), roughness, None, height)
