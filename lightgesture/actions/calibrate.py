"""What `calibrate` does: a source is looked at, its profile judged, told of and written."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from lightgesture.calibration import Calibration, Place, calibrate
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import print_line, say
from lightgesture.errors import ExitStatus, InputError, UsageError
from lightgesture.features.profile import Kind, ProfileError, load_profile, save_profile
from lightgesture.features.types import Box
from lightgesture.results.atomic import replacing
from lightgesture.sources import StreamFrames, open_any


def run_calibrate(
    source_name: str,
    settings: DecodeSettings,
    *,
    kind: Kind,
    seconds: float,
    hands: Sequence[str],
    out: str,
    is_forced: bool,
) -> ExitStatus:
    """Learn, judge and write a profile.

    seconds: of the source that are looked at. hands: where they are, as the user wrote it. is_forced: write a profile
    that separates poorly too. InputError: there are no hands, or it separates poorly. UsageError: `hands` or `out`.
    """
    file, place = _out(out), _place(hands)
    with open_any(source_name, settings.source_options) as source:
        if isinstance(source, StreamFrames):
            say(f"{source.name}: hold both open hands still before the camera for {seconds:g} s")
        result = calibrate(source, kind, place, seconds, settings.rotate)
    for line in _report(result):
        print_line(line)
    if result.lack is not None and not is_forced:
        raise InputError(
            f"{source.name}: {result.lack}; nothing is written. Show the hands before another background or in better "
            "light, or write it all the same with --force"
        )
    with replacing(file) as temporary:
        save_profile(temporary, result.profile)
    print_line(f"written      {file}; use it with: --profile {file}")
    return ExitStatus.OK


def _report(result: Calibration) -> list[str]:
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
    if path.exists() and not _is_profile(path):
        raise UsageError(f"{path}: is no profile and would be replaced; name another file with --out")
    try:
        with tempfile.TemporaryFile(dir=path.parent):
            return path
    except OSError as error:
        raise UsageError(f"{path}: cannot be written ({error.strerror}); name another folder") from None


def _is_profile(path: Path) -> bool:
    try:
        load_profile(path)
    except ProfileError:
        return False
    return True


def _place(texts: Sequence[str]) -> Place:
    if not texts:
        return None
    if "middle" in texts:
        if len(texts) > 1:
            raise UsageError("--hands middle: goes with no other; give boxes or the middle")
        return "middle"
    if len(texts) > 2:
        raise UsageError(f"--hands: {len(texts)} boxes; a diver has two hands, give one or two")
    return tuple(_box(text) for text in texts)


def _box(text: str) -> Box:
    try:
        x, y, width, height = (int(part) for part in text.split(","))
    except ValueError:
        x, y, width, height = -1, 0, 0, 0
    if min(x, y) < 0 or min(width, height) < 1:
        raise UsageError(
            f"--hands {text}: is no box; give left edge, upper edge, width and height, as in 40,60,90,120"
        )
    return x, y, width, height
