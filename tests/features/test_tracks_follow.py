"""What the tracks foresee, so that a frame need not be searched whole, and when it must be all the same."""

import pytest

from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.tracker import TrackStage

STEP = 1 / 30


@pytest.fixture
def hands(region, frame):
    def make(right=(160, 140), left=(460, 140), together=0.8):
        return frame([region(*right), region(*left)], together)

    return make


def _followed(hands, frames=20, speed=0.0):
    stage = TrackStage()
    for index in range(frames):
        stage.process(hands((160 + speed * index, 140), (460, 140)), index * STEP)
    return stage, frames * STEP


def test_predictions_lie_where_the_hands_go(hands):
    stage, now = _followed(hands, speed=4.0)
    right, left = stage.predictions(now)
    assert right == pytest.approx((120 + 4 * 20, 100, 80, 80), abs=2)
    assert left == pytest.approx((420, 100, 80, 80), abs=2)


def test_asking_changes_nothing(hands, frame):
    asked, now = _followed(hands)
    other, _ = _followed(hands)
    for _ in range(5):
        asked.predictions(now + 0.1)
        asked.explains(frame([]), now + 0.2)
        asked.explains(hands(), now)
    shown = hands((165, 141), (455, 139))
    assert asked.process(shown, now) == other.process(shown, now)


def test_nothing_is_foreseen_without_hands_or_where_one_was_missed(hands, region, frame):
    assert TrackStage().predictions(0.0) == ()
    stage, now = _followed(hands)
    stage.process(frame([region(160, 140)]), now)
    assert stage.predictions(now + STEP) == ()


def test_nothing_is_foreseen_while_another_region_is_under_observation(hands, region, frame):
    stage, now = _followed(hands)
    others = [region(160, 140), region(460, 140), region(220, 380), region(420, 380)]
    stage.process(frame(others, {(0, 1): 0.6, (2, 3): 0.99}), now)
    assert stage.predictions(now + STEP) == ()


def test_a_whole_search_is_due_after_a_while_so_that_a_wrong_lock_is_found_out(hands):
    stage, now = _followed(hands)
    searched = now - STEP
    while stage.predictions(now):
        stage.process(hands(), now, whole=False)
        now += STEP
    assert now - searched == pytest.approx(TrackSettings().whole_s, abs=1.5 * STEP)
    stage.process(hands(), now, whole=True)
    assert len(stage.predictions(now + STEP)) == 2


def test_a_lone_hand_is_searched_whole_more_often(region, frame):
    stage = TrackStage()
    alone = frame([region(160, 140, score=0.9)])
    for index in range(20):
        stage.process(alone, index * STEP)
    assert len(stage.predictions(20 * STEP)) == 1
    assert stage.predictions(19 * STEP + TrackSettings().whole_alone_s + STEP) == ()


def test_regions_explain_the_tracks_only_where_every_hand_finds_its_own(hands, region, frame):
    stage, now = _followed(hands)
    assert stage.explains(hands((164, 142), (455, 140)), now)
    assert not stage.explains(frame([region(160, 140)]), now)
    assert not stage.explains(frame([region(160, 140), region(300, 400)], 0.25), now)
    assert not stage.explains(frame([]), now)
    assert not stage.explains(frame([region(160, 140), region(460, 140)], 0.8, size=(320, 240)), now)
    assert not stage.explains(hands(), now + 5.0)


def test_a_hand_that_moved_on_is_searched_for(hands):
    stage, now = _followed(hands)
    assert stage.explains(hands((170, 140), (460, 140)), now)
    # Inside the gate, so that it is the track's own; but its box was seen through a window beside it.
    assert not stage.explains(hands((190, 140), (460, 140)), now)
