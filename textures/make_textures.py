#!/usr/bin/env python3
"""Make the texture maps of this folder, or check that they are what this script makes."""

import argparse
import io
import os
import sys
from pathlib import Path

import glazed_tiles
import numpy as np
import painted_metal
from material_maps import encode
from PIL import Image

MATERIALS = {"PaintedMetal": painted_metal.make, "GlazedTiles": glazed_tiles.make}
FOLDER = Path(__file__).resolve().parent

DESCRIPTION = """\
Makes two tiling materials of 1024 x 1024 texels, named as ambientCG names its own:

  PaintedMetal   petrol-coloured paint chipped off brushed steel, with rust
  GlazedTiles    a hand-laid hexagonal mosaic of glossy tiles in rough grout

  NAME_1K-PNG_Color.png      base colour, sRGB
  NAME_1K-PNG_Roughness.png  perceptual roughness, gray, linear
  NAME_1K-PNG_Metalness.png  gray, linear; only where there is metal
  NAME_1K-PNG_NormalGL.png   tangent-space normal, (byte - 128) / 127, green up
  NAME_1K-PNG_NormalDX.png   the same with green down
"""

EPILOG = """\
examples:
  python make_textures.py                  make all maps anew, where this script lies
  python make_textures.py --check          compare the maps that are there; write nothing
  python make_textures.py --folder DIR     make them elsewhere

The seeds are fixed, so every run makes the same pixels. The same bytes come from the same version of zlib
only, therefore --check fails for other pixels, and merely mentions other bytes.

exit status: 0 done, 1 a map differs, is missing or cannot be written, 2 wrong usage
"""


def png_bytes(pixels):
    """A PNG file of gray (rows, columns) or RGB (rows, columns, 3) uint8 pixels, without metadata."""
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, format="PNG", compress_level=6)
    return file.getvalue()


def write_whole(path, data):
    """Write a file so that a reader finds the old one or the new one, never a part of it."""
    partial = path.with_name(path.name + ".partial")
    partial.write_bytes(data)
    os.replace(partial, path)


def difference(path, pixels):
    """What is wrong with the map at `path`, in words, or None if it holds exactly these pixels."""
    if not path.exists():
        return "is missing"
    try:
        with Image.open(path) as image:
            found = np.asarray(image)
    except (OSError, SyntaxError) as error:  # Pillow raises SyntaxError for broken PNG chunks
        return f"cannot be read: {error}"
    if found.dtype != pixels.dtype or found.shape != pixels.shape:
        return f"has shape {found.shape} of {found.dtype}, not {pixels.shape} of {pixels.dtype}"
    differing = np.count_nonzero((found != pixels).reshape(*pixels.shape[:2], -1).any(axis=-1))
    return f"differs in {differing} texels" if differing else None


def make_maps():
    """Make every material; yields (file name, uint8 pixels)."""
    for material, make in MATERIALS.items():
        for map_name, pixels in encode(make()).items():
            yield f"{material}_1K-PNG_{map_name}.png", pixels


def check(folder):
    """Compare the folder's maps with what this script makes; returns the exit status."""
    wrong = 0
    for name, pixels in make_maps():
        path = folder / name
        problem = difference(path, pixels)
        if problem:
            print(f"{path}: {problem}; run make_textures.py to make it anew", file=sys.stderr)
            wrong += 1
        elif path.read_bytes() == png_bytes(pixels):
            print(f"{name}: same bytes")
        else:
            print(f"{name}: same pixels, other bytes (another version of zlib or Pillow wrote it)")
    return 1 if wrong else 0


def write(folder):
    """Make the maps into the folder, which is made if need be; returns the exit status."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, pixels in make_maps():
        data = png_bytes(pixels)
        write_whole(folder / name, data)
        print(f"{name}: {len(data) / 1e6:.2f} MB")
    return 0


def main(arguments=None):
    parser = argparse.ArgumentParser(
        description=DESCRIPTION, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--check", action="store_true", help="compare instead of writing; name each map that differs")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="where the maps are (default: beside this script)")
    options = parser.parse_args(arguments)
    try:
        return check(options.folder) if options.check else write(options.folder)
    except OSError as error:
        print(f"make_textures.py: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
