"""Options that tell where pictures come from and where results go."""

from typing import TYPE_CHECKING, Any, Literal

from pydantic import field_validator

from lightgesture.config import DEFAULT_FPS
from lightgesture.config.declaring import (
    CALIBRATE,
    DECODE,
    LIVE,
    PRACTICE,
    RECOGNIZE,
    STREAMS,
    Options,
    option,
)

if TYPE_CHECKING:
    from lightgesture.sources import SourceOptions

MAX_FPS = 1000.0
"""Highest rate of a folder of frames, frames a second."""

MAX_JOBS = 1024
"""Most worker processes."""

MAX_GIVE_UP_S = 86_400.0
"""Longest wait for a picture after which `live` gives up, seconds: a day."""


class FileOptions(Options):
    """Where pictures come from and where results go."""

    fps: float = option(
        DEFAULT_FPS,
        f"frames a second of what has no clock: folders, bare streams of H.264 or JPEG (default: {DEFAULT_FPS:g})",
        "F",
        only=(DECODE, CALIBRATE),
        gt=0,
        le=MAX_FPS,
        allow_inf_nan=False,
    )
    as_json: bool = option(
        False, "records on standard output, one JSON object a line", alias="json", changes_results=False
    )
    frames: bool = option(False, "a record for every frame too", only=(DECODE, LIVE))
    out: str | None = option(
        None,
        "write DIR/<input stem>.jsonl of each input; of videos also .csv and .vtt (subtitles), and dives.csv of all;"
        " what is there of a video and up to date stays",
        "DIR",
        kind="path",
        only=(DECODE, RECOGNIZE),
        changes_results=False,
        min_length=1,
    )
    annotate: Literal["below", "beside", "over", "no"] = option(
        "no",
        "write DIR/<input stem>_annotated.mp4 (of pictures .png) too: hands drawn in, sentence and outcome in a bar"
        " below the picture, beside it, or over it (default: no; alone: below)",
        "below|beside|over|no",
        only=(DECODE, RECOGNIZE),
        may_stand_alone=True,
    )
    plot: bool = option(
        False, "write DIR/<input stem>.png too, a picture of signs and instructions over time", only=(DECODE,)
    )
    jobs: int | None = option(
        None,
        "videos decoded at once, each by a process of its own (default: the cores)",
        "N",
        only=(DECODE,),
        changes_results=False,
        ge=1,
        le=MAX_JOBS,
    )
    cluster: str | None = option(
        None,
        "decode on the workers of the Dask scheduler at this address",
        "ADDRESS",
        only=(DECODE,),
        changes_results=False,
        min_length=1,
    )
    size: str | None = option(
        None,
        "width and height in pixels: of raw BGR pictures on standard input; asked of a camera",
        "WxH",
        only=(*STREAMS, CALIBRATE),
        pattern=r"^[1-9][0-9]{0,4}x[1-9][0-9]{0,4}$",
    )
    topic: str | None = option(
        None, "image topic of a bag (default: the only one)", "NAME", only=(DECODE, CALIBRATE), min_length=1
    )
    insecure: bool = option(
        False,
        "take a camera's own certificate for https, which nobody vouches for",
        only=(LIVE, CALIBRATE, PRACTICE),
        changes_results=False,
    )
    give_up: float | None = option(
        None,
        "end after so many seconds without a picture, with exit status 1 (default: try for ever)",
        "S",
        only=(LIVE,),
        gt=0,
        le=MAX_GIVE_UP_S,
        allow_inf_nan=False,
        changes_results=False,
    )
    recursive: bool = option(
        False, "videos in the folders of a folder too", only=(DECODE,), changes_results=False
    )
    join: bool = option(
        False,
        "the chapters of one recording (GX010001, GX020001; DJI_0001, DJI_0002) are one input, with one time",
        only=(DECODE,),
    )

    @field_validator("annotate", mode="before")
    @classmethod
    def _named(cls, value: Any) -> Any:
        """A file may say true or false, for the first of the places and for none."""
        return {True: "below", False: "no"}.get(value, value) if isinstance(value, bool) else value

    @property
    def is_annotated(self) -> bool:
        """Whether pictures with everything drawn in are wanted."""
        return self.annotate != "no"

    @property
    def source_options(self) -> "SourceOptions":
        """What the user says about the source of pictures."""
        from lightgesture.sources import SourceOptions

        return SourceOptions(self.fps, self.width_height, self.topic, self.insecure)

    @property
    def width_height(self) -> tuple[int, int] | None:
        """`size` as numbers, pixels."""
        if self.size is None:
            return None
        width, _, height = self.size.partition("x")
        return int(width), int(height)
