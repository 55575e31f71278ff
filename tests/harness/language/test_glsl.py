"""Pasting of includes, macros, and the line map. Expected: the files as they are, and what SHADERed does with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from harness import GlslError, native, shader
from harness.language import glsl
from harness.native import Stage


@pytest.fixture
def write(tmp_path):
    """Writes files below a folder of its own: ``write(main="...", **{"lib/inner.glsl": "..."})``; gives the folder."""

    def write(**files: str | bytes):
        for name, text in files.items():
            path = tmp_path / (name if "." in name else f"{name}.glsl")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return tmp_path

    return write


def load(folder: Path, include_dirs=None, defines=None, **options) -> glsl.Source:
    """main.glsl of a folder."""
    return glsl.load(folder / "main.glsl", defines, include_dirs or [folder], version="#version 330", **options)


def body(source: glsl.Source) -> list[str]:
    """The lines below #version."""
    lines = source.text.split("\n")
    assert lines[0] == "#version 330"
    assert lines[-1] == ""
    return lines[1:-1]


# ---- Includes --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "line", ['#include "a.glsl"', "#include <a.glsl>", '#include\t"a.glsl"', '#include "a.glsl" // x']
)
def test_an_include_is_replaced_by_the_file(write, line):
    folder = write(main=f"before\n{line}\nafter\n", **{"a.glsl": "one\ntwo\n"})
    assert body(load(folder)) == ["before", "one", "two", "after"]


@pytest.mark.parametrize("line", [' #include "a.glsl"', '// #include "a.glsl"', '# include "a.glsl"'])
def test_only_a_line_that_begins_with_it_is_an_include(write, line):
    """As SHADERed, which looks for #include in the first column."""
    assert body(load(write(main=f"{line}\n", **{"a.glsl": "one\n"}))) == [line]


def test_the_first_folder_that_has_the_file_wins(write):
    folder = write(
        main='#include "a.glsl"\n#include "b.glsl"\n',
        **{"one/a.glsl": "from one\n", "two/a.glsl": "from two\n", "two/b.glsl": "only two\n"},
    )
    assert body(load(folder, [folder / "one", folder / "two"])) == ["from one", "only two"]
    assert body(load(folder, [folder / "two", folder / "one"])) == ["from two", "only two"]


def test_shader_looks_beside_the_file_last(write):
    folder = write(
        main='#include "a.glsl"\nfloat f() { return A; }\n',
        **{"a.glsl": "#define A 1.0\n", "lib/a.glsl": "#define A 2.0\n"},
    )
    assert shader(folder / "main.glsl").f() == 1
    assert shader(folder / "main.glsl", include_dirs=[folder / "lib"]).f() == 2


@pytest.fixture
def nested(write):
    """A file that includes lib/a.glsl, which includes its neighbour by its bare name."""
    inner = {"lib/a.glsl": '#include "b.glsl"\n', "lib/b.glsl": "float f() { return 2.0; }\n"}
    return write(main='#include "lib/a.glsl"\n', **inner)


def test_a_shader_of_shadered_is_not_looked_for_beside_the_including_file(nested):
    assert body(load(nested)) == ["#error no such file"]


def test_a_library_is_looked_for_beside_the_including_file(nested):
    assert shader(nested / "main.glsl").f() == 2


def test_the_folders_named_come_before_that_of_the_including_file(nested, write):
    write(**{"first/b.glsl": "float f() { return 1.0; }\n"})
    assert shader(nested / "main.glsl", include_dirs=[nested / "first"]).f() == 1


@pytest.mark.parametrize("line", ['  #include "a.glsl"', '# include "a.glsl"', '#include"a.glsl"'])
def test_a_library_may_indent_its_includes(write, line):
    folder = write(main=f"{line}\n", **{"a.glsl": "float f() { return 2.0; }\n"})
    assert shader(folder / "main.glsl").f() == 2


@pytest.mark.parametrize("line", ['#include ""', "#include <>", '  # include ""'])
def test_an_include_without_a_name_is_an_error(write, line):
    folder = write(main=f"float f() {{ return 1.0; }}\n{line}\n")
    with pytest.raises(GlslError, match="main.glsl:2: an include without a name"):
        shader(folder / "main.glsl")


