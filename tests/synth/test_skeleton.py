from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.synth.poses import OTHER_SHAPES, TOKENS, blend_poses, shows_palm, token_pose
from lightgesture.synth.skeleton import (
    ANGLE_LIMITS_MAX,
    ANGLE_LIMITS_MIN,
    MEAN_PROPORTIONS,
    WRIST_LIMITS_MAX,
    WRIST_LIMITS_MIN,
    HandPose,
    pose_skeleton,
    sample_proportions,
)

TIPS = {"thumb": 4, "index": 8, "middle": 12, "ring": 16, "little": 20}
UP = {
    "0": [],
    "1": ["index"],
    "2": ["index", "middle"],
    "3": ["index", "middle", "ring"],
    "4": ["index", "middle", "ring", "little"],
    "5": ["index", "middle", "ring", "little"],
    "left": [],
    "right": [],
    "pic": ["index"],
    "ok": ["middle", "ring", "little"],
}
THUMB_OUT = {"5", "left", "right", "pic"}


def within_limits(pose):
    return (
        np.all(pose.angles >= ANGLE_LIMITS_MIN)
        and np.all(pose.angles <= ANGLE_LIMITS_MAX)
        and np.all(pose.wrist >= WRIST_LIMITS_MIN)
        and np.all(pose.wrist <= WRIST_LIMITS_MAX)
    )


@pytest.mark.parametrize("token", [*TOKENS, *OTHER_SHAPES])
def test_poses_stay_within_the_range_of_the_joints(token):
    rng = np.random.default_rng(5)
    for together in (False, True):
        assert all(within_limits(token_pose(token, rng, 2.0, together=together)) for _ in range(40))


@pytest.mark.parametrize("token", TOKENS)
def test_each_token_stretches_its_fingers_and_no_others(token):
    rng = np.random.default_rng(3)
    for looseness in (0.0, 1.0, 1.0, 1.0):
        points = pose_skeleton(token_pose(token, rng, looseness), sample_proportions(rng)).points
        for finger in ("index", "middle", "ring", "little"):
            tip, knuckle = points[TIPS[finger]], points[TIPS[finger] - 3]
            reach = np.linalg.norm(tip - knuckle)
            length = sum(
                np.linalg.norm(points[TIPS[finger] - i] - points[TIPS[finger] - i - 1]) for i in range(3)
            )
            stretched = tip[1] > knuckle[1] + 0.7 * length and reach > 0.8 * length
            assert stretched == (finger in UP[token]), (token, finger)


@pytest.mark.parametrize("token", TOKENS)
def test_the_thumb_stands_out_only_where_the_token_says_so(token):
    points = pose_skeleton(token_pose(token, np.random.default_rng(0), 0.0)).points
    beyond_index = points[TIPS["thumb"], 0] - points[5, 0]
    assert (beyond_index > 30.0) == (token in THUMB_OUT)


def test_the_ring_of_ok_is_closed():
    rng = np.random.default_rng(1)
    for _ in range(20):
        points = pose_skeleton(token_pose("ok", rng, 0.5)).points
        assert np.linalg.norm(points[TIPS["thumb"]] - points[TIPS["index"]]) < 32.0


def test_bones_keep_their_length_in_every_pose():
    rng = np.random.default_rng(2)
    for token in TOKENS:
        points = pose_skeleton(token_pose(token, rng)).points
        for finger in range(4):
            first = 5 + 4 * finger
            lengths = np.linalg.norm(np.diff(points[first : first + 4], axis=0), axis=1)
            assert lengths == pytest.approx(MEAN_PROPORTIONS.fingers[finger])


angles = st.lists(st.floats(-200.0, 200.0), min_size=22, max_size=22).map(np.array)


@given(angles)
@settings(max_examples=30, deadline=None)
def test_clipping_and_kinematics_hold_for_any_angles(values):
    pose = HandPose(values[:20].reshape(5, 4), values[20:]).clipped()
    assert within_limits(pose)
    skeleton = pose_skeleton(pose)
    assert np.all(np.isfinite(skeleton.points))
    for frame in [*skeleton.frames, skeleton.forearm]:
        assert frame.T @ frame == pytest.approx(np.eye(3), abs=1e-9)
        assert np.linalg.det(frame) == pytest.approx(1.0)


def test_a_passage_begins_and_ends_at_its_signs_and_moves_smoothly():
    rng = np.random.default_rng(4)
    start, end = token_pose("0", rng), token_pose("5", rng)
    way = [pose_skeleton(blend_poses(start, end, part)).points for part in np.linspace(0.0, 1.0, 41)]
    assert way[0] == pytest.approx(pose_skeleton(start).points)
    assert way[-1] == pytest.approx(pose_skeleton(end).points)
    steps = [np.abs(b - a).max() for a, b in pairwise(way)]
    assert max(steps) < 20.0


def test_thumb_direction_chooses_the_face():
    assert shows_palm("left", left_hand=True, thumb_image_left=True)
    assert not shows_palm("right", left_hand=True, thumb_image_left=False)
    assert not shows_palm("left", left_hand=False, thumb_image_left=True)
    with pytest.raises(ValueError, match="5 has no thumb direction"):
        shows_palm("5", left_hand=True, thumb_image_left=True)
