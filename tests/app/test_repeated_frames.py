"""Frames that equal the last one: nothing is looked for again, and nothing else is taken for such a frame."""

import numpy as np
import pytest

from lightgesture import Pipeline
from lightgesture.actions.decode import SAMPLE
from lightgesture.features.find.selector import load_selector
from lightgesture.front_end import StageClock
from lightgesture.hands import HandReader, ReadingStage
from lightgesture.models import load_classifier
from lightgesture.repeats import LastFrame
from lightgesture.sources import open_source


def picture(seed=0):
    return np.random.default_rng(seed).integers(0, 256, (120, 160, 3), np.uint8)


def test_a_copy_equals_the_last_frame_and_what_differs_anywhere_does_not():
    last = LastFrame()
    assert not last.equals(picture())
    assert last.equals(picture())
    for row, column in ((0, 0), (119, 159), (61, 80)):
        changed = picture()
        changed[row, column, 1] ^= 1
        assert not last.equals(changed)
        assert not last.equals(picture())
    assert not last.equals(picture()[:, :80])
    assert not last.equals(np.zeros((1, 1, 3), np.uint8))


def test_a_frame_written_over_the_last_one_is_another():
    buffer, last = picture(), LastFrame()
    last.equals(buffer)
    assert not last.equals(buffer)
    buffer[:] = picture(1)
    assert not last.equals(buffer)
    assert not last.equals(buffer[:])


class Watched:
    """The product's finder, and how often it was asked for anything."""

    def __init__(self):
        self._own = load_selector()
        self.settings, self.asked = self._own.settings, 0

    def process(self, colour):
        self.asked += 1
        return self._own.process(colour)

    def follow(self, image, boxes):
        self.asked += 1
        return self._own.follow(image, boxes)


@pytest.fixture(name="clip", scope="module")
def _clip():
    with open_source(SAMPLE) as source:
        return [frame.image for frame, _ in zip(source, range(70), strict=False)][40:]


def test_a_stream_that_repeats_its_frames_is_looked_at_once_a_frame(clip):
    finder = Watched()
    front = HandReader(ReadingStage(load_classifier("cnn")), find=finder)
    single, doubled = Pipeline(front), Pipeline(front.for_stream())
    for index, image in enumerate(clip):
        single.process(image.copy(), index / 15)
    before = finder.asked
    seen = []
    for index, image in enumerate(clip):
        for half in (0, 1):
            records = doubled.process(image.copy(), index / 15 + half / 30)
            seen.append([(hand.side, hand.token) for hand in records[0].hands])
    # The whole of a frame that repeats one that was only followed is searched where that is due.
    assert finder.asked - before <= 1.2 * before
    assert sum(first == second for first, second in zip(seen[::2], seen[1::2], strict=True)) >= len(clip) - 2


def test_a_stage_that_runs_twice_in_a_frame_has_one_time():
    clock = StageClock()
    for _ in range(3):
        clock.start()
        for stage in ("colour", "regions", "colour", "regions"):
            clock.lap(stage)
        clock.end_frame()
    assert {stage: len(times) for stage, times in clock.stages_ms.items()} == {"colour": 3, "regions": 3}
    assert sum(sum(times) for times in clock.stages_ms.values()) == pytest.approx(sum(clock.frames_ms))
