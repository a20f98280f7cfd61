"""Two tracks followed through scripted candidates: births, changes of shape, wrong locks, loss and return."""

import pytest

from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.tracker import Tracker

STEP = 1 / 30


@pytest.fixture
def hands(region, frame):
    """Candidates of two hands, the diver's right one at image left."""

    def make(right=(160, 140), left=(460, 140), together=0.8, **size):
        return frame([region(*right, **size), region(*left, **size)], together)

    return make


def _play(tracker, frames, start=0.0, step=STEP):
    """The tracks of each frame."""
    return [tracker.update(candidates, start + index * step) for index, candidates in enumerate(frames)]


def _numbers(tracks):
    return {track.side: track.number for track in tracks}


def test_a_pair_that_scores_very_well_is_followed_at_once_with_the_right_hand_at_image_left(hands, sides):
    tracks = Tracker().update(hands(), 0.0)
    assert sides(tracks) == {"right": 160, "left": 460}
    assert [track.certainty for track in tracks] == [1.0, 1.0]


def test_a_pair_that_scores_fairly_is_followed_once_it_was_seen_for_a_while(hands):
    counts = [len(tracks) for tracks in _play(Tracker(), [hands(together=0.3)] * 5)]
    assert counts == [0, 0, 2, 2, 2]


def test_a_pair_below_the_threshold_is_never_followed(hands):
    weak = hands(together=0.15, score=0.45)
    assert all(tracks == () for tracks in _play(Tracker(), [weak] * 60))


def test_a_pair_that_scores_well_now_and_then_is_not_followed(hands, frame):
    flicker = [hands(together=0.3, score=0.4) if index % 6 == 0 else frame([]) for index in range(60)]
    assert all(tracks == () for tracks in _play(Tracker(), flicker))


def test_a_region_alone_needs_repeated_evidence(region, frame):
    counts = [len(tracks) for tracks in _play(Tracker(), [frame([region(140, 140, score=0.9)])] * 8)]
    assert counts == [0, 0, 1, 1, 1, 1, 1, 1]


def test_a_region_that_jumps_about_is_no_repeated_evidence(region, frame):
    places = [50, 400, 250, 600, 130, 480] * 4
    shown = [frame([region(x, 140, score=0.9)]) for x in places]
    assert all(tracks == () for tracks in _play(Tracker(), shown))


def test_a_red_object_that_seldom_looks_like_a_hand_is_never_followed(region, frame):
    shown = [frame([region(500, 400, score=0.6 if index % 3 == 0 else 0.3)]) for index in range(90)]
    assert all(tracks == () for tracks in _play(Tracker(), shown))


def test_a_red_object_beside_the_diver_is_not_taken_for_a_hand(region, frame, sides):
    red = region(560, 400, score=0.95)
    shown = [
        frame(
            [red, region(160 + index, 140, score=0.5), region(400, 150 - index, score=0.5)],
            {(1, 2): 0.7, (0, 1): 0.35, (0, 2): 0.35},
        )
        for index in range(60)
    ]
    for index, tracks in enumerate(_play(Tracker(), shown)):
        assert sides(tracks) == {"right": 160 + index, "left": 400}


def test_hands_replace_a_red_object_that_was_followed_before_they_came(region, frame, sides):
    tracker = Tracker()
    red = region(560, 400, score=0.9)
    before = _play(tracker, [frame([red])] * 60)
    assert [track.box[0] for track in before[-1]] == [520]
    both = frame([red, region(160, 140), region(400, 150)], {(1, 2): 0.7, (0, 1): 0.3, (0, 2): 0.3})
    after = _play(tracker, [both] * 10, start=2.0)
    assert all(sides(tracks) == {"right": 160, "left": 400} for tracks in after[1:])


def test_the_partner_of_a_hand_replaces_a_red_object_and_puts_the_side_right(region, frame, sides):
    tracker = Tracker()
    red, hand = region(560, 200, score=0.6), region(400, 150)
    wrong = _play(tracker, [frame([red, hand], 0.4)] * 8)
    assert sides(wrong[-1]) == {"right": 400, "left": 560}
    right = frame([red, hand, region(160, 140)], {(0, 1): 0.4, (1, 2): 0.85, (0, 2): 0.3})
    after = _play(tracker, [right] * 10, start=8 * STEP)
    assert sides(after[-1]) == {"right": 160, "left": 400}
    # The hand itself was followed all along.
    assert _numbers(after[-1])["left"] == _numbers(wrong[-1])["right"]


