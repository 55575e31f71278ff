"""``harness render``: a SHADERed project to a PNG, or to one a frame."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

SHORT = "render a .sprj to a PNG"
DESCRIPTION = """\
Renders a SHADERed project (.sprj) to the picture that SHADERed shows of it, without a display or a GPU. What SHADERed
passes over in silence is said on stderr.

  harness render project.sprj -o picture.png
  harness render project.sprj -o poster.png --size 1920x1080 --supersample 4
  harness render project.sprj -o frame.png --frames 0:100 --fps 30        frame00.png ... frame99.png
  harness render project.sprj -o picture.png --pass Blur --dump-targets targets/
"""

#: seconds; a shader can loop for ever
TIME_LIMIT = 100.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The project, the picture, its size and quality, when it is, and how much of it."""
    parser.add_argument("project", metavar="PROJECT.sprj")
    parser.add_argument("-o", "--output", required=True, metavar="OUT.png", help="the picture to write")
    parser.add_argument("--size", type=size, default=(1280, 720), metavar="WxH", help="pixels (1280x720)")
    parser.add_argument(
        "--supersample",
        type=int,
        choices=(1, 2, 4, 8),
        default=1,
        help="average N x N pixels into one (1)",
        metavar="N",
    )
    parser.add_argument("--frame", type=int, default=0, metavar="N", help="FrameIndex (0)")
    parser.add_argument(
        "--time", type=float, default=0.0, metavar="S", help="Time in seconds (0), of frame 0 (--frames)"
    )
    parser.add_argument("--frames", type=_frames, metavar="A:B", help="frames A to B - 1, one picture each")
    parser.add_argument("--fps", type=_rate, default=30.0, metavar="F", help="frames a second (30)")
    parser.add_argument("--pass", dest="until_pass", metavar="NAME", help="stop after this pass")
    parser.add_argument("--dump-targets", metavar="DIR", help="write each render texture as .png and .npy")
    parser.add_argument(
        "--keep-going", action="store_true", help="leave out what is wrong or not supported; the exit code says so"
    )
    parser.add_argument(
        "--watch", action="store_true", help="render again whenever a file of the project changes, until Ctrl-C"
    )


def run(options: argparse.Namespace) -> int:
    """Writes the pictures. 1 where something was left out."""
    from ..picture import write_png, write_targets
    from ..rendering.render import Renderer, render_sequence

    renderer = Renderer(
        options.project,
        options.size,
        options.supersample,
        until_pass=options.until_pass,
        keep_going=options.keep_going,
    )
    if options.frames is None:
        renderer.draw(options.frame, options.time)
        write_png(options.output, renderer.picture())
    else:
        output, digits = Path(options.output), len(str(options.frames[-1]))
        pictures = render_sequence(renderer, options.frames, options.fps, options.time)
        for frame, picture in zip(options.frames, pictures, strict=True):
            write_png(output.with_name(f"{output.stem}{frame:0{digits}}{output.suffix}"), picture)
    if options.dump_targets is not None:
        write_targets(options.dump_targets, renderer.targets())
    for said in (*renderer.warnings, *renderer.errors):
        print(said, file=sys.stderr)
    if sys.stderr.isatty():
        print(f"{options.output}: {options.size[0]} x {options.size[1]}", file=sys.stderr)
    return 1 if renderer.errors else 0


def size(text: str) -> tuple[int, int]:
    """A width and a height such as 1280x720."""
    match = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"{text!r} is no size such as 1280x720")
    return int(match[1]), int(match[2])


def _frames(text: str) -> range:
    match = re.fullmatch(r"(\d{1,9}):(\d{1,9})", text)
    if not match or int(match[1]) >= int(match[2]):
        raise argparse.ArgumentTypeError(f"{text!r} are no frames such as 0:100")
    return range(int(match[1]), int(match[2]))


def _rate(text: str) -> float:
    rate = float(text)
    if not 0 < rate < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is no rate above 0")
    return rate
