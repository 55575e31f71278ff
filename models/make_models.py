"""Write the models of the project, glTF 2.0 binary files, next to this script: the same bytes on any machine.

  teapot.glb        POSITION, NORMAL, TANGENT, TEXCOORD_0: for passes with maps
  teapot_plain.glb  the same mesh with POSITION and NORMAL only: for passes without

There are two since SHADERed keeps one vertex set-up per file: of two passes that read the same file, the last
one's input layout would hold for both.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import glb
import teapot_mesh

SOURCE = "Bezier control points: M. Newell, PhD thesis, University of Utah, 1975; bottom disc added"


def models() -> dict[str, bytes]:
    """File name to content."""
    mesh = teapot_mesh.teapot()
    plain = {"POSITION": mesh.position, "NORMAL": mesh.normal}
    full = {**plain, "TANGENT": mesh.tangent, "TEXCOORD_0": mesh.texcoord}
    extras = {"source": SOURCE}
    return {
        "teapot.glb": glb.pack("teapot", full, mesh.triangles, extras),
        "teapot_plain.glb": glb.pack("teapot_plain", plain, mesh.triangles, extras),
    }


def write(path: Path, content: bytes) -> None:
    """Replace a file in one step, so that no reader ever meets half of it."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=path.name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.chmod(temporary, 0o644)  # mkstemp lets no one else read it
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def main() -> int:
    """Command line; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 if a file differs or is missing")
    parser.add_argument(
        "--directory",
        type=Path,
        default=Path(__file__).resolve().parent,
        help="where the files are (default: the folder of this script)",
    )
    arguments = parser.parse_args()
    if not arguments.directory.is_dir():
        parser.error(f"--directory {arguments.directory}: no such folder")
    stale = False
    for name, content in models().items():
        path = arguments.directory / name
        if not arguments.check:
            write(path, content)
            print(f"{path}: {len(content)} bytes")
        elif not path.is_file() or path.read_bytes() != content:
            print(f"{path}: missing or not what make_models.py writes; run it again", file=sys.stderr)
            stale = True
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