def test_a_library_may_continue_its_lines_after_a_backslash(write):
    folder = write(main="#define TWICE(x) \\\n  ((x) + \\\n  (x))\nfloat f(float x) { return TWICE(x); }\n")
    f = shader(folder / "main.glsl").f
    assert f(3) == 6
    assert f.signatures[0].origin[1] == 4


def test_a_path_may_lead_through_folders(write):
    folder = write(main='#include "lib/../lib/a.glsl"\n', **{"lib/a.glsl": "one\n"})
    assert body(load(folder)) == ["one"]


def test_includes_nest(write):
    folder = write(main='#include "a.glsl"\n', **{"a.glsl": '1\n#include "b.glsl"\n3\n', "b.glsl": "2\n"})
    assert body(load(folder)) == ["1", "2", "3"]


def test_the_second_include_of_one_file_is_dropped(write):
    folder = write(main='#include "a.glsl"\n#include "a.glsl"\nend\n', **{"a.glsl": "one\n"})
    assert body(load(folder)) == ["one", "", "end"]


def test_a_file_that_two_others_include_comes_twice(write):
    """As SHADERed does it, so a guard is needed, and works."""
    folder = write(
        main='#include "a.glsl"\n#include "b.glsl"\n',
        **{"a.glsl": '#include "c.glsl"\n', "b.glsl": '#include "c.glsl"\n', "c.glsl": "one\n"},
    )
    assert body(load(folder)) == ["one", "one"]
    write(
        main='#include "a.glsl"\n#include "b.glsl"\nfloat f() { return c(); }\n',
        **{"c.glsl": "#ifndef C\n#define C\nfloat c() { return 3.0; }\n#endif\n"},
    )
    assert shader(folder / "main.glsl").f() == 3


@pytest.mark.parametrize("circle", [["main"], ["a", "main"], ["a", "b", "a"], ["a", "a"]])
def test_a_circle_of_includes_ends(write, circle):
    names = ["main", *circle]
    files = {name: f'{name}\n#include "{after}.glsl"\n' for name, after in zip(names, names[1:], strict=False)}
    assert [line for line in body(load(write(**files))) if line] == list(dict.fromkeys(names))


def test_an_empty_file_may_be_included(write):
    assert body(load(write(main='1\n#include "a.glsl"\n2\n', **{"a.glsl": ""}))) == ["1", "2"]


# ---- What is not there -----------------------------------------------------------------------------------------------


def test_a_missing_include_names_its_line_and_where_it_was_looked_for(write):
    folder = write(main='\n#include "gone.glsl"\n', **{"lib/other.glsl": ""})
    with pytest.raises(GlslError) as caught:
        shader(folder / "main.glsl", include_dirs=[folder / "lib"])
    error = caught.value
    assert (error.file, error.line) == (str(folder / "main.glsl"), 2)
    assert str(error).startswith(f'{folder}/main.glsl:2: cannot find the included file "gone.glsl"')
    assert f"{folder}/lib/" in error.message
    assert f"{folder}/)" in error.message


def test_a_missing_include_of_an_include_names_that_file(write):
    folder = write(main='// 1\n// 2\n#include "a.glsl"\n', **{"a.glsl": '// 1\n#include "gone.glsl"\n'})
    with pytest.raises(GlslError) as caught:
        shader(folder / "main.glsl", defines={"N": 1})
    assert (caught.value.file, caught.value.line) == (str(folder / "a.glsl"), 2)


@pytest.mark.parametrize("condition", ["#if 0", "#ifdef NOT_DEFINED", "#if 1 > 2 && defined(X)"])
def test_a_missing_include_that_is_not_compiled_is_harmless(write, condition):
    text = f'{condition}\n#include "gone.glsl"\n#endif\nfloat f() {{ return 1.0; }}\n'
    assert shader(write(main=text) / "main.glsl").f() == 1


def test_a_folder_is_no_file_to_include(write):
    folder = write(main='#include "lib"\n', **{"lib/a.glsl": ""})
    with pytest.raises(GlslError, match=r'main\.glsl:1: cannot find the included file "lib"'):
        shader(folder / "main.glsl")


