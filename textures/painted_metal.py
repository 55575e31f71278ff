"""Painted metal: petrol paint chipped off brushed steel, cream primer at the chips' rims, rust within."""

import numpy as np
from material_maps import SIZE, MaterialMaps, linear_rgb
from periodic_noise import blur, cellular, distance_to, fbm, mix, perlin, smoothstep, texel_grid

SEED = 1985

# Linear base colours, given as sRGB bytes. Steel is iron, (0.56, 0.57, 0.58) in Filament's table of metals,
# and somewhat brighter where brushing polished it.
PAINT = linear_rgb(34, 86, 98)
PAINT_FADED = linear_rgb(43, 110, 117)
PRIMER = linear_rgb(222, 203, 168)
STEEL = linear_rgb(197, 198, 200)
STEEL_POLISHED = linear_rgb(222, 219, 214)
RUST_DARK = linear_rgb(92, 46, 32)
RUST = linear_rgb(164, 80, 38)
RUST_BRIGHT = linear_rgb(216, 130, 60)

# Heights in texels. Each coat is thick enough to catch light at its edge.
PAINT_THICKNESS = 2.6
PRIMER_THICKNESS = 1.3
CURL = 1.4  # chipped paint lifts towards its edge
CRACK_DEPTH = 1.5

PRIMER_HOLDS = 0.19  # weakness above which the primer, and above which the top coat, comes off
TOP_COAT_HOLDS = 0.12
FLAKE_REACH = 13.0  # texels from a chip up to which the top coat flakes off the primer
REACH = 40  # texels from a chip's edge within which anything depends on it
PLATES = 13  # coarse and fine pieces into which the paint breaks, across the picture
SHARDS = 72


def paint_damage(rng, x, y):
    """How weakly each piece holds, of the primer and of the top coat, two arrays (SIZE, SIZE), about -1 to 1.

    Paint breaks along cracks, so what falls off are unions of small polygons: the cells of a cellular noise.
    A piece's weakness is a smooth noise at its site, and values of its own and of the coarser piece that it
    belongs to.
    """
    jag_x = x + 0.0022 * fbm(rng, x, y, 90, 2)
    jag_y = y + 0.0022 * fbm(rng, x, y, 90, 2)
    shards = [cellular(rng, jag_x, jag_y, SHARDS) for _ in ("primer", "top coat")]

    # The pieces of both coats together, (coat, row, column), so that both come off about the same weak
    # places.
    site_x = np.stack([shard.site_x for shard in shards])
    site_y = np.stack([shard.site_y for shard in shards])
    bend_x = 0.02 * perlin(rng, site_x, site_y, 16)
    bend_y = 0.02 * perlin(rng, site_x, site_y, 16)
    plate = cellular(rng, site_x + bend_x, site_y + bend_y, PLATES)
    plate_weakness = rng.random((PLATES, PLATES)) - 0.5
    weakness = fbm(rng, site_x, site_y, 6, 3) + 0.75 * plate_weakness[plate.row, plate.column]
    weakness = weakness + 0.14 * (rng.random(weakness.shape) - 0.5)
    return [piece[shard.row, shard.column] for piece, shard in zip(weakness, shards, strict=True)]


def streaked_down(mask, decay):
    """Let a mask of [0, 1] run down the picture and round its border, losing `decay` a texel."""
    rows = mask.shape[0]
    streak = mask.copy()
    for row in range(2 * rows):  # twice round, so that the lowest rows' streaks reach the top
        above = streak[(row - 1) % rows]
        streak[row % rows] = np.maximum(streak[row % rows], above - decay)
    return streak


