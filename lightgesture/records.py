"""The records of frames and summaries; words, instructions and the rest are the events of `fsm`.

Every record is frozen, has `type`, and `to_dict()` gives the object that `--json` prints, keys in the documented order.
`utc` is the time of day, ISO 8601; None where the source has no absolute clock.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any, Final, Literal

from lightgesture.features.types import Box
from lightgesture.fsm import Event

LEAST_TOLD: Final = 0.005
"""Smallest probability in a record, 0 to 1: what is below changes no reading."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hand:
    """One hand as it was read.

    side: "left" or "right", the diver's own. token: one of the ten, or None with a `reason`
    ("low_confidence", "unknown_shape", "partial", "occluded"). confidence: 0 to 1, calibrated.
    box: outline of the hand without the forearm, source pixels. track: number of the track, None in single pictures.
    probabilities: of every class, 0 to 1, before the refusal; part of the record only where it is asked for.
    """

    side: str
    token: str | None
    confidence: float
    box: Box
    track: int | None
    reason: str | None
    probabilities: Mapping[str, float] = field(default_factory=dict, compare=False, repr=False)

    def to_dict(self, probabilities: bool = False) -> dict[str, Any]:
        """probabilities: tell those from LEAST_TOLD up too."""
        record: dict[str, Any] = {
            "side": self.side,
            "token": self.token,
            "confidence": self.confidence,
            "box": list(self.box),
            "track": self.track,
            "reason": self.reason,
        }
        if probabilities:
            rounded = {name: round(chance, 3) for name, chance in self.probabilities.items()}
            record["probabilities"] = {
                name: chance for name, chance in rounded.items() if chance >= LEAST_TOLD
            }
        return record


@dataclass(frozen=True, slots=True, kw_only=True)
class CardSign:
    """One tag as it was read.

    side: "left" or "right", the diver's own, where the card tells; else None. id: of its family. word: what the
    grammar says it says, None: nothing. corners: x and y of the black square, source pixels, upper left, upper right,
    lower right and lower left as it is printed. margin: half of the difference of its white and black cells, grey
    levels, 0 to 127.
    """

    side: str | None
    id: int
    word: str | None
    corners: tuple[tuple[float, float], ...]
    margin: float

    def to_dict(self) -> dict[str, Any]:
        return {**asdict(self), "corners": [list(corner) for corner in self.corners]}


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameRecord:
    """What was seen in one frame; `frame` and `time_s` (seconds) are None for a single picture.

    signs: the tags where cards are read, which the record then has in place of hands; None: hands are read.
    probabilities: whether the record has those of the hands, which the rule "sentence" reads.
    """

    type: Literal["frame"] = field(default="frame", init=False)
    source: str | None
    frame: int | None
    time_s: float | None
    utc: str | None = None
    hands: tuple[Hand, ...] = ()
    signs: tuple[CardSign, ...] | None = None
    probabilities: bool = False

    def to_dict(self) -> dict[str, Any]:
        record: dict[str, Any] = {
            "type": self.type,
            "source": self.source,
            "frame": self.frame,
            "time_s": self.time_s,
            "utc": self.utc,
        }
        if self.signs is None:
            return record | {"hands": [hand.to_dict(self.probabilities) for hand in self.hands]}
        return record | {"signs": [sign.to_dict() for sign in self.signs]}


@dataclass(frozen=True, slots=True, kw_only=True)
class SummaryRecord:
    """Totals of one source.

    frames: number processed. seconds, utc: time of the last frame. status: "ok", or "failed" for a source that broke
    off or showed hardly anything. ms_per_frame: "median" and "p95" of the whole pipeline, milliseconds. stages_ms:
    median milliseconds of each stage.
    """

    type: Literal["summary"] = field(default="summary", init=False)
    source: str | None
    utc: str | None = None
    frames: int
    seconds: float
    instructions: int
    rejected: int
    status: str
    ms_per_frame: dict[str, float]
    stages_ms: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class HeartbeatRecord:
    """A sign of life of a live stream, each second, whether pictures come or not.

    time_s: seconds since the start. frames: processed so far. dropped: passed over so far, because a newer one came
    while one was processed. ms_per_frame: median milliseconds of a picture, decoding it included, since the last
    heartbeat; 0 where none came. state: "idle" or "collecting", the decoder's.
    """

    type: Literal["heartbeat"] = field(default="heartbeat", init=False)
    source: str | None
    time_s: float
    utc: str | None = None
    frames: int
    dropped: int
    ms_per_frame: float
    state: str

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


VehicleState = Literal["sent", "accepted", "refused", "executing", "done", "aborted"]


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleRecord:
    """What became of an instruction at the vehicle, with `--obey` or `--mavlink-map`.

    time_s: seconds since the start. state: "sent" (the vehicle was told), "accepted" (it takes it), "executing"
    (how far it is), "done", "refused" (it does not do it), "aborted" (it was broken off). instruction: its text;
    None for what concerns the vehicle alone. detail: what, and why.
    """

    type: Literal["vehicle"] = field(default="vehicle", init=False)
    source: str | None = None
    time_s: float
    utc: str | None = None
    state: VehicleState
    instruction: str | None
    detail: str

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


def utc_text(start: datetime | None, time_s: float | None) -> str | None:
    """The moment `time_s` seconds after `start`, ISO 8601 in UTC to the millisecond; None where either is unknown."""
    if start is None or time_s is None:
        return None
    try:
        moment = start.astimezone(UTC) + timedelta(seconds=time_s)
    except (OverflowError, ValueError):  # a stamp that is no time
        return None
    return moment.isoformat(timespec="milliseconds").replace("+00:00", "Z")


Record = FrameRecord | SummaryRecord | HeartbeatRecord | VehicleRecord | Event
