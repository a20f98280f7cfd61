"""What came of a practice: as JSON, as lines of text, and for the browser."""

from collections.abc import Iterator
from statistics import fmean
from typing import Any, Final

from lightgesture.practice.session import Progress, Session

MOST_CONFUSIONS: Final = 8
"""Confusions that are told in text, the most frequent first."""


def summary(
    session: Session, source: str, grammar: str, person: str | None, level: str | None
) -> dict[str, Any]:
    """The whole practice as one JSON object; docs/practice.md lists its fields."""
    return {
        "type": "practice",
        "source": source,
        "grammar": grammar,
        "person": person,
        "level": level,
        "sentences": [_task(progress) for progress in session.progress],
        "readings": dict(sorted(session.readings.items())),
        "confusions": [
            {"asked": asked, "read": read, "times": times}
            for (asked, read), times in session.confusions.most_common()
        ],
    }


def _task(progress: Progress) -> dict[str, Any]:
    signs = zip(progress.task.sentence.signs, progress.seconds, strict=True)
    return {
        "text": progress.task.sentence.text,
        "instruction": progress.task.instruction or None,
        "kind": progress.task.kind or None,
        "done": progress.is_done,
        "seconds": progress.total_s,
        "mistakes": progress.fatal,
        "slips": progress.slips,
        "signs": [
            {"word": sign.word, "pair": list(sign.pair), "seconds": seconds} for sign, seconds in signs
        ],
        "log": [
            {
                "reason": mistake.reason,
                "detail": mistake.detail,
                "word": mistake.word,
                "time_s": mistake.time_s,
                "again": mistake.is_fatal,
            }
            for mistake in progress.mistakes
        ],
    }


def tell_task(progress: Progress) -> str:
    """One task in a line."""
    text = progress.task.sentence.text
    cost = f"{_count(progress.fatal, 'mistake')}, {_count(progress.slips, 'slip')}"
    if not progress.is_done:
        return f"{text}: not signed; {cost}"
    return f"{text}: right after {progress.total_s:.1f} s; {cost}"


def tell_summary(content: dict[str, Any]) -> Iterator[str]:
    """The end of a practice in lines."""
    sentences = content["sentences"]
    done = sum(item["done"] for item in sentences)
    times = [sign["seconds"] for item in sentences for sign in item["signs"] if sign["seconds"] is not None]
    mean = f"; {fmean(times):.1f} s a sign" if times else ""
    mistakes = _count(sum(item["mistakes"] for item in sentences), "mistake")
    slips = _count(sum(item["slips"] for item in sentences), "slip")
    yield f"{done} of {_count(len(sentences), 'sentence')} signed, {mistakes}, {slips}{mean}"
    if content["confusions"]:
        yield "Hands that were read as another sign, or not at all, for a while:"
    for item in content["confusions"][:MOST_CONFUSIONS]:
        shown = content["readings"].get(item["asked"], 0)
        yield f"  {item['asked']} as {item['read']}: {item['times']} of {shown}"


def view(session: Session) -> dict[str, Any]:
    """What the page shows while it goes on."""
    current = session.current
    shown: dict[str, Any] = {
        "number": session.number + 1,
        "of": len(session.progress),
        "last": session.last,
        "is_done": session.is_done,
        "results": [
            [tell_task(progress), progress.is_done] for progress in session.progress[: session.number]
        ],
    }
    if current is not None:
        shown |= {
            "sentence": current.task.sentence.text,
            "place": current.place,
            "signs": [
                {"word": sign.word, "pair": list(sign.pair), "seconds": seconds}
                for sign, seconds in zip(current.task.sentence.signs, current.seconds, strict=True)
            ],
            "mistakes": current.fatal,
            "slips": current.slips,
            "elapsed_s": round(session.elapsed_s),
        }
    return shown


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
