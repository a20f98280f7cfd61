"""`lightgesture calibrate`: some seconds of open hands to a colour profile."""

import argparse
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from lightgesture.errors import ExitStatus, InputError, UsageError

if TYPE_CHECKING:
    from lightgesture.actions.calibrate import Calibration, Place
    from lightgesture.features.types import Box

LONGEST_S = 600.0
"""Most seconds of a source that are looked at."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "source",
        metavar="SOURCE",
        help="video, folder of frames, bag, or what `live` takes (camera, address, GStreamer pipeline, - for standard "
        "input), in which a diver shows both open hands",
    )
    parser.add_argument(
        "--out", default="profile.json", metavar="FILE", help="profile to write (default: profile.json)"
    )
    parser.add_argument("--kind", choices=("skin", "glove"), default="skin", help="of hands (default: skin)")
    parser.add_argument(
        "--seconds",
        type=_seconds,
        default=5.0,
        metavar="S",
        help="how much of the source is looked at, from its first picture (default: 5)",
    )
    parser.add_argument(
        "--hands",
        action="append",
        default=[],
        metavar="X,Y,W,H|middle",
        help="where a hand is held in every frame, for gloves that are not found by themselves: its box in pixels, "
        "once or for both hands, or the middle of the picture",
    )
    parser.add_argument(
        "--fps",
        type=_seconds,
        default=30.0,
        metavar="F",
        help="frames a second of a folder of frames or of standard input (default: 30)",
    )
    parser.add_argument(
        "--size",
        type=_size,
        metavar="WxH",
        help="width and height in pixels: of raw BGR pictures on standard input; asked of a camera",
    )
    parser.add_argument("--topic", metavar="NAME", help="image topic of a bag (default: the only one)")
    parser.add_argument("--force", action="store_true", help="write a profile that separates poorly too")


def run(args: argparse.Namespace) -> int:
    """Learn, judge and write a profile; InputError where there are no hands or it separates poorly."""
    from lightgesture.actions.calibrate import CalibrationSettings, calibrate
    from lightgesture.console import native_messages_muted, print_line, say
    from lightgesture.features.profile import save_profile
    from lightgesture.results.atomic import replacing
    from lightgesture.sources import SourceOptions, StreamFrames, open_any

    out, place = _out(args.out), _place(args.hands)
    options = SourceOptions(args.fps, args.size, args.topic)
    with native_messages_muted(), open_any(args.source, options) as source:
        if isinstance(source, StreamFrames):
            say(f"{source.name}: hold both open hands still before the camera for {args.seconds:g} s")
        result = calibrate(source, args.kind, place, CalibrationSettings(seconds=args.seconds))
    for line in _report(result):
        print_line(line)
    if result.lack is not None and not args.force:
        raise InputError(
            f"{source.name}: {result.lack}; nothing is written. Show the hands before another background or in better "
            "light, or write it all the same with --force"
        )
    with replacing(out) as temporary:
        save_profile(temporary, result.profile)
    print_line(f"written      {out}; use it with: --profile {out}")
    return ExitStatus.OK


def _report(result: "Calibration") -> list[str]:
    """How well it separates, in plain words."""
    shown, separation = result.shown, result.profile.separation
    words = "well" if result.lack is None else "poorly"
    lines = [
        f"hands        {'both' if shown.hands == 2 else 'one'} in {len(shown.images)} of {shown.looked_at} pictures",
        f"separation   {separation:.3f} (1 is perfect, 0.5 useless): this profile tells hands from all else {words}",
        f"stand out    {result.share:.2f} of the hands with this profile, {result.share_without:.2f} with the map of "
        "skin colours",
    ]
    if result.lack is None and result.share <= result.share_without:
        lines.append("remark       the map of skin colours does as well here; no profile is needed")
    if shown.broke_off is not None:
        lines.append(f"remark       {shown.broke_off}; what came before was learnt from")
    return lines


def _out(text: str) -> Path:
    """The file to write, refused before the diver holds still rather than after."""
    path = Path(text)
    if path.is_dir() or not path.name:
        raise UsageError(f"{text}: is a folder; name a file with --out")
    if not path.parent.is_dir():
        raise UsageError(f"{path.parent}: no such folder; make it or give another path with --out")
    try:
        with tempfile.TemporaryFile(dir=path.parent):
            return path
    except OSError as error:
        raise UsageError(f"{path}: cannot be written ({error.strerror}); name another folder") from None


def _place(texts: list[str]) -> "Place":
    if not texts:
        return None
    if "middle" in texts:
        if len(texts) > 1:
            raise UsageError("--hands middle: goes with no other; give boxes or the middle")
        return "middle"
    if len(texts) > 2:
        raise UsageError(f"--hands: {len(texts)} boxes; a diver has two hands, give one or two")
    return tuple(_box(text) for text in texts)


def _box(text: str) -> "Box":
    try:
        x, y, width, height = (int(part) for part in text.split(","))
    except ValueError:
        x, y, width, height = -1, 0, 0, 0
    if min(x, y) < 0 or min(width, height) < 1:
        raise UsageError(
            f"--hands {text}: is no box; give left edge, upper edge, width and height, as in 40,60,90,120"
        )
    return x, y, width, height


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal() and 0 < int(width) < 1e5 and 0 < int(height) < 1e5):
        raise argparse.ArgumentTypeError(
            f"{text} is no size; write width and height in pixels, as in 640x480"
        )
    return int(width), int(height)


def _seconds(text: str) -> float:
    value = float(text)
    if not 0 < value <= LONGEST_S:
        raise argparse.ArgumentTypeError(f"{text} is not above 0 and at most {LONGEST_S:g}")
    return value
