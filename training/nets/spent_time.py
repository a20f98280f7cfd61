"""The time that a training took over all its runs, kept in the folder of its parts."""

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final, ParamSpec

from lightgesture.results.atomic import replacing
from lightgesture.training.nets.checkpoints import REQUEST

Told = ParamSpec("Told")
"""What is told of the progress."""
FILE: Final = "seconds.json"
"""What was spent until the last message, in the folder of the parts."""


class SpentTime:
    """Seconds of a training, those of its earlier runs in the same folder counted.

    As a context manager it keeps them when its block ends, by an interruption too; `kept_by` keeps them at each message
    besides, for a process that is killed. Of a folder with parts whose seconds nobody kept they stay unknown.

    folder: as `checkpoint_folder` gives it, before anything is put there. clock: gives seconds.
    """

    def __init__(self, folder: Path, clock: Callable[[], float] = time.monotonic) -> None:
        self._file, self._clock, self._began = folder / FILE, clock, clock()
        self._before: float | None = None
        if self._file.is_file():
            self._before = json.loads(self._file.read_text(encoding="utf-8"))
        elif all(part.name == REQUEST for part in folder.iterdir()):
            self._before = 0.0

    @property
    def seconds(self) -> float | None:
        """Until now; None where they are unknown."""
        return None if self._before is None else self._before + self._clock() - self._began

    @property
    def whole_seconds(self) -> int | None:
        """The same for a card, rounded."""
        return None if self.seconds is None else round(self.seconds)

    def keep(self) -> None:
        """Write them down for the next run."""
        with replacing(self._file) as temporary:
            temporary.write_text(json.dumps(self.seconds), encoding="utf-8")

    def kept_by(self, progress: Callable[Told, None]) -> Callable[Told, None]:
        """What tells progress, and keeps the seconds each time."""

        def tell(*told: Told.args, **more: Told.kwargs) -> None:
            progress(*told, **more)
            self.keep()

        return tell

    def __enter__(self) -> "SpentTime":
        return self

    def __exit__(self, *reason: object) -> None:
        self.keep()
