"""Objects and their binds, as the reader gives them."""

from __future__ import annotations

import pytest
from sprj_files import line_of, read, refusal, shader_pass, warned, write_project

from harness.projects.project import Buffer, CubeMap, Image, KeyboardTexture, RenderTexture, TextureObject
from harness.rendering import states

BIND = '<bind slot="0" name="Quad" />'


def project_with(folder, *objects: str):
    return write_project(folder, shader_pass(), objects="\n".join(objects))


def one(kind: str, attributes: str, binds: str = BIND) -> str:
    return f'<object type="{kind}" {attributes}>{binds}</object>'


def object_of(project):
    (found,) = project.objects
    return found


def test_texture_defaults(tmp_path):
    objects = '<object type="texture" path="t.png"><bind slot="3" name="Quad" /></object>'
    (texture,) = read(write_project(tmp_path, shader_pass(), objects=objects)).textures
    assert (texture.vflip, texture.min_filter, texture.mag_filter, texture.wrap_s, texture.wrap_t) == (
        False,
        "Linear",
        "Nearest",
        "Repeat",
        "Repeat",
    )


def test_a_texture(tmp_path):
    attributes = r"""path="maps\t.png" vflip="true" min_filter="Linear_MipmapLinear" mag_filter="Linear"
wrap_s="ClampToEdge" wrap_t="MirroredRepeat" """
    texture = object_of(read(project_with(tmp_path, one("texture", attributes))))
    assert isinstance(texture, TextureObject) and texture.path == texture.name == "maps/t.png"
    assert (texture.vflip, texture.min_filter, texture.mag_filter) == (True, "Linear_MipmapLinear", "Linear")
    assert (texture.wrap_s, texture.wrap_t, texture.volume) == ("ClampToEdge", "MirroredRepeat", False)


@pytest.mark.parametrize(
    "attribute, default",
    [("min_filter", "Linear"), ("mag_filter", "Nearest"), ("wrap_s", "Repeat"), ("wrap_t", "Repeat")],
)
def test_filters_and_wraps_that_do_not_exist(tmp_path, attribute, default):
    project, warning = warned(project_with(tmp_path, one("texture", f'path="t.png" {attribute}="Cubic"')))
    assert getattr(object_of(project), attribute) == default
    assert warning.message.startswith(f'{attribute} is "Cubic", of which SHADERed makes {default}; there are ')


def test_wrap_r_of_a_volume_is_its_wrap_t(tmp_path):
    attributes = 'path="t.dds" is_3d="true" wrap_t="Repeat" wrap_r="ClampToEdge"'
    project, warning = warned(project_with(tmp_path, one("texture", attributes)))
    texture = object_of(project)
    assert texture.volume and texture.wrap_t == "ClampToEdge" and "wrap_r" in warning.message


def test_faces_of_a_cube_map(tmp_path):
    attributes = 'name="sky" cube="true" left="l" right="r" top="t" bottom="b" front="f" back="k"'
    cube = object_of(read(project_with(tmp_path, one("texture", attributes))))
    # +x -x +y -y +z -z
    assert isinstance(cube, CubeMap) and (cube.name, cube.faces) == ("sky", ("r", "l", "t", "b", "k", "f"))


def test_a_cube_map_needs_all_faces(tmp_path):
    error = refusal(project_with(tmp_path, one("texture", 'name="sky" cube="true" left="l"')))
    assert 'right of the cube map "sky" names no file' in error.message


def test_a_keyboard_texture(tmp_path):
    found = object_of(read(project_with(tmp_path, one("texture", 'name="keys" keyboard_texture="true"'))))
    assert isinstance(found, KeyboardTexture) and found.name == "keys"


# ---- Render textures -------------------------------------------------------------------------------------------------


def test_a_render_texture(tmp_path):
    attributes = 'name="rt" rsize="0.5,0.25" format="R16_FLOAT" clear="false" r="1" g="0.5" b="2" a="-1"'
    found = object_of(read(project_with(tmp_path, one("rendertexture", attributes))))
    assert isinstance(found, RenderTexture)
    assert (found.ratio, found.size, found.format, found.clear) == ((0.5, 0.25), None, "R16_FLOAT", False)
    assert found.color == (1, 0.5, 2, -1) and found.pixels((10, 9)) == (5, 2)


def test_a_fixed_size_holds_whatever_the_ratio(tmp_path):
    found = object_of(read(project_with(tmp_path, one("rendertexture", 'name="rt" fsize="30,20" rsize="1,1"'))))
    assert found.pixels((10, 9)) == (30, 20)
    assert (found.format, found.clear, found.color) == ("RGBA", True, (0, 0, 0, 0))


def test_one_ratio_for_both_sides(tmp_path):
    assert object_of(read(project_with(tmp_path, one("rendertexture", 'name="rt" rsize="2"')))).ratio == (2, 2)


