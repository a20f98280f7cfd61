"""Options that tell how signs are read and when they count."""

from typing import Literal

from lightgesture.config.declaring import CALIBRATE, DECODING, STREAMS, Options, option

MAX_HOLD = 1000
"""Longest hold, frames: 16 s at 60 frames a second."""

MIN_HOLD_S, MAX_HOLD_S = 0.05, 60.0
"""Shortest and longest hold, seconds."""

MIN_CAUTION, MAX_CAUTION = 0.1, 3.0
"""Least and greatest caution, as a grammar file may ask for."""

QUARTER = 90
"""Degrees by whole numbers of which a picture is turned."""


class ReadingOptions(Options):
    """How signs are read and when they count."""

    model: str = option(
        "cnn", "classifier: cnn, svm or a model file", "cnn|svm|PATH", kind="path", min_length=1
    )
    selector: Literal["learned", "classical"] = option(
        "learned", "how hands are found: learned (small nets) or classical (no net)", "learned|classical"
    )
    profile: str | None = option(
        None,
        "colour profile of the diver's hands or gloves (default: any skin)",
        "FILE",
        kind="path",
        min_length=1,
    )
    grammar: str | None = option(None, "grammar file (default: the bundled one)", "FILE", kind="path")
    hold: int | None = option(
        None,
        "consecutive frames that a sign is held to count, by the rule frames, which this chooses (15 by --rule frames)",
        "N",
        only=STREAMS,
        ge=1,
        le=MAX_HOLD,
    )
    hold_seconds: float | None = option(
        None,
        "seconds that a sign is held to count, whatever the camera's rate; least ones of a sign by the rule sentence",
        "S",
        only=STREAMS,
        ge=MIN_HOLD_S,
        le=MAX_HOLD_S,
        allow_inf_nan=False,
    )
    rule: Literal["frames", "seconds", "evidence", "sentence"] | None = option(
        None,
        "when signs count: each by itself, after a hold in frames or seconds or by evidence, or by the whole sentence"
        " (default: the grammar's own, else sentence)",
        "frames|seconds|evidence|sentence",
        only=STREAMS,
    )
    caution: float | None = option(
        None,
        "how sure a sentence must be to be issued, by the rule sentence: less issues more, and more that is wrong"
        " (default: the grammar's own, else 1)",
        "C",
        only=STREAMS,
        ge=MIN_CAUTION,
        le=MAX_CAUTION,
        allow_inf_nan=False,
    )
    threshold: float | None = option(
        None,
        "least probability of a token, 0 to 1 (default: 0.7)",
        "P",
        ge=0,
        le=1,
        allow_inf_nan=False,
    )
    front_end: Literal["hands", "tags", "tag-motion"] = option(
        "hands",
        "what is read: bare hands, cards, or two cards that are moved",
        "hands|tags|tag-motion",
    )
    tag_detector: Literal["aruco", "apriltag"] = option(
        "aruco",
        "how cards are found: aruco (OpenCV) or apriltag (for murk; slower, needs lightgesture[tags])",
        "aruco|apriltag",
    )
    shapes: str | None = option(
        None,
        "shapes of your own for moved cards, from `motions record`",
        "FILE",
        kind="path",
        min_length=1,
    )
    mirrored: bool = option(False, "the picture is mirrored, as that of a selfie camera")
    rotate: int = option(
        0,
        "degrees, clockwise, by which the picture is turned to stand upright; boxes are told as it came",
        "90|180|270",
        only=(*DECODING, CALIBRATE),
        ge=0,
        lt=360,
        multiple_of=QUARTER,
    )
