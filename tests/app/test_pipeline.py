"""The real stages joined up, on drawn frames: records, sizes, sides and clocks."""

from types import SimpleNamespace

import numpy as np
import pytest

from lightgesture import Pipeline
from lightgesture.actions.decode import SAMPLE
from lightgesture.features.colour import ColourStage
from lightgesture.features.find.settings import LEARNED
from lightgesture.features.types import Candidates, HandRegion
from lightgesture.front_end import KEPT_TIMES, StageClock
from lightgesture.hands import HandReader, ReadingSettings, ReadingStage
from lightgesture.hands.pictures import draw_regions
from lightgesture.hands.reading import clearest, is_crowded, read_token
from lightgesture.models import load_classifier
from lightgesture.records import FrameRecord, SummaryRecord
from lightgesture.sources import open_source

CLASSES = ("0", "5", "none")


class FakeClassifier:
    """Gives the rows that it was made with, one a box, in turn."""

    classes = CLASSES

    def __init__(self, rows):
        self.rows = np.array(rows, np.float32)
        self.asked = []

    def probabilities(self, image_bgr, boxes, sides):
        self.asked.append((list(boxes), list(sides)))
        return self.rows[: len(boxes)]


def _noise(seed=0, size=(480, 640)):
    return np.random.default_rng(seed).integers(0, 256, (*size, 3), np.uint8)


def test_a_stream_of_nothing_gives_frame_records_and_a_summary():
    pipeline = Pipeline(source="black")
    for index in range(3):
        records = pipeline.process(np.zeros((48, 64, 3), np.uint8), index / 30)
        assert [type(record) for record in records] == [FrameRecord]
        assert records[0].to_dict() == {
            "type": "frame",
            "source": "black",
            "frame": index,
            "time_s": index / 30,
            "utc": None,
            "hands": [],
        }
    (summary,) = pipeline.finish()
    assert isinstance(summary, SummaryRecord)
    assert (summary.frames, summary.instructions, summary.rejected, summary.status) == (3, 0, 0, "ok")
    assert list(summary.stages_ms) == ["colour", "regions", "tracks", "classify", "decode"]
    assert summary.ms_per_frame["median"] > 0


def test_frames_that_are_left_out_of_the_index_are_not_counted():
    pipeline = Pipeline()
    for index in (0, 2, 9):
        pipeline.process(np.zeros((48, 64, 3), np.uint8), index / 30, index)
    assert pipeline.finish()[-1].frames == 3


def test_a_pipeline_for_another_stream_loads_nothing_and_remembers_nothing(monkeypatch):
    loaded = []

    def load(model):
        loaded.append(model)
        return load_classifier(model)

    monkeypatch.setattr("lightgesture.halves.load_classifier", load)
    with open_source(SAMPLE) as source:
        frames = [frame for frame, _ in zip(source, range(24), strict=False)]
    first = Pipeline(source="first", hold=5)
    seen = [first.process(frame.image, frame.time_s) for frame in frames]
    again = first.for_stream("first")
    assert [again.process(frame.image, frame.time_s) for frame in frames] == seen
    assert any(record.hands for records in seen for record in records if isinstance(record, FrameRecord))
    other = first.for_stream("other")
    assert other.finish()[-1].frames == 0
    assert other.process(frames[0].image, 0.0)[0].source == "other"
    assert first.finish()[-1].frames == again.finish()[-1].frames == 24
    assert loaded == ["cnn"]


@pytest.mark.parametrize("frames", [True, False])
def test_frame_records_are_given_when_asked_for(frames):
    records = Pipeline(frames=frames).process(np.zeros((48, 64, 3), np.uint8), 0.0)
    assert len(records) == int(frames)


def test_frames_may_change_their_size_in_mid_stream():
    pipeline = Pipeline()
    for index, size in enumerate([(480, 640), (240, 320), (1, 1), (1080, 1920), (480, 640)]):
        pipeline.process(_noise(index, size), index / 30)
    assert pipeline.finish()[-1].frames == 5


def test_time_that_stands_still_or_runs_back_raises_nothing():
    pipeline = Pipeline()
    for time_s in (0.0, 0.0, 5.0, 1.0, float("nan")):
        pipeline.process(_noise(), time_s)


def test_a_mirrored_picture_gives_the_mirrored_boxes_and_the_same_sides():
    region = HandRegion((100, 50, 60, 80), np.zeros((3, 2), np.int32), None, 0.9)
    other = HandRegion((400, 50, 60, 80), np.zeros((3, 2), np.int32), None, 0.9)
    pairs = np.array([[0, 0.9], [0.9, 0]], np.float32)

    def boxes_of(mirrored):
        reading = ReadingStage(FakeClassifier([[0.9, 0.1, 0.0]] * 2))
        find = FakeRegions(Candidates((region, other), pairs, (640, 480)))
        record = Pipeline(HandReader(reading, find=find, mirrored=mirrored)).recognize(_noise())
        return {hand.side: hand.box for hand in record.hands}

    assert boxes_of(False) == {"right": (100, 50, 60, 80), "left": (400, 50, 60, 80)}
    assert boxes_of(True) == {"right": (480, 50, 60, 80), "left": (180, 50, 60, 80)}


