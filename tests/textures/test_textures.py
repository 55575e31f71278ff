"""The texture maps: what a shader relies on in the committed pictures, and that the script makes these."""

import importlib
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

TEXTURES = Path(__file__).resolve().parents[2] / "textures"
sys.path.insert(0, str(TEXTURES))

glazed_tiles = importlib.import_module("glazed_tiles")
make_textures = importlib.import_module("make_textures")
material_maps = importlib.import_module("material_maps")
painted_metal = importlib.import_module("painted_metal")
periodic_noise = importlib.import_module("periodic_noise")

MODES = {
    "GlazedTiles_1K-PNG_Color.png": "RGB",
    "GlazedTiles_1K-PNG_NormalDX.png": "RGB",
    "GlazedTiles_1K-PNG_NormalGL.png": "RGB",
    "GlazedTiles_1K-PNG_Roughness.png": "L",
    "PaintedMetal_1K-PNG_Color.png": "RGB",
    "PaintedMetal_1K-PNG_Metalness.png": "L",
    "PaintedMetal_1K-PNG_NormalDX.png": "RGB",
    "PaintedMetal_1K-PNG_NormalGL.png": "RGB",
    "PaintedMetal_1K-PNG_Roughness.png": "L",
}
MATERIALS = ("GlazedTiles", "PaintedMetal")
TOTAL_BYTES = 12_000_000

# A component is rounded to a multiple of 1/127, so it is off by half of that at most, and a vector's length
# by no more than the length of the error, sqrt(3) times as much.
COMPONENT_ERROR = 0.5 / 127
LENGTH_ERROR = np.sqrt(3) * COMPONENT_ERROR
ROUNDING = 1e-12  # of float64 arithmetic on numbers about 1


def texels(name):
    with Image.open(TEXTURES / name) as image:
        return np.asarray(image)


def material_texels(material, map_name):
    return texels(f"{material}_1K-PNG_{map_name}.png")


def decoded_normals(material):
    return (material_texels(material, "NormalGL").astype(np.float64) - 128) / 127


def linear(srgb_bytes):
    """The sRGB transfer function of IEC 61966-2-1, written down once more."""
    encoded = srgb_bytes / 255.0
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def border_step(picture, axis):
    """Mean step across the border over the largest mean step between two lines inside the picture."""
    picture = picture.astype(np.float64).reshape(*picture.shape[:2], -1)
    steps = np.abs(np.roll(picture, -1, axis) - picture).mean(axis=(1 - axis, 2))
    return steps[-1] / steps[:-1].max()


@pytest.fixture(scope="session")
def made():
    """Each material made anew, before its encoding."""
    return {"GlazedTiles": glazed_tiles.make(), "PaintedMetal": painted_metal.make()}


# The files


def test_maps_have_ambientcg_names():
    assert {path.name for path in TEXTURES.glob("*.png")} == set(MODES)


@pytest.mark.parametrize("name", MODES)
def test_maps_are_1024_square(name):
    with Image.open(TEXTURES / name) as image:
        assert image.size == (1024, 1024)


@pytest.mark.parametrize("name", MODES)
def test_maps_are_rgb_or_gray(name):
    with Image.open(TEXTURES / name) as image:
        assert image.mode == MODES[name]


@pytest.mark.parametrize("name", MODES)
def test_maps_carry_no_metadata(name):
    with Image.open(TEXTURES / name) as image:
        image.load()  # text may also stand behind the pixels
        assert image.info == {}


def test_maps_are_small_together():
    assert sum((TEXTURES / name).stat().st_size for name in MODES) < TOTAL_BYTES


@pytest.mark.parametrize("material", MATERIALS)
def test_script_makes_the_committed_pixels(material, made):
    for map_name, pixels in material_maps.encode(made[material]).items():
        path = TEXTURES / f"{material}_1K-PNG_{map_name}.png"
        assert make_textures.difference(path, pixels) is None
        if path.read_bytes() != make_textures.png_bytes(pixels):
            warnings.warn(f"{path.name}: same pixels, other bytes: another zlib or Pillow wrote it", stacklevel=1)


# Tiling


@pytest.mark.parametrize("axis", (0, 1))
@pytest.mark.parametrize("name", MODES)
def test_step_across_the_border_is_as_inside(name, axis):
    assert border_step(texels(name), axis) <= 1.0


@pytest.mark.parametrize("axis", (0, 1))
@pytest.mark.parametrize("name", MODES)
def test_step_across_the_border_shows_a_picture_that_does_not_tile(name, axis):
    """The measure above is sharp enough: a few lines cut off make any of these maps fail it clearly."""
    cropped = np.delete(texels(name), np.s_[:24], axis)
    assert border_step(cropped, axis) > 1.5


