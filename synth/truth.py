"""The truth of a scene as records: what a flawless pipeline would have said, frame by frame."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from lightgesture.fsm import Decoder, Grammar, Signs
from lightgesture.records import FrameRecord, Record
from lightgesture.synth.scene import SceneFrame

DISPLAY_ONLY = "state"
"""Records of this type serve displays and are left out of the truth."""


def with_truth(
    frames: Iterable[SceneFrame], grammar: Grammar, hold: int, source: str | None = None
) -> Iterator[tuple[SceneFrame, list[Record]]]:
    """Each frame with its records: the frame's own first, then the words, instructions and rejections it completes.

    hold: frames that a pair must be held. What ends with the last frame is given with it.
    """
    decoder = Decoder(grammar, hold=hold, source=source)
    waiting: tuple[SceneFrame, list[Record]] | None = None
    for frame in frames:
        if waiting is not None:
            yield waiting
        waiting = frame, [replace(frame.record, source=source), *_events(decoder, frame.record)]
    if waiting is not None:
        waiting[1].extend(event for event in decoder.finish() if event.type != DISPLAY_ONLY)
        yield waiting


def _events(decoder: Decoder, record: FrameRecord) -> Iterator[Record]:
    tokens = {hand.side: hand.token for hand in record.hands}
    time_s = record.time_s if record.time_s is not None else 0.0
    signs = Signs.of_tokens(tokens.get("left"), tokens.get("right"))
    for event in decoder.step(signs, time_s, frame=record.frame):
        if event.type != DISPLAY_ONLY:
            yield event