def test_the_clearest_extent_is_read():
    rows = [[0.1, 0.2, 0.7], [0.05, 0.9, 0.05], [0.6, 0.2, 0.2]]
    stage = ReadingStage(FakeClassifier(rows))
    boxes = ((10, 10, 30, 60), (10, 10, 30, 40), (12, 12, 20, 20))
    (hand,) = stage.process(_noise(), [hand_of("left", *boxes, number=7)])
    assert (hand.token, hand.box, hand.track, hand.reason) == ("5", boxes[1], 7, None)
    assert clearest(np.array(rows, np.float32), CLASSES) == 1


def test_the_mean_of_the_extents_doubts_where_they_differ():
    rows = [[0.1, 0.8, 0.1], [0.95, 0.03, 0.02]]
    stage = ReadingStage(FakeClassifier(rows), ReadingSettings(extents="mean"))
    (hand,) = stage.process(_noise(), [hand_of("left", (10, 10, 30, 60), (10, 10, 30, 40))])
    assert (hand.token, hand.reason, hand.box) == (None, "low_confidence", (10, 10, 30, 40))
    assert list(hand.probabilities.values()) == pytest.approx([0.525, 0.415, 0.06])


def test_the_rule_sentence_is_told_the_mean_and_its_frame_records_tell_it_on():
    with open_source(SAMPLE) as source:
        frames = [frame for frame, _ in zip(source, range(24), strict=False)]
    told = {}
    for rule in ("sentence", "frames"):
        pipeline = Pipeline(rule=rule)
        records = [pipeline.process(frame.image, frame.time_s)[0].to_dict() for frame in frames]
        told[rule] = [hand for record in records for hand in record["hands"]]
    assert told["sentence"]
    for hand in told["sentence"]:
        assert all(0.005 <= chance <= 1.0 for chance in hand["probabilities"].values())
    assert not any("probabilities" in hand for hand in told["frames"])


def test_options_of_the_decoder_and_of_the_reader():
    pipeline = Pipeline(rule="sentence", caution=2.0, hold_seconds=0.5, threshold=0.9)
    assert (pipeline.decoder.rule, pipeline.decoder.hold_seconds) == ("sentence", 0.5)
    other = pipeline.for_stream("other").decoder
    assert (other.rule, other.hold_seconds) == ("sentence", 0.5)
    with pytest.raises(ValueError, match="rule, caution: of no effect beside another decoder"):
        Pipeline(decoder=other, rule="sentence", caution=2.0)


@pytest.mark.parametrize(
    ("row", "at_edge", "crowded", "token", "reason"),
    [
        ([0.9, 0.05, 0.05], False, False, "0", None),
        ([0.98, 0.01, 0.01], True, True, "0", None),
        ([0.9, 0.05, 0.05], True, True, None, "partial"),
        ([0.4, 0.3, 0.3], False, False, None, "low_confidence"),
        ([0.4, 0.3, 0.3], True, True, None, "partial"),
        ([0.4, 0.3, 0.3], False, True, None, "occluded"),
        ([0.75, 0.15, 0.1], False, True, None, "occluded"),
        ([0.85, 0.1, 0.05], False, True, "0", None),
        ([0.9, 0.05, 0.05], True, False, None, "partial"),
        ([0.1, 0.2, 0.7], False, False, None, "unknown_shape"),
        ([0.1, 0.2, 0.7], True, True, None, "unknown_shape"),
    ],
)
def test_a_token_is_refused_with_its_reason(row, at_edge, crowded, token, reason):
    settings = ReadingSettings()
    found = read_token(np.array(row, np.float32), CLASSES, at_edge, crowded, settings)
    assert (found[0], found[2]) == (token, reason)
    factor = settings.edge_factor if at_edge else settings.crowded_factor if crowded else 1.0
    assert found[1] == pytest.approx(max(row) * factor)


def test_a_threshold_above_the_factor_reads_nothing_at_the_edge():
    sure = np.array([1.0, 0.0, 0.0], np.float32)
    settings = ReadingSettings(token_probability=0.75)
    assert read_token(sure, CLASSES, False, True, settings)[0] == "0"
    assert read_token(sure, CLASSES, True, False, settings)[::2] == (None, "partial")