# Normal maps


@pytest.mark.parametrize("material", MATERIALS)
def test_normals_are_of_unit_length(material):
    length = np.sqrt((decoded_normals(material) ** 2).sum(axis=-1))
    assert np.abs(length - 1).max() <= LENGTH_ERROR


@pytest.mark.parametrize("material", MATERIALS)
def test_normals_point_out_of_the_surface(material):
    assert decoded_normals(material)[..., 2].min() > 0


@pytest.mark.parametrize("material", MATERIALS)
def test_dx_map_is_the_gl_map_with_green_mirrored(material):
    gl = material_texels(material, "NormalGL").astype(int)
    dx = material_texels(material, "NormalDX").astype(int)
    np.testing.assert_array_equal(dx[..., 1], 256 - gl[..., 1])
    np.testing.assert_array_equal(dx[..., ::2], gl[..., ::2])


def test_flat_is_one_exact_texel():
    pixels = material_maps.normal_bytes(material_maps.normals(np.zeros((4, 4))))
    assert (pixels == (128, 128, 255)).all()


@pytest.mark.parametrize("material", MATERIALS)
def test_normals_are_those_of_the_height_field(material, made):
    """Against numpy's own gradient of the height field, continued by one texel round the border."""
    down, right = np.gradient(np.pad(made[material].height, 1, mode="wrap"))
    expected = np.stack([-right, down, np.ones_like(right)], axis=-1)[1:-1, 1:-1]
    expected /= np.linalg.norm(expected, axis=-1, keepdims=True)
    assert np.abs(decoded_normals(material) - expected).max() <= COMPONENT_ERROR + ROUNDING


def dome_pixels():
    rows, columns = np.mgrid[0:64, 0:64] - 31.5
    height = np.maximum(0.0, 20.0 - (rows * rows + columns * columns) / 40.0)
    return material_maps.encode(material_maps.MaterialMaps(np.zeros((64, 64, 3)), height, None, height))


@pytest.mark.parametrize(("map_name", "lit_from_above"), (("NormalGL", 1), ("NormalDX", -1)))
def test_upper_side_of_a_dome_faces_up_in_green(map_name, lit_from_above):
    green = dome_pixels()[map_name][..., 1].astype(int) - 128
    assert (green[12:28, 32] * lit_from_above > 0).all()
    assert (green[36:52, 32] * lit_from_above < 0).all()


def test_right_side_of_a_dome_faces_right_in_red():
    red = dome_pixels()["NormalGL"][..., 0].astype(int) - 128
    assert (red[32, 36:52] > 0).all()
    assert (red[32, 12:28] < 0).all()


@pytest.mark.parametrize("material", MATERIALS)
def test_relief_is_real_but_modest(material):
    tilt = np.degrees(np.arccos(np.minimum(decoded_normals(material)[..., 2], 1)))
    assert 2 < tilt.mean() < 15


# Values


def test_metalness_is_nearly_always_0_or_1():
    metalness = material_texels("PaintedMetal", "Metalness")
    between = (metalness > 0.05 * 255) & (metalness < 0.95 * 255)
    assert between.mean() < 0.05


def test_metalness_holds_both_kinds():
    metalness = material_texels("PaintedMetal", "Metalness")
    assert (metalness == 255).mean() > 0.1
    assert (metalness == 0).mean() > 0.5


def test_bare_metal_reflects_like_a_metal():
    """Iron reflects about 0.56, silver, the brightest metal, 0.97."""
    metal = material_texels("PaintedMetal", "Metalness") == 255
    reflectance = linear(material_texels("PaintedMetal", "Color")[metal])
    assert reflectance.min() > 0.53
    assert reflectance.max() < 0.97


def test_painted_metals_dielectrics_have_plausible_albedo():
    """From charcoal to fresh snow: 30 to 240 in sRGB is the range customary in physically based shading."""
    dielectric = material_texels("PaintedMetal", "Metalness") == 0
    color = material_texels("PaintedMetal", "Color")[dielectric]
    assert color.min() >= 30
    assert color.max() <= 240


def test_tiles_have_plausible_albedo():
    color = material_texels("GlazedTiles", "Color")
    assert color.min() >= 30
    assert color.max() <= 240


def test_glaze_is_glossy_and_grout_rough(made):
    """Grout lies low, tiles stand high: the height of the material tells them apart."""
    roughness = material_texels("GlazedTiles", "Roughness") / 255.0
    height = made["GlazedTiles"].height
    assert np.median(roughness[height > 8]) < 0.25
    assert np.median(roughness[height < 0]) > 0.75


# The parts that they are made of


