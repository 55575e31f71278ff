"""What is told of the machine and the libraries."""

from __future__ import annotations

import argparse
import re
import subprocess
from importlib.metadata import version
from pathlib import Path

import pytest

from harness.commands import info as command
from harness.info import info


def test_the_versions_are_those_of_the_packages():
    known = info()
    assert re.fullmatch(r"\d+\.\d+\.\d+", known["glslang"])
    assert known["numpy"] == version("numpy") and known["shader-harness"] == version("shader-harness")
    assert known["OpenGL"].startswith(("3.", "4."))


@pytest.mark.skipif(not Path("/var/lib/dpkg").is_dir(), reason="asks Debian for the versions of its packages")
def test_mesa_and_glslang_are_those_that_debian_installed():
    asked = ["dpkg-query", "-W", "-f", "${Package}=${Version}\n", "libosmesa6", "glslang-dev"]
    told = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    versions = dict(line.split("=") for line in told.splitlines())
    assert versions["libosmesa6"].startswith(info()["Mesa"])
    assert versions["glslang-dev"].startswith(info()["glslang"])


def test_the_processor_has_a_name():
    names = re.findall(r"^model name\s*: (.+)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    assert info()["CPU"] in names or not names


def test_the_command_prints_a_line_for_each(capsys):
    command.run(argparse.Namespace())
    lines = capsys.readouterr().out.splitlines()
    assert [re.split(r"  +", line)[0] for line in lines] == list(info())
    assert lines[0].endswith(version("shader-harness"))