@pytest.mark.parametrize(
    ("others", "face", "expected"),
    [
        ([], None, False),
        ([], (150.0, 120.0), True),
        ([], (90.0, 120.0), False),
        ([(160, 100, 100, 100)], None, True),
        ([(190, 100, 100, 100)], None, False),
        ([(300, 300, 10, 10)], None, False),
    ],
    ids=["alone", "before the face", "beside the face", "overlap", "touch", "far"],
)
def test_a_hand_before_a_face_or_another_hand_is_crowded(others, face, expected):
    assert is_crowded((100, 100, 100, 100), others, face) is expected


def test_a_frame_runs_in_one_thread_of_linear_algebra_and_gives_the_others_back(monkeypatch):
    from threadpoolctl import ThreadpoolController, threadpool_limits

    def counts():
        return [
            library.num_threads for library in ThreadpoolController().select(user_api="blas").lib_controllers
        ]

    inside = []

    class Colour(ColourStage):
        def process(self, image):
            inside.append(counts())
            return super().process(image)

    pipeline = Pipeline(HandReader(ReadingStage(FakeClassifier([])), colour=Colour()))
    with threadpool_limits(2, user_api="blas"):
        before = counts()
        pipeline.process(_noise(), 0.0)
        pipeline.recognize(_noise())
        assert counts() == before
    assert all(count == 1 for frame in inside for count in frame)
    assert len(inside) == 2


def test_an_uncertain_side_lowers_the_confidence():
    stage = ReadingStage(FakeClassifier([[1.0, 0.0, 0.0]]))
    (hand,) = stage.process(_noise(), [hand_of("left", (10, 10, 30, 60), certainty=0.8)])
    assert hand.confidence == pytest.approx(0.8)


def test_each_hand_is_read_from_its_own_rows():
    classifier = FakeClassifier([[0.9, 0.1, 0.0], [0.1, 0.8, 0.1], [0.2, 0.7, 0.1]])
    first, second = hand_of("right", (1, 1, 9, 9)), hand_of("left", (90, 9, 9, 9), (88, 8, 9, 9))
    hands = ReadingStage(classifier).process(_noise(), [first, second])
    assert [hand.token for hand in hands] == ["0", "5"]
    assert classifier.asked[0][1] == ["right", "left", "left"]


def test_no_sighting_asks_no_classifier():
    classifier = FakeClassifier([])
    assert ReadingStage(classifier).process(_noise(), []) == ()
    assert classifier.asked == []


def test_the_picture_of_the_regions_shows_a_box_where_there_is_no_outline():
    empty = np.zeros((0, 2), np.int32)
    outline = np.array([[50, 20], [60, 20], [55, 35]], np.int32)
    regions = (
        HandRegion((5, 20, 20, 30), empty, None, 0.8),
        HandRegion((50, 20, 11, 16), outline, None, 0.6),
    )
    picture = draw_regions(
        np.zeros((60, 80, 3), np.uint8), Candidates(regions, np.zeros((2, 2), np.float32), (80, 60))
    )
    assert picture[35, 5].any()
    assert picture[20, 55].any()


@pytest.mark.parametrize("kind", ["grey", "deep", "with alpha"])
def test_frames_of_any_kind_are_read_as_their_bgr_version(kind):
    bgr = np.random.default_rng(3).integers(0, 255, (120, 160, 1), np.uint8).repeat(3, axis=2)
    other = {
        "grey": bgr[..., 0],
        "deep": bgr.astype(np.uint16) * 257,
        "with alpha": np.dstack([bgr, np.full((120, 160), 255, np.uint8)]),
    }[kind]
    seen = []

    class Reader(FakeClassifier):
        def probabilities(self, image_bgr, boxes, sides):
            seen.append(image_bgr)
            return super().probabilities(image_bgr, boxes, sides)

    region = HandRegion((60, 40, 30, 40), np.zeros((0, 2), np.int32), None, 0.9)
    find = FakeRegions(Candidates((region,), np.zeros((1, 1), np.float32), (160, 120)))
    reading = ReadingStage(Reader([[0.9, 0.05, 0.05]] * 8))
    Pipeline(HandReader(reading, find=find)).recognize(other)
    np.testing.assert_array_equal(seen[0], bgr)


class FakeRegions:
    """Finds the same in every frame."""

    settings = LEARNED

    def __init__(self, candidates):
        self.candidates = candidates

    def process(self, colour):
        return self.candidates

    def follow(self, colour, boxes):
        return None


def hand_of(side, box, *alternatives, number=1, certainty=1.0):
    return SimpleNamespace(side=side, box=box, alternatives=alternatives, number=number, certainty=certainty)


def test_times_of_a_long_stream_take_no_more_memory():
    clock = StageClock()
    for _ in range(KEPT_TIMES + 500):
        clock.start()
        clock.lap("colour")
        clock.end_frame()
    assert len(clock.frames_ms) == len(clock.stages_ms["colour"]) == KEPT_TIMES
    assert set(clock.per_stage()) == {"colour"}
