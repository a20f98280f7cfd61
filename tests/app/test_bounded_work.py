"""The worst frame: whatever is shown, a frame costs one look, one search and a bounded number of patches at most."""

import pytest

from lightgesture.benchmarks.bad_frames import SCENES, frame_times, read_clip
from lightgesture.features.find.locator import MOST_PEAKS
from lightgesture.features.find.refiner import Refiner
from lightgesture.features.find.selector import load_selector
from lightgesture.features.find.verifier import MOST_VERIFIED
from lightgesture.features.net.runner import Network
from lightgesture.hands import HandReader, ReadingStage
from lightgesture.hands.memory import memory_for_sentences
from lightgesture.models import load_classifier
from lightgesture.models.cnn import MOST_DOUBTED
from lightgesture.pipeline import Pipeline

MOST_PATCHES = 4
"""Of two hands, two extents each."""


@pytest.fixture(name="clip", scope="module")
def _clip():
    return read_clip()


@pytest.mark.parametrize("scene", list(SCENES.values()), ids=list(SCENES))
def test_no_frame_costs_more_than_a_look_and_a_search(scene, clip, monkeypatch):
    finder, classifier = load_selector(), load_classifier("cnn")
    larger = len(classifier.model.second.nets)
    work = {"searches": 0, "looks": 0, "windows": 0, "patches": 0}
    run, process, look = Network.run, finder.process, Refiner.look

    def counted_run(self, inputs):
        for name, kind in (("windows", "windows"), ("patch", "patches")):
            work[kind] += len(inputs.get(name, ()))
        return run(self, inputs)

    def counted_process(colour):
        work["searches"] += 1
        return process(colour)

    def counted_look(self, image, boxes):
        work["looks"] += 1
        return look(self, image, boxes)

    monkeypatch.setattr(Network, "run", counted_run)
    monkeypatch.setattr(finder, "process", counted_process)
    monkeypatch.setattr(Refiner, "look", counted_look)
    front = HandReader(ReadingStage(classifier), find=finder, memory=lambda: memory_for_sentences(0.4))
    for index, image in enumerate(scene(clip)):
        work.update(dict.fromkeys(work, 0))
        front.process(image, index / 30)
        assert work["searches"] <= 1
        assert work["looks"] <= 1
        assert work["windows"] <= MOST_PEAKS + 2
        verified = work["searches"] * MOST_VERIFIED
        assert work["patches"] <= MOST_PATCHES + larger * MOST_DOUBTED + verified


def test_the_worst_frame_is_that_of_the_quickest_pass(clip):
    times = frame_times(Pipeline(), clip[:3], 2)
    assert len(times) == 3
    assert all(0.0 < spent_ms < 1000.0 for spent_ms in times)
