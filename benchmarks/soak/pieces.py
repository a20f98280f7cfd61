"""What is to come out of a clip that goes round and round: what comes out of it once, again and again."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Final

from lightgesture.benchmarks.soak.stream import FPS
from lightgesture.pipeline import Pipeline
from lightgesture.sources import to_image

Verdict = tuple[str, int, int]
"""An instruction, or why a sentence was rejected: its text, its first and its last frame."""

SLACK: Final = 5
"""Frames by which a verdict may come sooner or later: hands that are followed since the last round are read sooner."""


def of_pieces(pictures: Sequence[bytes], count: int) -> list[Verdict]:
    """The verdicts of `count` pictures that go round, decoded in pieces: one decoder a round, the last one cut."""
    found: list[Verdict] = []
    with Pipeline(frames=False) as pipeline:
        whole = list(_piece(pipeline, pictures))
        for start in range(0, count, len(pictures)):
            left = min(len(pictures), count - start)
            piece = whole if left == len(pictures) else list(_piece(pipeline, pictures[:left]))
            found += [(text, start + first, start + last) for text, first, last in piece]
    return found


def _piece(pipeline: Pipeline, pictures: Sequence[bytes]) -> Iterator[Verdict]:
    one = pipeline.for_stream("piece")
    for index, picture in enumerate(pictures):
        yield from of_records(record.to_dict() for record in one.process(to_image(picture), index / FPS))
    yield from of_records(record.to_dict() for record in one.finish())


def of_records(records: Iterable[dict[str, Any]]) -> list[Verdict]:
    """The verdicts among records as they are printed."""
    found = []
    for one in records:
        if one["type"] == "instruction":
            found.append((one["text"], one["start_frame"], one["frame"]))
        elif one["type"] == "rejected":
            found.append((f"{one['reason']}: {one['text']}", one["frame"], one["frame"]))
    return found


def unlike(name: str, found: Sequence[Verdict], expected: Sequence[Verdict]) -> list[str]:
    """What differs, in words; nothing where all is the same."""
    wrong = [
        f"{name}: {one} and not {other}"
        for one, other in zip(found, expected, strict=False)
        if one[0] != other[0] or max(abs(one[1] - other[1]), abs(one[2] - other[2])) > SLACK
    ]
    if len(found) != len(expected):
        wrong.append(f"{name}: {len(found)} verdicts and not {len(expected)}")
    return wrong[:3]
