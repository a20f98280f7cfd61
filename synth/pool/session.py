"""Trials one after the other, with one decoder, one profile and one film."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final, Self

from lightgesture.config.opening import open_pipeline
from lightgesture.config.options import read_config
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import Progress
from lightgesture.synth.output import video_writer
from lightgesture.synth.pool.body import BodySpec
from lightgesture.synth.pool.film import FILM_FPS, SIZE, Film
from lightgesture.synth.pool.plans import Plan
from lightgesture.synth.pool.trial import Trial
from lightgesture.synth.pool.verdict import Verdict, verdicts
from lightgesture.vehicle.profile_file import load_vehicle

PROFILE: Final = Path(__file__).with_name("pool.toml")
"""Of the simulated vehicle."""
HOLD_S: Final = 0.5
"""Seconds for which a sign is held, unless the configuration says otherwise, as of `live`."""


class Session:
    """Use it in a `with` block. profile: a name or a file; config: a file of the decoder's options; None: the defaults.

    current_mps: of the water, north and east. UsageError: a file is wrong.
    """

    def __init__(self, profile: str | None, config: str | None, current_mps: tuple[float, float]) -> None:
        options: dict[str, Any] = {} if config is None else read_config(config)
        if not {"hold", "hold_seconds", "rule", "grammar"} & options.keys():
            options["hold_seconds"] = HOLD_S
        self._profile = load_vehicle(str(PROFILE) if profile is None else profile)
        self._pipeline = open_pipeline(DecodeSettings.model_validate({**options, "frames": True}), None, None)
        self._body = BodySpec(current_mps=current_mps)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *reason: object) -> None:
        self._pipeline.close()

    def run(self, plans: Sequence[Plan], film_path: Path | None, is_quiet: bool) -> list[Verdict]:
        """All trials; their verdicts in order. film_path: where the film goes; None: none is made."""
        rows: list[Verdict] = []
        with ExitStack() as stack:
            film = None
            if film_path is not None:
                film = Film(stack.enter_context(video_writer(film_path, FILM_FPS, SIZE)))
                stack.callback(film.close)
            bar = stack.enter_context(Progress("simulate", len(plans), "trial", is_quiet))
            for plan in plans:
                trial = Trial(plan, self._pipeline, self._profile, self._body)
                watch = None if film is None else film.begin(plan, trial.vehicle.body)
                rows += verdicts(trial.run(watch), self._profile)
                bar.advance()
        return rows
