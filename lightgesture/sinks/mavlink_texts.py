"""What the pilot reads, and hears, on the ground: STATUSTEXT, and which records are worth one."""

from typing import Any, Final

from lightgesture.fsm import Instruction, Rejected
from lightgesture.records import Record, VehicleRecord

TEXT_BYTES: Final = 50
"""Bytes of text in one STATUSTEXT."""

PREFIX: Final = "Diver: "
"""Begins each text of what was signed, so that who hears it knows where it is from."""

VEHICLE_PREFIX: Final = "Vehicle: "
"""Likewise what became of it."""

LIMITED_S: Final = 2.0
"""Least seconds from one rejection or refusal to the next that is told; those between are left out. An instruction
is always told. A ground station reads texts aloud, and each takes it about two seconds."""

_WARNING, _NOTICE = 4, 5  # MAV_SEVERITY
_TOLD_STATES = ("refused", "aborted", "done")


class Texts:
    """Chooses texts and cuts them into messages."""

    def __init__(self, dialect: Any) -> None:
        self._dialect = dialect
        self._count = 0
        self._limited_s = float("-inf")

    def messages(self, record: Record, now_s: float) -> list[Any]:
        """The messages for a record: none where it is not worth one, or where another was told just now."""
        chosen = text_of(record)
        if chosen is None:
            return []
        text, severity, is_limited = chosen
        if is_limited:
            if now_s - self._limited_s < LIMITED_S:
                return []
            self._limited_s = now_s
        return self._cut(text, severity)

    def _cut(self, text: str, severity: int) -> list[Any]:
        chunks = text_chunks(text)
        if len(chunks) > 1:  # 0 marks a text of one chunk
            self._count = self._count % 0xFFFF + 1
        number = self._count if len(chunks) > 1 else 0
        make = self._dialect.MAVLink_statustext_message
        return [make(severity, chunk, number, place) for place, chunk in enumerate(chunks)]


def text_of(record: Record) -> tuple[str, int, bool] | None:
    """Text, severity, and whether it may be left out where many come; None for a record that is not worth one."""
    match record:
        case Instruction():
            return PREFIX + record.text, _NOTICE, False
        case Rejected():
            return f"{PREFIX}rejected: {record.text} ({record.detail})", _WARNING, True
        case VehicleRecord() if record.state in _TOLD_STATES:
            is_good = record.state == "done"
            what = " ".join(filter(None, (record.state, record.instruction)))
            text = f"{VEHICLE_PREFIX}{what}" + ("" if is_good else f" ({record.detail})")
            return text, _NOTICE if is_good else _WARNING, record.state == "refused"
        case _:
            return None


def text_chunks(text: str) -> list[bytes]:
    """UTF-8 in pieces of at most 50 bytes; where the last would be full, an empty one follows to mark the end."""
    content = text.encode("utf-8", "replace")
    chunks = [content[start : start + TEXT_BYTES] for start in range(0, len(content), TEXT_BYTES)]
    if len(chunks) > 1 and len(chunks[-1]) == TEXT_BYTES:
        chunks.append(b"")
    return chunks or [b""]