def test_a_clearly_better_pair_elsewhere_replaces_what_was_locked(region, frame, sides):
    tracker = Tracker()
    regions = [region(60, 400), region(580, 410), region(240, 140), region(440, 140)]
    _play(tracker, [frame(regions[:2], 0.55)] * 30)
    tracks = tracker.update(frame(regions, {(0, 1): 0.55, (2, 3): 0.95}), 30 * STEP)
    assert sides(tracks) == {"right": 240, "left": 440}


def test_a_second_pair_about_as_good_such_as_a_mirror_image_does_not_take_turns(region, frame):
    tracker = Tracker()
    regions = [region(200, 300), region(440, 300), region(200, 160), region(440, 160)]
    shown = [frame(regions[:2], 0.7)] * 5
    shown += [
        frame(regions, {(0, 1): 0.6 + 0.1 * (index % 2), (2, 3): 0.75 - 0.1 * (index % 2)})
        for index in range(90)
    ]
    played = _play(tracker, shown)
    assert {track.number for tracks in played for track in tracks} == {1, 2}
    assert all(track.box[1] == 260 for tracks in played for track in tracks)


def test_memory_keeps_a_pair_whose_score_dips(hands):
    tracker = Tracker()
    _play(tracker, [hands()] * 30)
    dipped = _play(tracker, [hands(together=0.1, score=0.3)] * 20, start=1.0)
    assert all([track.missed for track in tracks] == [0, 0] for tracks in dipped)


def test_what_is_never_again_believed_is_not_followed_for_long(hands):
    tracker = Tracker()
    _play(tracker, [hands()] * 90)
    doubted = _play(tracker, [hands(together=0.1, score=0.3)] * 90, start=3.0)
    assert len(doubted[40]) == 2
    assert doubted[50:] == [()] * 40


@pytest.mark.parametrize("change", [(60, 60, 0, 0), (90, 140, 8, -20), (50, 120, -6, 12), (120, 90, 10, 0)])
def test_a_new_sign_changes_the_box_and_not_the_track(region, frame, change):
    width, height, right, down = change
    tracker = Tracker()
    fist = frame([region(160, 140, 70), region(460, 140, 70)], 0.7)
    spread = frame(
        [region(160 + right, 140 + down, width, height), region(460 - right, 140 + down, width, height)], 0.7
    )
    played = _play(tracker, ([fist] * 12 + [spread] * 12) * 3)
    assert all(_numbers(tracks) == {"right": 1, "left": 2} for tracks in played)
    assert all(track.missed == 0 for tracks in played for track in tracks)


def test_the_forearm_that_comes_and_goes_does_not_break_the_track(region, frame):
    tracker = Tracker()
    shown = []
    for index in range(90):
        with_arm = index % 5 < 2
        right = region(160, 180 if with_arm else 140, 70, 160 if with_arm else 80)
        left = region(460, 140, 70, 80, alternatives=((425, 100, 70, 160),))
        shown.append(frame([right, left], 0.7))
    played = _play(tracker, shown)
    assert all(_numbers(tracks) == {"right": 1, "left": 2} for tracks in played)


def test_both_hands_may_leap_to_the_next_sign_as_a_verified_pair(hands, sides):
    tracker = Tracker()
    _play(tracker, [hands()] * 10)
    tracks = tracker.update(hands((200, 210), (420, 215), width=120), 10 * STEP)
    assert sides(tracks) == {"right": 200, "left": 420}
    assert _numbers(tracks) == {"right": 1, "left": 2}