def test_a_ratio_is_cut_off_in_single_precision(tmp_path):
    # 0.7f is 0.699999988, and 0.7f * 10 rounds to 7 in single precision; 0.1 of 9 is 0.9.
    found = object_of(read(project_with(tmp_path, one("rendertexture", 'name="rt" rsize="0.7,0.1"'))))
    assert found.pixels((10, 9)) == (7, 0)


@pytest.mark.parametrize(
    "attributes, words",
    [
        ('name="rt"', "has neither rsize nor fsize: SHADERed crashes"),
        ('name="rt" rsize="half"', "not a number: SHADERed crashes"),
        ('name="rt" fsize="10,"', "not a number: SHADERed crashes"),
        ('name="rt" fsize="0,10"', "is 0 x 10 pixels"),
        ('name="rt" fsize="100000,10"', "is 100000 x 10 pixels"),
        ('rsize="1,1"', "has no name: SHADERed crashes"),
        ('name="rt" rsize="1,1" format="R32_UINT"', "R32_UINT is not supported: SHADERed itself cannot make it"),
    ],
)
def test_render_textures_that_cannot_be(tmp_path, attributes, words):
    path = project_with(tmp_path, one("rendertexture", attributes))
    error = refusal(path)
    assert words in error.message and error.line == line_of(path, "<object ")


def test_a_format_that_there_is_not(tmp_path):
    project, warning = warned(project_with(tmp_path, one("rendertexture", 'name="rt" rsize="1,1" format="RGB565"')))
    assert object_of(project).format == "RGBA" and '"RGB565", of which SHADERed makes RGBA' in warning.message


def test_a_render_texture_that_passes_draw_to_needs_no_bind(tmp_path):
    path = write_project(
        tmp_path,
        shader_pass(extra='<rendertexture name="rt" /><rendertexture />'),
        objects=one("rendertexture", 'name="rt" rsize="1,1"', "") + one("rendertexture", 'name="other"', ""),
    )
    project = read(path)
    assert [o.name for o in project.objects] == ["rt"] and project.passes[0].targets == ("rt", None)


def test_a_render_texture_that_does_not_exist(tmp_path):
    error = refusal(write_project(tmp_path, shader_pass(extra='<rendertexture name="rt" />')))
    assert error.message == 'pass "Quad" draws to the render texture "rt", which is not among the objects'


# ---- Images and buffers ----------------------------------------------------------------------------------------------


def test_images(tmp_path):
    path = project_with(
        tmp_path,
        one("image", 'name="a" width="4" height="3"'),
        one("image3d", 'name="b" width="4" height="3" depth="2" format="R8"', '<bind slot="1" name="Quad" />'),
    )
    a, b = read(path).objects
    assert isinstance(a, Image) and (a.size, a.format) == ((4, 3), "R32G32B32A32_FLOAT")
    assert (b.size, b.format) == ((4, 3, 2), "R8")


@pytest.mark.parametrize("attributes", ['name="a" width="0"', 'name="a" height="99999"'])
def test_images_of_impossible_sizes(tmp_path, attributes):
    assert "pixels, not 1 to 16384 a side" in refusal(project_with(tmp_path, one("image", attributes))).message


def test_a_buffer(tmp_path):
    found = object_of(read(project_with(tmp_path, one("buffer", 'name="b" size="36" format="vec3;vec4;"'))))
    assert isinstance(found, Buffer)
    assert (found.size, found.format, found.path) == (36, "vec3;vec4;", "buffers/b.buf")


@pytest.mark.parametrize(
    "attributes, words",
    [
        ('name="b" size="-1"', "has -1 bytes"),
        ('name="b" size="999999999"', "has 999999999 bytes"),
        ('name="../b" size="4"', "its name cannot be that of a file"),
        (f'name="b" format="{"f" * 256}"', "more than SHADERed can hold"),
    ],
)
def test_buffers_that_cannot_be(tmp_path, attributes, words):
    assert words in refusal(project_with(tmp_path, one("buffer", attributes))).message


def test_a_type_in_a_buffer_that_there_is_not(tmp_path):
    _, warning = warned(project_with(tmp_path, one("buffer", 'name="b" size="4" format="vec5"')))
    assert '"vec5", of which SHADERed makes float' in warning.message


@pytest.mark.parametrize("kind", ["audio", "pluginobject"])
def test_other_objects_are_not_supported(tmp_path, kind):
    path = project_with(tmp_path, one(kind, 'name="o" path="o"'))
    error = refusal(path)
    assert error.message == f'<object type="{kind}"> "o" is not supported' and error.line == line_of(path, "<object ")


def test_objects_of_no_type_are_left_out(tmp_path):
    project, warning = warned(project_with(tmp_path, one("video", 'name="o"')))
    assert project.objects == () and 'no objects of type "video"' in warning.message


