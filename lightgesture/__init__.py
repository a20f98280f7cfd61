"""Read a diver's two-handed signs in video and turn them into robot instructions."""

from importlib import import_module
from typing import TYPE_CHECKING

from lightgesture._version import __version__

if TYPE_CHECKING:
    from lightgesture.features import find_hands
    from lightgesture.fsm import Instruction, Notice, Rejected, State, Word
    from lightgesture.pipeline import Pipeline
    from lightgesture.records import FrameRecord, Hand, HeartbeatRecord, Record, SummaryRecord, VehicleRecord

__all__ = [
    "FrameRecord",
    "Hand",
    "HeartbeatRecord",
    "Instruction",
    "Notice",
    "Pipeline",
    "Record",
    "Rejected",
    "State",
    "SummaryRecord",
    "VehicleRecord",
    "Word",
    "__version__",
    "find_hands",
]

_PLACES = {
    **dict.fromkeys(
        ("FrameRecord", "Hand", "HeartbeatRecord", "Record", "SummaryRecord", "VehicleRecord"), "records"
    ),
    **dict.fromkeys(("Instruction", "Notice", "Rejected", "State", "Word"), "fsm"),
    "Pipeline": "pipeline",
    "find_hands": "features",
}
"""Name to the module of this package that has it."""


def __getattr__(name: str) -> object:
    """Import a name on first use, so that `import lightgesture` loads neither OpenCV nor NumPy."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_PLACES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
