"""What computes the numbers: the versions of the driver, the compiler and the libraries, and the processor."""

from __future__ import annotations

import platform
import re
from importlib.metadata import version
from pathlib import Path

from . import native


def info() -> dict[str, str]:
    """Name -> value, in an order to be shown. Opens the GL context."""
    native.open_context()
    context = native.context_info()
    mesa = re.search(r"Mesa (\S+)", context["version"])
    known = versions()
    return {
        "shader-harness": known.pop("shader-harness"),
        "driver": context["renderer"],
        "OpenGL": context["version"].partition(" Mesa")[0],
        **({"Mesa": mesa[1]} if mesa else {}),
        **known,
    }


def versions() -> dict[str, str]:
    """What there is to be said without a GL context."""
    return {
        "shader-harness": version("shader-harness"),
        "glslang": native.glslang_version(),
        "CPU": _cpu(),
        "Python": platform.python_version(),
        "numpy": version("numpy"),
    }


def _cpu() -> str:
    """The processor's own name: between makers of processors results can differ in their last bits."""
    try:
        found = re.search(r"^model name\s*: (.+)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    except OSError:
        found = None
    return found[1].strip() if found else platform.machine()
