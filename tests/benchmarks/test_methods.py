"""The pipeline and the paper's chain behind one interface."""

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks import methods
from lightgesture.benchmarks.methods import Decoded, PaperMethod, PipelineMethod, product
from lightgesture.benchmarks.paper.bank import HandBank, hu_moments, largest_contour
from lightgesture.benchmarks.scorer import Reading
from lightgesture.fsm import Decoder, Signs, load_grammar
from lightgesture.records import FrameRecord, Hand, SummaryRecord


@pytest.fixture
def scene():
    image = np.full((480, 640, 3), (150, 110, 40), np.uint8)
    for x in (150, 480):
        cv2.ellipse(image, (x, 200), (30, 42), 0, 0, 360, (120, 150, 210), -1)
    return image


@pytest.fixture
def bank(scene):
    oval = largest_contour((scene[:, :320, 2] == 210).astype(np.uint8))
    return HandBank(hu_moments(oval)[None], ("5",), 0.05)


def test_paper_chain_names_by_its_bank(scene, bank):
    readings = PaperMethod(bank).read(scene)
    assert sorted((reading.side, reading.token) for reading in readings) == [("left", "5"), ("right", "5")]


def test_paper_chain_names_by_the_classifier(scene, bank, fake_classifier):
    method = PaperMethod(bank, fake_classifier)
    assert [reading.token for reading in method.read(scene)] == ["5", "5"]
    assert fake_classifier.calls[0][2] == ["right", "left"]
    assert method.read(np.zeros_like(scene)) == []
    assert len(fake_classifier.calls) == 1


def test_classifiers_none_is_no_token(scene, bank, fake_classifier):
    class Refuser(type(fake_classifier)):
        def probabilities(self, image_bgr, boxes, sides):
            return super().probabilities(image_bgr, [(0, 0, 9, 9)] * len(boxes), sides)

    assert [reading.token for reading in PaperMethod(bank, Refuser()).read(scene)] == [None, None]


def test_held_pair_of_the_paper_chain_is_decoded(scene, bank):
    """{5, 5} is HOVER, which has no place without a start word: one word, and the sentence is rejected."""
    stream = PaperMethod(bank).stream(hold=3)
    for index in range(6):
        stream.process(scene, index / 30)
    reference = Decoder(load_grammar(), hold=3)
    events = [event for index in range(6) for event in reference.step(Signs.of_tokens("5", "5"), index / 30)]
    expected = methods.decoded([*events, *reference.finish()])
    assert stream.finish() == expected
    assert expected.instructions == ()


class FakePipeline:
    """Sees one hand in every frame and decodes STOP HOVER GO in the third."""

    created: list[dict[str, object]]

    def __init__(self, **options):
        self.created.append(options)
        self._decoder = Decoder(load_grammar(), hold=1)
        self._script = [("0", "0"), (None, None), ("5", "5"), (None, None), ("ok", "ok")]

    def recognize(self, image):
        hand = Hand(
            side="left", token="5", confidence=0.9, box=(1, 2, image.shape[1], 4), track=None, reason=None
        )
        return FrameRecord(source=None, frame=None, time_s=None, hands=(hand,))

    def process(self, image, time_s, index=None):
        return [self.recognize(image), *self._decoder.step(Signs.of_tokens(*self._script[index]), time_s)]

    def finish(self):
        summary = SummaryRecord(
            source=None,
            frames=5,
            seconds=0.2,
            instructions=1,
            rejected=0,
            status="ok",
            ms_per_frame={},
            stages_ms={},
        )
        return [*self._decoder.finish(), summary]


def test_pipeline_method_reads_frames_and_collects_events(monkeypatch, scene):
    FakePipeline.created = []
    monkeypatch.setattr(methods, "Pipeline", FakePipeline)
    method = product("some.npz")
    assert isinstance(method, PipelineMethod)
    hand = Reading((1, 2, 640, 4), "left", "5")
    assert method.read(scene) == [hand]
    stream = method.stream(hold=1)
    assert [stream.process(scene, index / 30) for index in range(5)] == [[hand]] * 5
    assert stream.finish() == Decoded(("STOP", "HOVER", "GO"), ("STOP HOVER GO",), 0)
    assert FakePipeline.created == [
        {"model": "some.npz", "selector": "learned", "rule": "frames", "hold": None},
        {"model": "some.npz", "selector": "learned", "rule": "frames", "hold": 1},
    ]
    assert method.name == "lightgesture"
    assert product("some.npz", "classical").name == "lightgesture, classical"
    assert FakePipeline.created[-1]["selector"] == "classical"
