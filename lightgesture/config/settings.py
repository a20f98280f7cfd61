"""Every option of the decoding commands with its range and its effect, as one model."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator

from lightgesture.config import DEFAULT_FPS

if TYPE_CHECKING:
    from lightgesture.sources import SourceOptions

MAX_HOLD = 1000
"""Longest hold, frames: 16 s at 60 frames a second."""

MAX_JOBS = 1024
"""Most worker processes."""

MIN_HOLD_S, MAX_HOLD_S = 0.05, 60.0
"""Shortest and longest hold, seconds."""

MIN_CAUTION, MAX_CAUTION = 0.1, 3.0
"""Least and greatest caution, as a grammar file may ask for."""

MAX_GIVE_UP_S = 86_400.0
"""Longest wait for a picture after which `live` gives up, seconds: a day."""

QUARTER = 90
"""Degrees by whole numbers of which a picture is turned."""

MAX_FPS = 1000.0
"""Highest rate of a folder of frames, frames a second."""

DECODE = "decode"
RECOGNIZE = "recognize"
LIVE = "live"
CALIBRATE = "calibrate"
PRACTICE = "practice"
DECODING = (DECODE, RECOGNIZE, LIVE, PRACTICE)
STREAMS = (DECODE, LIVE, PRACTICE)
"""The commands whose pictures follow each other in time."""

BUILT_IN_MODELS = ("cnn", "svm")
"""Names that `--model` knows; any other is the path of a file."""

BUILT_IN_VEHICLES = ("ardusub", "manual")
"""Likewise profiles that `--obey` knows."""


def _option(
    default: Any,
    text: str,
    metavar: str | None = None,
    *,
    only: tuple[str, ...] = DECODING,
    kind: Literal["path", ""] = "",
    may_stand_alone: bool = False,
    changes_results: bool = True,
    **checks: Any,
) -> Any:
    """A field that is an option too.

    only: the commands that have it. kind: "path" of a file or a folder. may_stand_alone: on the command line it is the
    first word of `metavar` where none follows. changes_results: whether what `decode` writes into its folder of results
    depends on it.
    """
    extra: Any = {
        "metavar": metavar,
        "only": only,
        "kind": kind,
        "may_stand_alone": may_stand_alone,
        "changes_results": changes_results,
    }
    return Field(default=default, description=text, json_schema_extra=extra, **checks)


class DecodeSettings(BaseModel):
    """Every option of the decoding commands, checked."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    model: str = _option(
        "cnn", "classifier: cnn, svm or a model file", "cnn|svm|PATH", kind="path", min_length=1
    )
    selector: Literal["learned", "classical"] = _option(
        "learned", "how hands are found: learned (small nets) or classical (no net)", "learned|classical"
    )
    profile: str | None = _option(
        None,
        "colour profile of the diver's hands or gloves (default: any skin)",
        "FILE",
        kind="path",
        min_length=1,
    )
    grammar: str | None = _option(None, "grammar file (default: the bundled one)", "FILE", kind="path")
    hold: int | None = _option(
        None,
        "consecutive frames that a sign is held to count, by the rule frames, which this chooses (15 by --rule frames)",
        "N",
        only=STREAMS,
        ge=1,
        le=MAX_HOLD,
    )
    hold_seconds: float | None = _option(
        None,
        "seconds that a sign is held to count, whatever the camera's rate; least ones of a sign by the rule sentence",
        "S",
        only=STREAMS,
        ge=MIN_HOLD_S,
        le=MAX_HOLD_S,
        allow_inf_nan=False,
    )
    rule: Literal["frames", "seconds", "evidence", "sentence"] | None = _option(
        None,
        "when signs count: each by itself, after a hold in frames or seconds or by evidence, or by the whole sentence"
        " (default: the grammar's own, else sentence)",
        "frames|seconds|evidence|sentence",
        only=STREAMS,
    )
    caution: float | None = _option(
        None,
        "how sure a sentence must be to be issued, by the rule sentence: less issues more, and more that is wrong"
        " (default: the grammar's own, else 1)",
        "C",
        only=STREAMS,
        ge=MIN_CAUTION,
        le=MAX_CAUTION,
        allow_inf_nan=False,
    )
    threshold: float | None = _option(
        None,
        "least probability of a token, 0 to 1 (default: 0.7)",
        "P",
        ge=0,
        le=1,
        allow_inf_nan=False,
    )
    front_end: Literal["hands", "tags", "tag-motion"] = _option(
        "hands",
        "what is read: bare hands, cards, or two cards that are moved",
        "hands|tags|tag-motion",
    )
    tag_detector: Literal["aruco", "apriltag"] = _option(
        "aruco",
        "how cards are found: aruco (OpenCV) or apriltag (for murk; slower, needs lightgesture[tags])",
        "aruco|apriltag",
    )
    shapes: str | None = _option(
        None,
        "shapes of your own for moved cards, from `motions record`",
        "FILE",
        kind="path",
        min_length=1,
    )
    mirrored: bool = _option(False, "the picture is mirrored, as that of a selfie camera")
    rotate: int = _option(
        0,
        "degrees, clockwise, by which the picture is turned to stand upright; boxes are told as it came",
        "90|180|270",
        only=(*DECODING, CALIBRATE),
        ge=0,
        lt=360,
        multiple_of=QUARTER,
    )
    fps: float = _option(
        DEFAULT_FPS,
        f"frames a second of what has no clock: folders, bare streams of H.264 or JPEG (default: {DEFAULT_FPS:g})",
        "F",
        only=(DECODE, CALIBRATE),
        gt=0,
        le=MAX_FPS,
        allow_inf_nan=False,
    )
    as_json: bool = _option(
        False, "records on standard output, one JSON object a line", alias="json", changes_results=False
    )
    frames: bool = _option(False, "a record for every frame too", only=(DECODE, LIVE))
    out: str | None = _option(
        None,
        "write DIR/<input stem>.jsonl of each input; of videos also .csv and .vtt (subtitles), and dives.csv of all;"
        " what is there of a video and up to date stays",
        "DIR",
        kind="path",
        only=(DECODE, RECOGNIZE),
        changes_results=False,
        min_length=1,
    )
    annotate: Literal["below", "beside", "over", "no"] = _option(
        "no",
        "write DIR/<input stem>_annotated.mp4 (of pictures .png) too: hands drawn in, sentence and outcome in a bar"
        " below the picture, beside it, or over it (default: no; alone: below)",
        "below|beside|over|no",
        only=(DECODE, RECOGNIZE),
        may_stand_alone=True,
    )
    plot: bool = _option(
        False, "write DIR/<input stem>.png too, a picture of signs and instructions over time", only=(DECODE,)
    )
    jobs: int | None = _option(
        None,
        "videos decoded at once, each by a process of its own (default: the cores)",
        "N",
        only=(DECODE,),
        changes_results=False,
        ge=1,
        le=MAX_JOBS,
    )
    cluster: str | None = _option(
        None,
        "decode on the workers of the Dask scheduler at this address",
        "ADDRESS",
        only=(DECODE,),
        changes_results=False,
        min_length=1,
    )
    size: str | None = _option(
        None,
        "width and height in pixels: of raw BGR pictures on standard input; asked of a camera",
        "WxH",
        only=(*STREAMS, CALIBRATE),
        pattern=r"^[1-9][0-9]{0,4}x[1-9][0-9]{0,4}$",
    )
    topic: str | None = _option(
        None, "image topic of a bag (default: the only one)", "NAME", only=(DECODE, CALIBRATE), min_length=1
    )
    insecure: bool = _option(
        False,
        "take a camera's own certificate for https, which nobody vouches for",
        only=(LIVE, CALIBRATE, PRACTICE),
        changes_results=False,
    )
    give_up: float | None = _option(
        None,
        "end after so many seconds without a picture, with exit status 1 (default: try for ever)",
        "S",
        only=(LIVE,),
        gt=0,
        le=MAX_GIVE_UP_S,
        allow_inf_nan=False,
        changes_results=False,
    )
    recursive: bool = _option(
        False, "videos in the folders of a folder too", only=(DECODE,), changes_results=False
    )
    join: bool = _option(
        False,
        "the chapters of one recording (GX010001, GX020001; DJI_0001, DJI_0002) are one input, with one time",
        only=(DECODE,),
    )
    udp: list[str] = _option(
        [], "send the records as JSON datagrams too (repeatable)", "HOST:PORT", only=(LIVE,)
    )
    mavlink: list[str] = _option(
        [],
        "send heartbeats and instructions by MAVLink, as to udpout:127.0.0.1:14550 (repeatable)",
        "LINK",
        only=(LIVE,),
    )
    mavlink_map: str | None = _option(
        None,
        "values and commands that instructions send by MAVLink (default: none)",
        "FILE",
        kind="path",
        only=(LIVE,),
    )
    mavlink_system: int | None = _option(
        None,
        "number of the vehicle on the MAVLink links, 1 to 255 (default: that of the one autopilot that is heard)",
        "N",
        only=(LIVE,),
        ge=1,
        le=255,
    )
    obey: str | None = _option(
        None,
        "carry the instructions out on the vehicle of the first --mavlink, as this profile says: ardusub, manual or a"
        " file (default: nothing is carried out)",
        "FILE",
        kind="path",
        only=(LIVE,),
        min_length=1,
    )
    answer: list[str] = _option(
        [],
        "answer the diver: by a lamp, lamp:GREEN,ORANGE,RED (pins, BCM numbers), or by the vehicle's motion, motion"
        " (repeatable)",
        "SINK",
        only=(LIVE,),
    )
    hook: list[str] = _option(
        [],
        "run a command for each instruction, its record as JSON on standard input (repeatable)",
        "COMMAND",
        only=(LIVE,),
    )
    web: int | None = _option(
        None,
        "serve a page with the annotated picture and the instructions",
        "PORT",
        only=(LIVE, PRACTICE),
        ge=1,
        le=65535,
    )
    web_host: str = _option(
        "127.0.0.1",
        "address that the page is served on; 0.0.0.0 lets the whole network look",
        "HOST",
        only=(LIVE, PRACTICE),
        min_length=1,
    )
    web_token: str | None = _option(
        None,
        "what browsers must name where the page is served to the network, 8 to 128 letters, digits, - or _ (default: a"
        " new one at each start, printed with the page's address); none: whoever reaches it may look",
        "TOKEN",
        only=(LIVE, PRACTICE),
        pattern=r"^(none|[A-Za-z0-9_-]{8,128})$",
    )
    web_blueos: bool = _option(
        False,
        "serve the page as an extension of BlueOS: listed and shown by it, under any name that ends in .local",
        only=(LIVE,),
    )
    debug_dir: str | None = _option(
        None,
        "write a picture of every stage: DIR/<input stem>/<stage>-<frame>.png",
        "DIR",
        kind="path",
        only=(DECODE, RECOGNIZE, LIVE),
        min_length=1,
    )
    quiet: bool = _option(False, "no progress and no remarks on standard error", changes_results=False)

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


def _fields_with(key: str, value: object) -> tuple[str, ...]:
    """Fields whose options say this of themselves."""
    fields = DecodeSettings.model_fields.items()
    return tuple(
        name
        for name, field in fields
        if isinstance(field.json_schema_extra, dict) and field.json_schema_extra[key] == value
    )


PATH_OPTIONS = _fields_with("kind", "path")
"""Fields that name files and folders."""

NO_INFLUENCE = _fields_with("changes_results", False)
"""Fields that change no file of results; any other makes these anew."""


def change_paths(values: Mapping[str, Any], change: Callable[[str], str]) -> dict[str, str]:
    """The paths among the values of options, each as `change` makes it; names of what is built in are none."""
    given = {name: values.get(name) for name in PATH_OPTIONS}
    return {
        name: change(path)
        for name, path in given.items()
        if path and path not in (*BUILT_IN_MODELS, *BUILT_IN_VEHICLES)
    }