def make():
    """The whole material as pictures of SIZE x SIZE texels."""
    rng = np.random.Generator(np.random.PCG64(SEED))
    x, y = texel_grid(SIZE)

    primer_weakness, paint_weakness = paint_damage(rng, x, y)
    chip = primer_weakness > PRIMER_HOLDS
    bare = blur(chip.astype(np.float64), 2)  # the share of a texel that has no paint, with a soft edge
    into_chip = distance_to(~chip, REACH)
    into_paint = distance_to(chip, REACH)

    # Primer shows where only the top coat is gone: flakes near the chips, and a thin rim about each.
    rim = into_paint < 2.0 + 2.0 * perlin(rng, x, y, 40)
    flaked = (paint_weakness > TOP_COAT_HOLDS) & (into_paint < FLAKE_REACH)
    top_coat = blur(1.0 - (rim | flaked), 2)

    # Hairline cracks in the top coat where it is about to flake.
    pieces = cellular(rng, x + 0.006 * fbm(rng, x, y, 20, 2), y + 0.006 * fbm(rng, x, y, 20, 2), 20)
    strained = blur(smoothstep(-0.15, 0.15, paint_weakness), 8)
    here_and_there = smoothstep(-0.15, 0.15, fbm(rng, x, y, 12, 2))
    crack = smoothstep(0.065, 0.02, pieces.second - pieces.nearest) * strained * here_and_there * top_coat

    # Rust creeps from the paint's edge into the chip, and sits in pits of the bare steel.
    grain = fbm(rng, x, y, 48, 3)
    creep = 34.0 * smoothstep(-0.35, 0.8, fbm(rng, x, y, 7, 3)) + 9.0 * grain
    pits = smoothstep(0.48, 0.54, fbm(rng, x, y, 30, 3))
    rusty = np.maximum(smoothstep(1.2, -1.2, into_chip - creep), pits)
    rust = bare * rusty
    steel = bare * (1.0 - rusty)
    paint = 1.0 - bare

    # Rust water stains the paint below and about a chip.
    run = streaked_down(rust, 0.010) * smoothstep(-0.1, 0.5, perlin(rng, x, y, (80, 4)))
    halo = smoothstep(16.0, 0.0, into_paint) * smoothstep(-0.1, 0.6, fbm(rng, x, y, 9, 2))
    stain = blur(np.maximum(0.6 * run, 0.6 * halo), 3) * paint

    # Brushing: noise stretched along x, of two lengths.
    brush = 0.6 * perlin(rng, x, y, (7, 340)) + 0.4 * perlin(rng, x, y, (19, 200))
    cloud = fbm(rng, x, y, 5, 4)
    mottle = fbm(rng, x, y, 17, 4)
    orange_peel = perlin(rng, x, y, 56)

    # What lies where: each texel is steel, rust or paint, and paint is primer or top coat.
    def layered(on_steel, on_rust, on_primer, on_paint):
        coat = mix(on_primer, on_paint, top_coat)
        return steel * on_steel + rust * on_rust + paint * coat

    fade = smoothstep(-0.6, 0.8, cloud + 0.5 * mottle)
    young = smoothstep(20.0, 2.0, into_chip) * 0.5 + 0.9 * grain + 0.3 * cloud
    polish = np.clip(0.45 + 0.4 * mottle + 0.9 * brush, 0.0, 1.0)
    color = []
    for c in range(3):
        rust_color = mix(
            mix(RUST_DARK[c], RUST[c], smoothstep(-0.4, 0.4, young)),
            RUST_BRIGHT[c],
            smoothstep(0.4, 1.0, young),
        )
        channel = layered(
            mix(STEEL[c], STEEL_POLISHED[c], polish),
            rust_color,
            PRIMER[c] * (0.92 + 0.16 * mottle),
            mix(PAINT[c], PAINT_FADED[c], fade),
        )
        channel = mix(channel, RUST_DARK[c], 0.6 * crack)
        color.append(mix(channel, RUST[c], 0.8 * stain))

    roughness = layered(
        0.36 + 0.10 * brush - 0.08 * mottle,
        0.86 + 0.10 * grain,
        0.62 + 0.06 * grain,
        0.24 + 0.08 * fade + 0.05 * mottle,
    )
    roughness = mix(roughness, 0.6, np.maximum(0.8 * stain, 0.7 * crack))

    lifted = CURL * smoothstep(24.0, 0.0, into_paint) * smoothstep(-0.4, 0.3, cloud)
    height = layered(
        0.22 * brush,
        0.6 + 1.4 * grain,
        PRIMER_THICKNESS,
        PAINT_THICKNESS + lifted + 0.16 * orange_peel - CRACK_DEPTH * crack,
    )
    return MaterialMaps(np.stack(color, axis=-1), roughness, steel, blur(height, 1))
