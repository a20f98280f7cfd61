"""Pictures: by the vehicle's camera, or of our own frames where it takes none, each with its time."""

from concurrent.futures import Future
from datetime import UTC, datetime
from functools import partial
from itertools import count
from pathlib import Path
from typing import Final

from lightgesture.errors import UsageError
from lightgesture.features.types import Image
from lightgesture.fsm import Instruction
from lightgesture.vehicle.bench import Bench, seconds_of
from lightgesture.vehicle.interface import Reply, StopPictures, TakePictures
from lightgesture.vehicle.runs import Outcome, Run
from lightgesture.vehicle.steps import CameraStep

GRACE_S: Final = 3.0
"""Seconds after the last picture is due in which a camera may still tell of it."""

MOST_WAITING: Final = 4
"""Own frames that wait to be written; where a card is slower, pictures are left out."""


class CameraRun(Run):
    """A row of pictures."""

    is_moving = False

    def __init__(self, record: Instruction, step: CameraStep) -> None:
        super().__init__(record)
        self._step = step
        self._total_s: float = seconds_of(step.seconds, step.missing, record)
        self._reply: Reply | None = None
        self._interval_s = step.interval_s
        self._count, self._taken = 1, 0
        self._begun_s = 0.0
        self._own: OwnPictures | None = None

    def begin(self, bench: Bench, now_s: float) -> None:
        """Ask the camera, if there is one."""
        self._interval_s = bench.interval_s or self._step.interval_s
        self._count = max(1, round(self._total_s / self._interval_s))
        self._begun_s = now_s
        self.detail = "a picture" if self._count == 1 else f"{self._count} pictures"
        if self._step.camera:
            order = TakePictures(component=self._step.camera, interval_s=self._interval_s, count=self._count)
            self._reply = bench.vehicle.order(order, now_s)
        else:
            self._begin_own(now_s)

    def tick(self, bench: Bench, now_s: float) -> Outcome:
        """Until all are taken."""
        if self._own is not None:
            return self._tick_own(self._own, bench, now_s)
        assert self._reply is not None
        if self._reply.state == "pending":
            return "pending"
        if self._reply.state == "refused":
            if not self._step.folder:
                return self.refuse(f"camera {self._step.camera}: {self._reply.detail}")
            self.news.append(f"camera {self._step.camera}: {self._reply.detail}; our own frames instead")
            self._begin_own(now_s)
            return "pending"
        return self._tick_camera(bench, now_s)

    def end(self, bench: Bench, now_s: float, to_another: bool = False) -> None:  # noqa: ARG002 - no sticks here
        """A camera that is not done yet is told to stop."""
        if self._reply is not None and self._reply.state == "accepted" and self._taken < self._count:
            bench.vehicle.order(StopPictures(component=self._step.camera), now_s)

    def _tick_camera(self, bench: Bench, now_s: float) -> Outcome:
        for picture in bench.status.pictures:
            self._taken += 1
            self.news.append(
                f"picture {picture.number} by camera {self._step.camera} {picture.place}".strip()
            )
        if self._taken >= self._count:
            self.detail = f"{self._taken} pictures by camera {self._step.camera}"
            return "done"
        if now_s - self._begun_s < (self._count - 1) * self._interval_s + GRACE_S:
            return "going"
        return self.refuse(f"camera {self._step.camera} told of {self._taken} of {self._count} pictures")

    def _begin_own(self, now_s: float) -> None:
        self._begun_s = now_s
        self._own = OwnPictures(Path(self._step.folder))

    def _tick_own(self, own: "OwnPictures", bench: Bench, now_s: float) -> Outcome:
        due = self._begun_s + self._taken * self._interval_s
        if self._taken < self._count and now_s >= due:
            if bench.frame is not None and bench.frame.time_s >= due - self._interval_s:
                own.take(bench, bench.frame.image, bench.frame.time_s - now_s)
            self._taken += 1
        self.news += own.written()
        if own.failure:
            return self.refuse(own.failure)
        if self._taken < self._count or own.is_writing:
            return "going"
        self.detail = f"{own.count} of {self._count} own frames in {self._step.folder}"
        return "done" if own.count else self.refuse("no picture came to be kept")


class OwnPictures:
    """Frames written to a folder as JPEG, in another thread, named by their time of day in UTC."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._waiting: list[Future[str]] = []
        self.count = 0
        self.failure = ""

    @property
    def is_writing(self) -> bool:
        """Whether some are still to be written."""
        return bool(self._waiting)

    def take(self, bench: Bench, image: Image, age_s: float) -> None:
        """Have a frame written. age_s: seconds from now to when it was seen, at most 0."""
        if len(self._waiting) < MOST_WAITING:
            moment = datetime.fromtimestamp(datetime.now(UTC).timestamp() + min(age_s, 0.0), UTC)
            self._waiting.append(bench.helper.start(partial(_write, self._folder, image, moment)))

    def written(self) -> list[str]:
        """Where those lie that were written since the last call."""
        found: list[str] = []
        while self._waiting and self._waiting[0].done():
            try:
                found.append(self._waiting.pop(0).result())
            except UsageError as error:
                self.failure = str(error)
        self.count += len(found)
        return found


def _write(folder: Path, image: Image, moment: datetime) -> str:
    import cv2

    from lightgesture.results.atomic import replacing

    stem = moment.strftime("%Y%m%dT%H%M%S.") + f"{moment.microsecond // 1000:03d}Z"
    names = (stem if number == 0 else f"{stem}_{number}" for number in count())
    path = next(path for name in names if not (path := folder / f"{name}.jpg").exists())
    with replacing(path) as temporary:
        temporary.write_bytes(cv2.imencode(".jpg", image)[1].tobytes())
    return str(path)