def test_srgb_encoding_undoes_decoding():
    every_byte = np.arange(256)
    np.testing.assert_array_equal(material_maps.srgb_bytes(linear(every_byte)), every_byte)


def test_srgb_encoding_rounds_to_nearest():
    values = np.linspace(0.0, 1.0, 100_001)
    encoded = np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055) * 255
    # The two pieces of the standard's curve meet only to about 1e-4 of a byte, hence a little more than one
    # half.
    assert np.abs(material_maps.srgb_bytes(values) - encoded).max() <= 0.5 + 1e-3


@pytest.mark.parametrize("shift", ((1, 0), (0, 1)))
def test_noise_has_the_period_of_the_picture(shift):
    x, y = periodic_noise.texel_grid(64)
    here = periodic_noise.fbm(np.random.default_rng(1), x, y, (3, 5), 3)
    there = periodic_noise.fbm(np.random.default_rng(1), x + shift[0], y + shift[1], (3, 5), 3)
    np.testing.assert_allclose(there, here, atol=ROUNDING)


@pytest.mark.parametrize("shift", ((1, 0), (0, 1)))
def test_cells_have_the_period_of_the_picture(shift):
    x, y = periodic_noise.texel_grid(64)
    here = periodic_noise.cellular(np.random.default_rng(1), x, y, 5)
    there = periodic_noise.cellular(np.random.default_rng(1), x + shift[0], y + shift[1], 5)
    np.testing.assert_allclose(there.nearest, here.nearest, atol=ROUNDING)


def test_distance_is_that_to_the_nearest_texel_on_the_torus():
    """Against the definition: the least over all texels of the mask."""
    mask = np.random.default_rng(2).random((32, 32)) < 0.01
    assert mask.any()
    apart = np.abs(np.arange(32)[:, None] - np.arange(32))
    apart = np.minimum(apart, 32 - apart) ** 2
    to_mask = [apart[:, row, None] + apart[None, :, column] for row, column in np.argwhere(mask)]
    expected = np.minimum(np.sqrt(np.min(to_mask, axis=0)), 9)
    np.testing.assert_array_equal(periodic_noise.distance_to(mask, 9), expected)


# The command, with a toy material in place of the real ones


@pytest.fixture
def toy(monkeypatch, tmp_path):
    """A folder in which the command has made one small material."""
    height = np.arange(64.0).reshape(8, 8) / 64
    maps = material_maps.MaterialMaps(np.full((8, 8, 3), 0.5), height, height, height)
    monkeypatch.setattr(make_textures, "MATERIALS", {"Toy": lambda: maps})
    assert make_textures.main(["--folder", str(tmp_path)]) == 0
    return tmp_path


def test_command_writes_whole_maps_only(toy):
    names = ("Color", "Roughness", "Metalness", "NormalGL", "NormalDX")
    assert {path.name for path in toy.iterdir()} == {f"Toy_1K-PNG_{name}.png" for name in names}


def test_command_writes_the_same_bytes_again(toy):
    before = {path.name: path.read_bytes() for path in toy.iterdir()}
    assert make_textures.main(["--folder", str(toy)]) == 0
    assert {path.name: path.read_bytes() for path in toy.iterdir()} == before


def test_check_accepts_what_was_made(toy, capsys):
    assert make_textures.main(["--check", "--folder", str(toy)]) == 0
    assert capsys.readouterr().out.count("same bytes") == 5


def test_check_accepts_other_bytes_for_the_same_pixels(toy, capsys):
    path = toy / "Toy_1K-PNG_Color.png"
    with Image.open(path) as image:
        image.load()
    image.save(path, compress_level=0)
    assert make_textures.main(["--check", "--folder", str(toy)]) == 0
    assert "Toy_1K-PNG_Color.png: same pixels, other bytes" in capsys.readouterr().out


def one_texel_changed(path):
    with Image.open(path) as image:
        image.load()
    image.putpixel((3, 5), 77)
    image.save(path)


def cut_short(path):
    path.write_bytes(path.read_bytes()[:60])


def made_rgb(path):
    with Image.open(path) as image:
        rgb = image.convert("RGB")
    rgb.save(path)


@pytest.mark.parametrize("damage", (one_texel_changed, cut_short, made_rgb, Path.unlink))
def test_check_names_the_map_that_differs(toy, capsys, damage):
    damage(toy / "Toy_1K-PNG_Roughness.png")
    capsys.readouterr()
    assert make_textures.main(["--check", "--folder", str(toy)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "Toy_1K-PNG_Roughness.png" in line
    assert "run make_textures.py" in line


def test_unwritable_folder_is_one_clear_line(toy, capsys):
    file = toy / "Toy_1K-PNG_Color.png"
    capsys.readouterr()
    assert make_textures.main(["--folder", str(file)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert file.name in line