def test_a_missing_include_is_not_found_by_the_compiler_either(write, monkeypatch):
    text = '#version 330\n#extension GL_GOOGLE_include_directive : enable\n#include "here.glsl"\n'
    folder = write(**{"lib/main.glsl": text, "here.glsl": "float f() { return 1.0; }\n"})
    monkeypatch.chdir(folder)
    with pytest.raises(GlslError, match="cannot find the included file"):
        shader(folder / "lib/main.glsl")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(GlslError) as caught:
        shader(tmp_path / "gone.glsl")
    assert str(caught.value) == f"{tmp_path}/gone.glsl: cannot read the shader: No such file or directory"


def test_a_folder_is_no_shader(tmp_path):
    with pytest.raises(GlslError, match="cannot read the shader: Is a directory"):
        shader(tmp_path)


# ---- Macros ----------------------------------------------------------------------------------------------------------


def test_macros_stand_after_the_version_in_their_order(write):
    folder = write(main="#version 410\nbody\n")
    source = load(folder, defines={"A": "1", "F(x)": "(x + A)", "EMPTY": ""})
    assert source.text == "#version 410\n#define A 1\n#define F(x) (x + A)\n#define EMPTY\nbody\n"


def test_macros_without_a_version_get_one_above_them(write):
    assert load(write(main="body\n"), defines={"A": "1"}).text == "#version 330\n#define A 1\nbody\n"


@pytest.mark.parametrize("version", ["#version 330", "#version 330 core", "#version 400", "  #version 330"])
def test_a_version_of_its_own_is_kept(write, version):
    assert load(write(main=f"{version}\nbody\n")).text.split("\n")[0] == version


def test_a_shader_without_a_version_is_refused_where_one_is_asked_for(write):
    with pytest.raises(GlslError, match=r"main\.glsl:1: a shader must begin with its #version"):
        glsl.load(write(main="// first\n#version 330\n") / "main.glsl")


def test_macros_reach_included_files(write):
    folder = write(main='#include "a.glsl"\n', **{"a.glsl": "float f() { return N; }\n"})
    assert shader(folder / "main.glsl", defines={"N": 2.5}).f() == 2.5


def test_macros_with_arguments_work(write):
    folder = write(main="float f(float x) { return TWICE(x + 1.0); }\n")
    assert shader(folder / "main.glsl", defines={"TWICE(x)": "(2.0 * (x))"}).f(2) == 6


# ---- The line map ----------------------------------------------------------------------------------------------------

TREE = {
    "main": "#version 330\n// main 2\n"
    + '#include "a.glsl"\n// main 4\n#include <b.glsl>\n\n// 7\n#include "a.glsl"\n',
    "a.glsl": '// a 1\n\n#include "lib/c.glsl"\n// a 4\n',
    "b.glsl": "// b 1, without an end of line",
    "lib/c.glsl": '// c 1\r\n// c 2\r\n#include "a.glsl"\r\n',
}


@pytest.mark.parametrize("defines", [{}, {"A": "1"}, {"A": "1", "B": "2", "C": "3"}])
def test_every_line_is_the_line_it_says_it_is(write, defines):
    source = load(write(**TREE), defines=defines)
    lines = source.text.split("\n")[:-1]
    assert len(source.origins) == len(lines)
    seen = set()
    for n, line in enumerate(lines, 1):
        file, number = source.origin(n)
        if file == "macros":
            assert line == [f"#define {name} {text}" for name, text in defines.items()][number - 1]
        else:
            seen.add(file)
            there = Path(file).read_bytes().decode().replace("\r\n", "\n").split("\n")[number - 1]
            assert line == there or (line == "" and there.startswith("#include"))
    assert {Path(file).name for file in seen} == {"main.glsl", "a.glsl", "b.glsl", "c.glsl"}