# ---- Binds -----------------------------------------------------------------------------------------------------------


def names_bound(project, **how):
    return [o.name for o in project.bound("Quad", **how)]


def textures(*binds: tuple[str, int]) -> str:
    return "\n".join(one("texture", f'path="{p}"', f'<bind slot="{s}" name="Quad" />') for p, s in binds)


def test_objects_are_bound_by_slot(tmp_path):
    assert names_bound(read(project_with(tmp_path, textures(("c", 7), ("a", 0), ("b", 2))))) == ["a", "b", "c"]


def test_of_two_objects_in_one_slot_the_last_holds(tmp_path):
    path = project_with(tmp_path, textures(("a", 0), ("b", 0), ("c", 1)))
    project, warning = warned(path)
    assert names_bound(project) == ["b", "c"]
    assert warning.message == 'slot 0 of pass "Quad" has "a", which SHADERed then leaves out'
    assert warning.line == line_of(path, 'path="b"')


def test_an_object_in_two_slots_is_in_the_first(tmp_path):
    binds = '<bind slot="2" name="Quad" /><bind slot="0" name="Quad" />'
    path = project_with(tmp_path, one("texture", 'path="a"', binds), textures(("b", 1)))
    project, warning = warned(path)
    assert names_bound(project) == ["a", "b"] and 'is bound to pass "Quad" twice' in warning.message


def test_a_second_object_of_a_file_adds_to_the_first(tmp_path):
    """Its flip turns the first one's round, and its filters replace them; the rest of the first stays."""
    second_bind = '<bind slot="1" name="Other" />'
    path = write_project(
        tmp_path,
        shader_pass() + shader_pass("Other"),
        objects=one("texture", 'path="t" vflip="true" min_filter="Nearest" wrap_s="ClampToEdge"')
        + one("texture", 'path="t" vflip="true" mag_filter="Linear"', second_bind),
    )
    project, warning = warned(path)
    texture = object_of(project)
    assert (texture.vflip, texture.min_filter, texture.mag_filter) == (False, "Nearest", "Linear")
    assert texture.wrap_s == "ClampToEdge" and project.bound("Other") == [texture]
    assert '"t" has an object already' in warning.message


def test_binds_of_images(tmp_path):
    """To a shader pass as a texture, to a compute pass as an image; uav says otherwise."""
    compute = '<pass name="Fill" type="compute"><shader type="cs" path="c.comp" entry="main" /></pass>'
    binds = '<bind slot="0" name="Quad" /><bind slot="0" name="Fill" />'
    path = write_project(
        tmp_path,
        compute + shader_pass(),
        objects=one("image", 'name="a"', binds)
        + one("image", 'name="b"', binds.replace("/>", 'uav="0" />').replace('"0" name', '"1" name'))
        + one("buffer", 'name="c" size="4"', '<bind slot="5" name="Fill" />'),
    )
    project = read(path)
    bound = {
        (p, storage): [o.name for o in project.bound(p, storage=storage)]
        for p in ("Quad", "Fill")
        for storage in (False, True)
    }
    assert bound["Quad", False] == ["a", "b"] and bound["Quad", True] == []
    assert bound["Fill", False] == ["b"] and bound["Fill", True] == ["a", "c"]


def test_a_bind_to_no_pass(tmp_path):
    path = project_with(tmp_path, one("texture", 'path="t"', '<bind slot="0" name="quad" />'))
    project, warning = warned(path)
    assert project.objects == () and warning.message == '"t" is bound to pass "quad", which there is not'


@pytest.mark.parametrize("slot", ["-1", "5000"])
def test_slots_that_are_none(tmp_path, slot):
    error = refusal(project_with(tmp_path, one("texture", 'path="t"', f'<bind slot="{slot}" name="Quad" />')))
    assert error.message == f"the slot is {slot}; slots are 0 to 1023"


def test_a_slot_that_is_no_number_is_0(tmp_path):
    project, warning = warned(project_with(tmp_path, one("texture", 'path="t"', '<bind slot="x" name="Quad" />')))
    assert project.textures[0].binds[0].slot == 0 and 'the slot is "x"' in warning.message


def test_objects_that_no_drawn_pass_binds_are_left_out(tmp_path):
    objects = """<object type="texture" path="t.png"></object>
<object type="audio" path="s.ogg" /><object type="rendertexture" name="rt" rsize="1,1" />"""
    assert read(write_project(tmp_path, shader_pass(), objects=objects)).textures == ()


def test_all_formats_have_names(tmp_path):
    assert set(states.FORMATS) & set(states.INTEGER_FORMATS) == set()
    assert len(states.FORMATS) + len(states.INTEGER_FORMATS) == 66
