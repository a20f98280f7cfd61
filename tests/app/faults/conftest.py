"""A signed sentence, that of the bundled clip, and what each rule makes of it when something goes wrong."""

from dataclasses import replace

import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.pipeline import Pipeline
from lightgesture.sources import open_source
from lightgesture.watch import Watch
from tests.app.faults.streams import Shown

RULES = ("frames", "seconds", "evidence", "sentence")


class Reader:
    """Reads frames by a rule as `decode` and `live` do, by what was read in them once, or by their pictures.

    frames: of the clip, small; whole: as they are.
    """

    def __init__(self, rule, frames):
        self.pipeline = Pipeline(rule=rule)
        front = self.pipeline.front
        self.whole = [Shown(time_s, image, front.process(image, time_s)) for time_s, image in frames]
        # Of what was read already pictures are looked at for holes alone.
        self.frames = [replace(frame, image=frame.image[::8, ::8].copy()) for frame in self.whole]

    def events(self, shown):
        """What becomes of frames whose signs are known."""
        decoder, watch, found = self.pipeline.decoder.for_stream(None), Watch(), []
        for index, frame in enumerate(shown):
            if (hole := watch.look(frame.image, frame.time_s)) is not None:
                found += decoder.interrupt(hole, frame.time_s, index)
            found += decoder.step(frame.signs, frame.time_s, index)
        return found + decoder.finish()

    def records(self, shown):
        """What becomes of (seconds, picture), which are read anew."""
        pipeline, watch, found = self.pipeline.for_stream(None), Watch(), []
        for index, (time_s, image) in enumerate(shown):
            if (hole := watch.look(image, time_s)) is not None:
                found += pipeline.interrupt(hole, time_s, index)
            found += pipeline.process(image, time_s, index)
        return found + pipeline.finish()


@pytest.fixture(scope="session")
def clip():
    """(seconds, picture) of the bundled clip."""
    with open_source(str(SAMPLE)) as source:
        return [(frame.time_s, frame.image) for frame in source]


@pytest.fixture(scope="session", params=RULES)
def reader(request, clip):
    """Reads the clip, by each of the rules."""
    return Reader(request.param, clip)
