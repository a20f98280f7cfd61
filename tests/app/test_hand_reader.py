"""What the hand reader asks of its stages, and when; the stages say what a test says, and keep what they were asked."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.find.settings import LEARNED
from lightgesture.features.track.state import begin
from lightgesture.features.types import Candidates, HandRegion
from lightgesture.fsm import UNSEEN
from lightgesture.hands import HandReader
from lightgesture.hands.front import HIDDEN
from lightgesture.records import Hand

RIGHT, LEFT = (10, 20, 8, 6), (40, 20, 8, 6)
SEARCHED, FOLLOWED = "searched", "followed"


def candidates(score):
    regions = tuple(HandRegion(box, np.zeros((0, 2), np.int32), None, score) for box in (RIGHT, LEFT))
    return Candidates(regions, np.array([[0, 0.9], [0.9, 0]], np.float32), (64, 48), (32.0, 5.0))


FOUND = {SEARCHED: candidates(0.9), FOLLOWED: candidates(0.8)}


def track(key, side, box, missed=0):
    one = begin(key, key, HandRegion(box, np.zeros((0, 2), np.int32), None, 0.9), 0.0)
    return replace(one, side=side, number=key, missed=missed)


class Stages:
    """Finder, tracker and reader in one."""

    settings = LEARNED
    classes = ("0", "5", "none")

    def __init__(self):
        self.calls = []
        self.boxes, self.is_explained, self.can_follow = (), True, True
        self.tracks = (track(1, "right", RIGHT), track(2, "left", LEFT))

    def predict(self, time_s):
        return self.boxes

    def follow(self, image, boxes):
        self.calls.append(("follow", boxes))
        return FOUND[FOLLOWED] if self.can_follow else None

    def explains(self, found):
        assert found is FOUND[FOLLOWED]
        return self.is_explained

    def update(self, found, time_s, whole=True):
        name = next(name for name, one in FOUND.items() if one is found)
        self.calls.append(("update", name, whole))
        return self.tracks

    def process(self, *given):
        if len(given) == 1:  # of the finder
            self.calls.append(("search",))
            return FOUND[SEARCHED]
        _, hands, face, *_ = given
        self.calls.append(("read", [hand.box for hand in hands], face))
        return tuple(
            Hand(
                side=hand.side or "right",
                token="5",
                confidence=0.5,
                box=hand.box,
                track=hand.number,
                reason=None,
                probabilities={"5": 0.5},
            )
            for hand in hands
        )


@pytest.fixture
def stages():
    return Stages()


def reader(stages, **options):
    return HandReader(stages, find=stages, track=lambda: stages, **options)


def picture(seed=0):
    return np.random.default_rng(seed).integers(0, 256, (48, 64, 3), np.uint8)


def test_a_frame_is_searched_tracked_and_read(stages):
    front = reader(stages)
    signs = front.process(picture(), 0.0)
    assert stages.calls == [("search",), ("update", SEARCHED, True), ("read", [RIGHT, LEFT], (32.0, 5.0))]
    assert (signs.left.token, signs.right.token, signs.left.confidence) == ("5", "5", 0.5)
    assert signs.left.probabilities == {"5": 0.5}
    assert front.is_searched


@pytest.mark.parametrize(
    ("can_follow", "is_explained", "name"),
    [(True, True, FOLLOWED), (True, False, SEARCHED), (False, True, SEARCHED)],
)
def test_predicted_boxes_are_looked_at_first_and_the_frame_is_searched_where_that_explains_too_little(
    stages, can_follow, is_explained, name
):
    stages.boxes, stages.can_follow, stages.is_explained = (RIGHT, LEFT), can_follow, is_explained
    front = reader(stages)
    front.process(picture(), 0.0)
    searched = [("search",)] if name == SEARCHED else []
    assert stages.calls[:-1] == [
        ("follow", (RIGHT, LEFT)),
        *searched,
        ("update", name, name == SEARCHED),
    ]
    assert front.is_searched == (name == SEARCHED)


@pytest.mark.parametrize(
    ("boxes_before", "boxes", "is_kept"),
    [
        ((), (), True),  # all of it was searched
        ((RIGHT,), (RIGHT,), True),
        ((), (RIGHT,), True),
        ((RIGHT,), (), False),  # it was only followed, and a search is due
    ],
)
def test_a_frame_that_equals_the_last_one_is_not_looked_at(stages, boxes_before, boxes, is_kept):
    front = reader(stages)
    stages.boxes = boxes_before
    front.process(picture(), 0.0)
    stages.boxes = boxes
    stages.calls.clear()
    front.process(picture().copy(), 0.1)
    assert (stages.calls[0][0] == "update") == is_kept
    stages.calls.clear()
    front.process(picture(1), 0.2)
    assert stages.calls[0][0] in ("follow", "search")


def test_only_what_is_seen_now_is_read_and_the_other_hand_shows_nothing(stages):
    stages.tracks = (track(1, "right", RIGHT, missed=1), track(2, "left", LEFT))
    signs = reader(stages).process(picture(), 0.0)
    assert stages.calls[-1] == ("read", [LEFT], (32.0, 5.0))
    assert signs.right is UNSEEN
    assert signs.left.token == "5"


def test_both_hands_that_are_gone_in_their_place_are_shown_and_not_read(stages):
    front = reader(stages)
    front.process(picture(), 0.0)
    stages.tracks = tuple(replace(one, missed=1) for one in stages.tracks)
    signs = front.process(picture(1), 0.1)
    assert (signs.left, signs.right) == (HIDDEN, HIDDEN)
    assert (HIDDEN.token, HIDDEN.seen, HIDDEN.reason) == (None, True, "occluded")


def test_another_stream_begins_without_what_was_found_in_this_one(stages):
    front = reader(stages)
    assert not front.is_searched
    front.process(picture(), 0.0)
    other = front.for_stream()
    assert not other.is_searched
    assert front.shown()["hands"]
    assert other.shown()["hands"] == ()
    assert list(other.pictures()) == []
    stages.tracks = tuple(replace(one, missed=1) for one in stages.tracks)
    assert other.process(picture(1), 0.1).left is UNSEEN  # it never saw them held


@pytest.mark.parametrize(
    ("options", "box"),
    [
        ({}, (10, 20, 8, 6)),
        ({"mirrored": True}, (46, 20, 8, 6)),
        ({"rotate": 180}, (46, 22, 8, 6)),
        ({"rotate": 180, "mirrored": True}, (10, 22, 8, 6)),
    ],
)
def test_boxes_are_told_in_the_picture_as_it_came(stages, options, box):
    stages.tracks = (track(1, "right", RIGHT),)
    front = reader(stages, **options)
    front.process(picture(), 0.0)
    assert [hand.box for hand in front.shown()["hands"]] == [box]


def test_a_picture_that_lies_on_its_side_is_turned(stages):
    stages.tracks = (track(1, "right", RIGHT),)
    for rotate, box in ((90, (20, 64 - 10 - 8, 6, 8)), (270, (48 - 20 - 6, 10, 6, 8))):
        front = reader(stages, rotate=rotate)
        front.process(np.zeros((64, 48, 3), np.uint8), 0.0)
        assert [hand.box for hand in front.shown()["hands"]] == [box]


@pytest.mark.parametrize("rotate", [45, 1, -90, 360, 91, 181, 271])
def test_other_turns_are_refused(stages, rotate):
    with pytest.raises(ValueError, match=f"rotate is {rotate}; it must be 0, 90, 180 or 270"):
        reader(stages, rotate=rotate)


def test_a_picture_on_its_own_is_searched_and_has_no_tracks(stages):
    front = reader(stages)
    signs = front.recognize(picture())
    assert stages.calls == [("search",), ("read", [RIGHT, LEFT], (32.0, 5.0))]
    assert (signs.left.token, signs.right.token) == ("5", "5")
    assert [name for name, _ in front.pictures()] == ["colour", "regions", "classify"]
    front.process(picture(1), 0.0)
    assert [name for name, _ in front.pictures()] == ["colour", "regions", "tracks", "classify"]
