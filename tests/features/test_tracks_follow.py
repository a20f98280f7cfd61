"""What the tracks foresee, so that a frame need not be searched whole, and when it must be all the same."""

import pytest

from lightgesture.features.track import kalman
from lightgesture.features.track import tracker as tracker_module
from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.tracker import WHOLE_ALONE_S, Tracker

STEP = 1 / 30


@pytest.fixture
def hands(region, frame):
    def make(right=(160, 140), left=(460, 140), together=0.8):
        return frame([region(*right), region(*left)], together)

    return make


def _followed(hands, frames=20, speed=0.0, settings=None):
    tracker = Tracker(settings)
    for index in range(frames):
        tracker.update(hands((160 + speed * index, 140), (460, 140)), index * STEP)
    return tracker, frames * STEP


def test_predictions_lie_where_the_hands_go(hands):
    tracker, now = _followed(hands, speed=4.0)
    right, left = tracker.predict(now)
    assert right == pytest.approx((120 + 4 * 20, 100, 80, 80), abs=2)
    assert left == pytest.approx((420, 100, 80, 80), abs=2)


def test_asking_changes_nothing(hands, frame):
    asked, now = _followed(hands)
    other, _ = _followed(hands)
    for _ in range(5):
        asked.predict(now + 0.1)
        asked.explains(frame([]))
        asked.predict(now)
        asked.explains(hands())
    shown = hands((165, 141), (455, 139))
    assert asked.update(shown, now) == other.update(shown, now)


def test_nothing_is_foreseen_without_hands_or_where_one_was_missed(hands, region, frame):
    assert Tracker().predict(0.0) == ()
    tracker, now = _followed(hands)
    tracker.update(frame([region(160, 140)]), now)
    assert tracker.predict(now + STEP) == ()


def test_nothing_is_foreseen_while_another_region_is_under_observation(hands, region, frame):
    tracker, now = _followed(hands)
    others = [region(160, 140), region(460, 140), region(220, 380), region(420, 380)]
    tracker.update(frame(others, {(0, 1): 0.6, (2, 3): 0.99}), now)
    assert tracker.predict(now + STEP) == ()


@pytest.mark.parametrize("whole_s", [0.2, TrackSettings().whole_s])
def test_a_whole_search_is_due_after_a_while_so_that_a_wrong_lock_is_found_out(hands, whole_s):
    tracker, now = _followed(hands, settings=TrackSettings(whole_s=whole_s))
    searched = now - STEP
    while tracker.predict(now):
        tracker.update(hands(), now, False)
        now += STEP
    assert now - searched == pytest.approx(whole_s, abs=1.5 * STEP)
    tracker.update(hands(), now)
    assert len(tracker.predict(now + STEP)) == 2


def test_a_lone_hand_is_searched_whole_more_often(region, frame):
    tracker = Tracker()
    alone = frame([region(160, 140, score=0.9)])
    for index in range(20):
        tracker.update(alone, index * STEP)
    assert len(tracker.predict(20 * STEP)) == 1
    assert tracker.predict(19 * STEP + WHOLE_ALONE_S + STEP) == ()


def test_regions_explain_the_tracks_only_where_every_hand_finds_its_own(hands, region, frame):
    tracker, now = _followed(hands)
    assert not tracker.explains(hands())  # Nothing was predicted.
    tracker.predict(now)
    assert tracker.explains(hands((164, 142), (455, 140)))
    assert not tracker.explains(frame([region(160, 140)]))
    assert not tracker.explains(frame([region(160, 140), region(300, 400)], 0.25))
    assert not tracker.explains(frame([]))
    assert not tracker.explains(frame([region(160, 140), region(460, 140)], 0.8, size=(320, 240)))
    tracker.predict(now + 5.0)
    assert not tracker.explains(hands())


def test_a_hand_that_moved_on_is_searched_for(hands):
    tracker, now = _followed(hands)
    tracker.predict(now)
    assert tracker.explains(hands((170, 140), (460, 140)))
    # Inside the gate, so that it is the track's own; but its box was seen through a window beside it.
    assert not tracker.explains(hands((190, 140), (460, 140)))


@pytest.fixture
def work(monkeypatch):
    """Counts predictions of a coordinate, of which a hand has four, and matchings of a frame."""
    counts = {"predictions": 0, "matchings": 0}

    def counted(name, function):
        def call(*arguments):
            counts[name] += 1
            return function(*arguments)

        return call

    monkeypatch.setattr(kalman, "predict", counted("predictions", kalman.predict))
    matching = counted("matchings", tracker_module.match_tracks)
    monkeypatch.setattr(tracker_module, "match_tracks", matching)
    return counts


def _done(work, *steps):
    """What the steps took: (predictions, matchings)."""
    work.update(predictions=0, matchings=0)
    for step in steps:
        step()
    return work["predictions"], work["matchings"]


def test_a_steady_frame_predicts_each_hand_once_and_matches_once(hands, work):
    tracker, now = _followed(hands)
    shown = hands((161, 140))
    ask = [lambda: tracker.predict(now), lambda: tracker.explains(shown)]
    assert _done(work, *ask, *ask, lambda: tracker.update(shown, now, False)) == (8, 1)


def test_an_update_alone_predicts_and_matches_for_itself(hands, work):
    tracker, now = _followed(hands)
    assert _done(work, lambda: tracker.update(hands(), now)) == (8, 1)
    assert _done(
        work, lambda: tracker.predict(now + STEP), lambda: tracker.update(hands(), now + 2 * STEP)
    ) == (
        16,
        1,
    )


def test_a_frame_that_is_searched_whole_after_all_is_matched_once_more(hands, region, frame, work):
    tracker, now = _followed(hands)
    looked, searched = frame([region(160, 140)]), hands()
    steps = [
        lambda: tracker.predict(now),
        lambda: tracker.explains(looked),
        lambda: tracker.update(searched, now),
    ]
    assert _done(work, *steps) == (8, 2)


@pytest.mark.parametrize("now", [float("nan"), -3.0, 0.0])
def test_time_that_cannot_be_is_predicted_once_as_well(hands, work, now):
    tracker, _ = _followed(hands)
    shown = hands()
    steps = [
        lambda: tracker.predict(now),
        lambda: tracker.explains(shown),
        lambda: tracker.update(shown, now, False),
    ]
    assert _done(work, *steps) == (8, 1)
