"""From what the user names to what reads it."""

import glob
import os
import stat
import sys
from collections.abc import Callable, Iterable

from lightgesture.errors import InputError, UsageError
from lightgesture.sources.address import hide_login
from lightgesture.sources.bag_name import is_bag
from lightgesture.sources.capture import open_camera, open_gstreamer
from lightgesture.sources.contents import look_into
from lightgesture.sources.folder import FrameFolder, natural_key
from lightgesture.sources.network import NETWORK_SCHEMES, NetworkStream
from lightgesture.sources.rtp import RtpStream, read_description
from lightgesture.sources.standard_input import STANDARD_INPUT, StandardInput, StandardInputStream
from lightgesture.sources.stream_frames import StreamFrames
from lightgesture.sources.types import LiveSource, Source, SourceOptions
from lightgesture.sources.video import VideoFile


def _open_bag(path: str, options: SourceOptions) -> Source:
    # What reads bags takes time and memory that only who has one should pay for.
    from lightgesture.sources.bag import BagFile

    return BagFile(path, options.topic)


def _http_stream(address: str, options: SourceOptions) -> LiveSource:
    # HTTP and its encryption take time and memory that only who reads such a stream should pay for.
    from lightgesture.sources.http_stream import HttpStream

    return HttpStream(address, options.insecure)


DESCRIPTION_SUFFIX = ".sdp"
"""Ending of a file that describes a stream."""


def _open_folder(path: str, options: SourceOptions) -> Source:
    """The frames in a folder, or the one recording in it. InputError: there are several, which `decode` takes."""
    recordings = look_into(path, recursive=False).recordings
    if not recordings:
        return FrameFolder(path, options.fps)
    if len(recordings) > 1:
        names = ", ".join(map(os.path.basename, recordings[:3]))
        raise InputError(f"{path}: holds {len(recordings)} videos ({names}, ...); name one of them")
    return SOURCES[_kind(recordings[0])](recordings[0], options)


SOURCES: dict[str, Callable[[str, SourceOptions], Source]] = {
    "bag": _open_bag,
    "folder": _open_folder,
    "standard input": lambda _, options: StandardInput(options),
    "video": lambda path, options: VideoFile(path, options.fps),
}
"""Kind of input to what opens it, given its name and what the user says about it."""

LIVE_SOURCES: dict[str, Callable[[str, SourceOptions], LiveSource]] = {
    "camera": open_camera,
    "gstreamer": lambda line, _: open_gstreamer(line),
    "http": _http_stream,
    "description": lambda path, _: read_description(path),
    "network": lambda address, _: NetworkStream(address),
    "rtp": lambda address, _: RtpStream(address),
    "standard input": lambda _, options: StandardInputStream(options),
}
"""Kind of stream to what reads it, given its name and what the user says about it."""


def expand_inputs(inputs: Iterable[str]) -> list[str]:
    """The inputs in the order given, globs replaced by what they match in natural order, each file once.

    A name that exists is taken as it stands, also where it holds `*`, `?` or `[`. A glob that matches
    nothing stays, so that opening it tells the user. Two names of the same file are one (`a` and `./a`);
    a link is a file of its own.
    """
    found: dict[str, str] = {}
    for name in inputs:
        is_glob = not os.path.lexists(name) and glob.has_magic(name)
        matches = sorted(glob.glob(name, recursive=True), key=natural_key) if is_glob else []
        for match in matches or [name]:
            found.setdefault(os.path.normcase(os.path.abspath(match)), match)
    return list(found.values())


def open_source(path: str | os.PathLike[str], options: SourceOptions | None = None) -> Source:
    """Open a video, a folder of frames, a bag, or standard input (`-`); use it in a `with` block, iterate it once.

    InputError: one line that says what is wrong with this input.
    """
    name = os.fspath(path)
    return SOURCES[_kind(name)](name, options or SourceOptions())


def live_source(name: str, options: SourceOptions) -> LiveSource:
    """The stream of that name, not yet opened. UsageError: it is none, or cannot be read by this installation."""
    return LIVE_SOURCES[_live_kind(name)](name, options)


def refuse_missing_device(name: str) -> None:
    """UsageError: a camera that this machine does not have, which waiting brings only if somebody plugs it in."""
    is_index = name.isdecimal() and sys.platform == "linux"
    device = f"/dev/video{int(name)}" if is_index else name
    if (is_index or name.startswith("/dev/")) and not os.path.exists(device):
        there = ", ".join(sorted(glob.glob("/dev/video*"), key=natural_key)) or "no camera at all"
        raise UsageError(f"{name}: no such device; this machine has {there}")


def open_any(name: str, options: SourceOptions) -> Source:
    """Open what `open_source` opens, or make frames of what `live_source` reads; errors are those of these two.

    A stream is a `StreamFrames`, and is opened by its `with` block. What is there as a file or a folder is taken for
    one, and standard input for a recording.
    """
    is_file = os.path.isfile(name) and not name.lower().endswith(DESCRIPTION_SUFFIX)
    is_recording = name == STANDARD_INPUT or is_file or os.path.isdir(name)
    if is_recording or (_stream_kind(name) is None and "://" not in name):
        return open_source(name, options)
    return StreamFrames(live_source(name, options))


def _kind(name: str) -> str:
    if name == STANDARD_INPUT and not os.path.lexists(name):
        return "standard input"
    if is_bag(name):
        return "bag"
    if os.path.isdir(name):
        return "folder"
    if os.path.isfile(name):
        if name.lower().endswith(DESCRIPTION_SUFFIX):
            raise InputError(f"{name}: describes a stream; decode it with `lightgesture live`")
        return "video"
    if _is_pipe(name):
        raise InputError(
            f"{name}: is a pipe; send pictures to standard input, as `lightgesture decode - < {name}`"
        )
    if os.path.lexists(name):
        raise InputError(f"{name}: is neither a file nor a folder; name a video or a folder of frames")
    if "://" in name:
        raise InputError(f"{hide_login(name)}: is a stream; decode it with `lightgesture live`")
    if glob.has_magic(name):
        raise InputError(f"{name}: matches no file; check the pattern")
    raise InputError(f"{name}: no such file or folder; check the name")


def _live_kind(name: str) -> str:
    kind = "standard input" if name == STANDARD_INPUT else _stream_kind(name)
    if kind is not None:
        return kind
    if os.path.exists(name):
        raise UsageError(f"{name}: is no stream; decode files and folders with `lightgesture decode`")
    raise UsageError(
        f"{hide_login(name)}: is no stream; name a camera (0, /dev/video0), an address (http://, rtsp://, rtp://), "
        "a GStreamer pipeline or - for standard input"
    )


def _stream_kind(name: str) -> str | None:
    """Kind of a camera, an address or a pipeline; None for any other name."""
    scheme = name.partition("://")[0].lower() if "://" in name else ""
    if scheme in ("http", "https"):
        return "http"
    if scheme == "rtp":
        return "rtp"
    if scheme in NETWORK_SCHEMES:
        return "network"
    if name.lower().endswith(DESCRIPTION_SUFFIX):
        return "description"
    if " ! " in name:
        return "gstreamer"
    if name.isdecimal() or _is_device(name) or name.startswith("/dev/"):
        return "camera"
    return None


def _is_device(name: str) -> bool:
    return stat.S_ISCHR(_mode(name))


def _is_pipe(name: str) -> bool:
    return stat.S_ISFIFO(_mode(name))


def _mode(name: str) -> int:
    """Kind of file; 0 where there is none."""
    try:
        return os.stat(name).st_mode
    except (OSError, ValueError):
        return 0