def test_a_track_bridges_missed_frames_as_a_prediction(hands, frame):
    tracker = Tracker()
    _play(tracker, [hands((160 + 4 * index, 140)) for index in range(15)])
    gap = _play(tracker, [frame([])] * 12, start=15 * STEP)
    assert [[track.missed for track in tracks] for tracks in gap] == [[n, n] for n in range(1, 13)]
    assert all(track.alternatives == () for tracks in gap for track in tracks)
    assert 216 <= gap[1][0].box[0] + 40 <= 230
    back = tracker.update(hands((230, 150)), 27 * STEP)
    assert _numbers(back) == {"right": 1, "left": 2}
    assert [track.missed for track in back] == [0, 0]


def test_tracks_end_when_unseen_for_long_and_numbers_go_on(hands, frame):
    tracker = Tracker()
    _play(tracker, [hands()] * 30)
    assert _play(tracker, [frame([])] * 30, start=1.0)[-1] == ()
    assert {track.number for track in tracker.update(hands(), 2.0)} == {3, 4}


def test_one_hand_leaves_for_a_moment_and_returns_with_its_number_and_side(region, frame, hands):
    tracker = Tracker()
    _play(tracker, [hands()] * 30)
    alone = _play(tracker, [frame([region(160, 140)])] * 14, start=1.0)
    assert all(_numbers(tracks) == {"right": 1, "left": 2} for tracks in alone)
    assert alone[-1][1].missed == 14
    back = tracker.update(hands(left=(430, 180)), 44 * STEP)
    assert _numbers(back) == {"right": 1, "left": 2}
    assert [track.missed for track in back] == [0, 0]


def test_one_hand_returns_after_long_to_its_side_even_across_the_other(region, frame, hands, sides):
    tracker = Tracker()
    _play(tracker, [hands()] * 30)
    alone = _play(tracker, [frame([region(160 + 4 * n, 140)]) for n in range(60)], start=1.0)
    assert _numbers(alone[-1]) == {"right": 1}
    # The right hand has wandered over; the left one comes back at image left of it.
    tracks = tracker.update(frame([region(400, 140), region(200, 160)], 0.8), 3.0)
    assert sides(tracks) == {"right": 400, "left": 200}
    assert _numbers(tracks)["right"] == 1


def test_the_output_of_a_frame_of_another_size_starts_anew(hands, frame):
    tracker = Tracker()
    tracker.update(hands(), 0.0)
    assert tracker.update(frame([], size=(320, 240)), STEP) == ()


def test_hands_are_given_up_after_the_time_that_is_set(hands, frame):
    for lost_s in (0.2, 0.6, 1.2):
        tracker = Tracker(TrackSettings(lost_s=lost_s))
        _play(tracker, [hands()] * 60)
        counts = [len(tracks) for tracks in _play(tracker, [frame([])] * 60, start=2.0)]
        assert counts.index(0) * STEP == pytest.approx(lost_s, abs=2 * STEP)


def test_what_is_never_believed_again_is_given_up_after_the_time_that_is_set(hands):
    for doubt_s in (0.5, 1.5):
        tracker = Tracker(TrackSettings(doubt_s=doubt_s))
        _play(tracker, [hands()] * 90)
        weak = [hands(together=0.1, score=0.3)] * 90
        counts = [len(tracks) for tracks in _play(tracker, weak, start=3.0)]
        assert counts.index(0) * STEP == pytest.approx(doubt_s, abs=2 * STEP)


def test_a_wider_gate_follows_a_faster_hand(hands):
    for gate, missed in ((5.0, 1), (30.0, 0)):
        tracker = Tracker(TrackSettings(gate=gate))
        _play(tracker, [hands(together=0.8, score=0.4)] * 10)
        assert tracker.update(hands((195, 140), together=0.1, score=0.4), 10 * STEP)[0].missed == missed


def test_a_smaller_margin_leaves_a_pair_for_one_that_is_a_little_better(region, frame):
    regions = [region(200, 300), region(440, 300), region(200, 140), region(440, 140)]
    for margin, numbers in ((0.05, {3, 4}), (0.15, {1, 2})):
        tracker = Tracker(TrackSettings(margin=margin))
        _play(tracker, [frame(regions[:2], 0.6)] * 30)
        both = _play(tracker, [frame(regions, {(0, 1): 0.6, (2, 3): 0.7})] * 20, start=1.0)
        assert {track.number for track in both[-1]} == numbers
