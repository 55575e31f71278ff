"""Draws the pictures of extremes.md: tiles with a label each, in rows, as small PNGs without loss.

A tile is (size, size, 3) bytes, or of any height and width. What is not a number, or infinite, is MAGENTA.
"""

from __future__ import annotations

import io

import numpy as np
from PIL import Image, ImageDraw, ImageFont

MAGENTA = (255, 0, 200)
BACKDROP = 60
GAP = 6
LABEL = 18

Tile = tuple[str, np.ndarray]


def radiance(values: np.ndarray, exposure: float, inside: np.ndarray | None = None) -> np.ndarray:
    """Bytes of a grey picture: values (height, width), times the exposure, encoded by sRGB; a backdrop outside."""
    values = np.asarray(values, float)
    bad = ~np.isfinite(values)
    linear = np.clip(np.where(bad, 0, values) * exposure, 0, 1)
    encoded = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    grey = np.rint(255 * encoded).astype(np.uint8)
    if inside is not None:
        grey, bad = np.where(inside, grey, BACKDROP).astype(np.uint8), bad & inside
    return np.where(bad[..., None], np.array(MAGENTA, np.uint8), grey[..., None])


def ratio(values: np.ndarray, full: float = 2.0) -> np.ndarray:
    """Bytes of a map of ratios: grey where 1, the redder the larger up to ``full``, the bluer the smaller to 1/full."""
    stops = np.rint(16 * np.clip(np.log(values) / np.log(full), -1, 1)) / 16
    more, less = np.maximum(stops, 0), np.maximum(-stops, 0)
    channels = np.stack(
        [0.75 + 0.25 * more - 0.75 * less, 0.75 - 0.75 * (more + less), 0.75 - 0.75 * more + 0.25 * less], -1
    )
    return np.rint(255 * channels).astype(np.uint8)


def graph(curve: np.ndarray, top: float, height: int = 96, signed: bool = True) -> np.ndarray:
    """Bytes of a graph of a value for each column, filled to its zero line: in the middle, or at the foot."""
    zero = height // 2 if signed else height - 1
    rows = np.round(np.clip(np.asarray(curve, float) / top, -1, 1) * (zero - 1)).astype(int)
    level = zero - np.arange(height)[:, None]
    filled = np.where(rows > 0, (level > 0) & (level <= rows), (level < 0) & (level >= rows))
    out = np.full((height, len(rows), 3), 240, np.uint8)
    out[np.broadcast_to(level == 0, filled.shape)] = 120
    out[filled] = (200, 30, 30)
    return out


def png(rows: list[list[Tile]]) -> bytes:
    """A PNG file of rows of tiles, each under its label. Without loss; the same bytes every time."""
    drawn = [[_labelled(*tile) for tile in row] for row in rows]
    width = max(sum(tile.width + GAP for tile in row) - GAP for row in drawn)
    height = sum(max(tile.height for tile in row) + GAP for row in drawn) - GAP
    sheet = Image.new("RGB", (width, height), "white")
    y = 0
    for row in drawn:
        x = 0
        for tile in row:
            sheet.paste(tile, (x, y))
            x += tile.width + GAP
        y += max(tile.height for tile in row) + GAP
    if len(sheet.getcolors(1 << 24)) <= 256:
        sheet = _indexed(sheet)
    file = io.BytesIO()
    sheet.save(file, format="PNG", compress_level=9)
    return file.getvalue()


def _labelled(label: str, pixels: np.ndarray) -> Image.Image:
    height, width = pixels.shape[:2]
    tile = Image.new("RGB", (width, height + LABEL), "white")
    draw = ImageDraw.Draw(tile)
    draw.fontmode = "1"  # no grey edges: few colours, and all in the index
    draw.text((1, 2), label, fill="black", font=ImageFont.load_default())
    tile.paste(Image.fromarray(np.ascontiguousarray(pixels)), (0, LABEL))
    return tile


def _indexed(sheet: Image.Image) -> Image.Image:
    colors, index = np.unique(np.asarray(sheet).reshape(-1, 3), axis=0, return_inverse=True)
    out = Image.fromarray(index.reshape(sheet.height, sheet.width).astype(np.uint8))
    out.putpalette(colors.astype(np.uint8).tobytes())
    return out
