"""What goes on between the decoder, the session, the page and the terminal while somebody practises."""

import threading
import time
from collections.abc import Callable, Sequence
from typing import Final

from lightgesture.features.types import Image
from lightgesture.live import Report
from lightgesture.pipeline import Pipeline
from lightgesture.practice.session import Session
from lightgesture.practice.summary import tell_task, view
from lightgesture.records import Record
from lightgesture.web import WebListener

GONE_S: Final = 5.0
"""Seconds without a browser, after there was one, that are told."""


class Guide:
    """Listens to what is decoded: leads the session on, and shows it to browsers and in the terminal.

    tell: takes lines of results. stopping: is set when nothing is left to sign.
    """

    def __init__(
        self,
        session: Session,
        pipeline: Pipeline,
        page: WebListener,
        tell: Callable[[str], None],
        report: Report,
        stopping: threading.Event,
    ) -> None:
        self._session, self._pipeline, self._page = session, pipeline, page
        self._tell, self._report = tell, report
        self._stopping = stopping
        self._told = 0
        self._seen_s: float | None = None
        self._is_gone = False
        self._announce()

    def show(self, image_bgr: Image | None, records: Sequence[Record]) -> None:
        """Take a decoded picture and its records."""
        session = self._session
        session.take(records)
        if session.wants_fresh and records:
            last = records[0]
            self._pipeline.interrupt(
                "the practice begins the sentence again", getattr(last, "time_s", None) or 0.0
            )
            session.freshened()
        self._page.show(image_bgr, records)
        self._page.tell("practice", view(session))
        while self._told < session.number:
            self._tell(f"  {tell_task(session.progress[self._told])}")
            self._told += 1
            self._announce()
        self._watch_browser()
        if session.is_done:
            self._stopping.set()

    def _announce(self) -> None:
        current = self._session.current
        if current is not None:
            signs = " ".join(",".join(sign.pair) for sign in current.task.sentence.signs)
            place = f"{self._session.number + 1}/{len(self._session.progress)}"
            self._tell(f"{place} sign {current.task.sentence.text}: {signs}")

    def _watch_browser(self) -> None:
        """Say once that the page was closed."""
        now = time.monotonic()
        if self._page.viewers:
            self._seen_s, self._is_gone = now, False
        elif self._seen_s is not None and not self._is_gone and now - self._seen_s > GONE_S:
            self._is_gone = True
            self._report(
                f"the page was closed; the practice goes on here and at {self._page.address}practice; Ctrl-C ends it"
            )