def test_preprocessing_keeps_every_line_in_its_place(write):
    """A name on each line, behind comments and conditions, is on that line still."""
    text = (
        "// one\nfloat a2;\n/* three\n four */ float a4;\n#if 0\nfloat no;\n#else\nfloat a8;\n#endif\n\n\nfloat a12;\n"
    )
    lines = native.glsl_preprocess(Stage.FRAGMENT, "#version 330\n" + text).split("\n")
    assert [n for n, line in enumerate(lines) if "float" in line] == [2, 4, 8, 12]
    assert all(f"a{n}" in lines[n] for n in (2, 4, 8, 12))


def test_lines_beyond_the_text_belong_to_its_last(write):
    source = load(write(main="one\ntwo\n"))
    assert source.origin(99)[1] == 2
    assert source.origin(0) == source.origin(1)


# ---- Bytes -----------------------------------------------------------------------------------------------------------

FUNCTION = "float f(float x)\n{\n    return 2.0 * x;\n}\n"


@pytest.mark.parametrize(
    "content",
    [
        FUNCTION.encode(),
        FUNCTION.replace("\n", "\r\n").encode(),
        b"\xef\xbb\xbf" + FUNCTION.encode(),
        b"\xef\xbb\xbf#version 330\n" + FUNCTION.encode(),
        FUNCTION.rstrip("\n").encode(),
        b"// \xff\xfe\x80 caf\xe9\n" + FUNCTION.encode(),
        "// ½ π 光 🎨\n".encode() + FUNCTION.encode(),
        b"\n\n\n" + FUNCTION.encode() + b"\n\n",
        FUNCTION.replace("    ", "\t").encode() + b"// the end",
    ],
    ids=["LF", "CRLF", "BOM", "BOM and version", "no last end", "not UTF-8", "UTF-8", "empty lines", "tabs"],
)
def test_however_a_file_is_written_it_is_the_same_function(write, content):
    np.testing.assert_array_equal(shader(write(main=content) / "main.glsl").f([1, 2]), [2, 4])


def test_an_included_file_with_a_byte_order_mark(write):
    folder = write(main='#include "a.glsl"\n', **{"a.glsl": b"\xef\xbb\xbf" + FUNCTION.encode()})
    assert shader(folder / "main.glsl").f(2) == 4


def test_an_include_behind_a_carriage_return(write):
    folder = write(main='#include "a.glsl"\r\nfloat g() { return f(1.0); }\r\n', **{"a.glsl": FUNCTION})
    assert shader(folder / "main.glsl").g() == 2


def test_a_path_is_shown_from_the_current_folder(write, monkeypatch):
    folder = write(**{"lib/main.glsl": FUNCTION})
    monkeypatch.chdir(folder)
    assert glsl.load(folder / "lib/main.glsl", version="#version 330").path == "lib/main.glsl"
    monkeypatch.chdir(folder / "lib")
    assert glsl.load(folder / "lib/main.glsl", version="#version 330").path == "main.glsl"


def test_a_path_that_is_not_below_the_current_folder_is_shown_as_given(write, tmp_path_factory, monkeypatch):
    folder = write(main=FUNCTION)
    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    assert load(folder).path == str(folder / "main.glsl")


# ---- Logs ------------------------------------------------------------------------------------------------------------

SOURCE = glsl.Source("main.frag", "first\nsecond\nthird\n", (("main.frag", 1), ("inner.glsl", 7), ("main.frag", 3)))


@pytest.mark.parametrize("log", ["ERROR: 0:2: 'x' : undeclared", "0:2(5): error: 'x' : undeclared"])
def test_a_log_is_told_in_the_users_files(log):
    """glslang's form and Mesa's."""
    assert str(SOURCE.error(log)) == "inner.glsl:7: 'x' : undeclared\n    second"


def test_a_drivers_warnings_are_no_errors():
    log = "0:1(1): warning: unused\n0:3(1): error: wrong"
    assert str(SOURCE.error(log)) == "main.frag:3: wrong\n    third"


def test_a_linkers_message_has_no_line():
    assert str(SOURCE.error("0:0(0): error: function f is recursive")).startswith("main.frag: ")


def test_many_errors_are_counted():
    log = "\n".join(f"0:{n % 3 + 1}(1): error: wrong {n}" for n in range(9))
    assert str(SOURCE.error(log)).endswith("... and 4 more")
