"""The worst frame: whatever is shown, a frame costs one look, one search and a bounded number of patches at most."""

import cv2
import numpy as np
import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.features.find.locator import MOST_PEAKS
from lightgesture.features.find.refiner import Refiner
from lightgesture.features.find.selector import load_selector
from lightgesture.features.net.runner import Network
from lightgesture.hands import HandReader, ReadingStage
from lightgesture.hands.memory import memory_for_sentences
from lightgesture.models import load_classifier
from lightgesture.models.cnn import MOST_DOUBTED
from lightgesture.sources import open_source

MOST_PATCHES = 4
"""Of two hands, two extents each."""


@pytest.fixture(name="clip", scope="module")
def _clip():
    with open_source(SAMPLE) as source:
        return [frame.image for frame, _ in zip(source, range(60), strict=False)][30:]


def crossing(clip):
    return [image if index % 2 else np.ascontiguousarray(image[:, ::-1]) for index, image in enumerate(clip)]


def flickering(clip):
    return [image if index % 2 else (image // 4).astype(np.uint8) for index, image in enumerate(clip)]


def noise(clip):
    rng = np.random.default_rng(0)
    return [rng.integers(0, 256, image.shape, np.uint8) for image in clip]


def blobs(clip):
    rng = np.random.default_rng(1)
    picture = np.full_like(clip[0], (140, 100, 50))
    for x, y in rng.integers(0, 480, (500, 2)).tolist():
        cv2.circle(picture, (x, y), 9, (120, 150, 210), -1)
    return [np.roll(picture, 7 * index, axis=1) for index in range(len(clip))]


@pytest.mark.parametrize("scene", [crossing, flickering, noise, blobs])
def test_no_frame_costs_more_than_a_look_and_a_search(scene, clip, monkeypatch):
    finder, classifier = load_selector(), load_classifier("cnn")
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
        assert work["patches"] <= MOST_PATCHES + MOST_DOUBTED
