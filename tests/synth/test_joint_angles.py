"""Joint angles come back from joints, and turned hands still show their sign."""

import numpy as np
import pytest

from lightgesture.synth.joint_angles import fit_hands
from lightgesture.synth.poses import OTHER_SHAPES, TOKENS, agrees, token_pose, with_hidden_bends
from lightgesture.synth.skeleton import (
    HandPose,
    pose_skeleton,
    rotation_x,
    rotation_y,
    rotation_z,
    sample_proportions,
)
from lightgesture.synth.views import LARGEST_TURN_DEG, PosedHand, can_be_told, turned_away


def posed(count):
    rng = np.random.default_rng(0)
    poses = [token_pose(name, rng) for name in (*TOKENS, *OTHER_SHAPES) for _ in range(count)]
    turns = [
        rotation_z(rng.uniform(-180, 180))
        @ rotation_x(rng.uniform(-90, 90))
        @ rotation_y(rng.uniform(-90, 90))
        for _ in poses
    ]
    return poses, np.array(turns)


def test_angles_and_turns_come_back_from_the_joints():
    poses, turns = posed(4)
    joints = np.array([pose_skeleton(pose).points for pose in poses])
    fitted = fit_hands(0.001 * np.einsum("nij,nkj->nki", turns, joints) + [0.1, -0.3, 0.5])
    np.testing.assert_allclose(fitted.angles, [pose.angles for pose in poses], atol=0.1)
    np.testing.assert_allclose(fitted.rotations, turns, atol=1e-6)
    np.testing.assert_allclose(fitted.scales, 0.001, rtol=1e-6)
    np.testing.assert_allclose(fitted.wrists, np.tile([0.1, -0.3, 0.5], (len(poses), 1)), atol=1e-6)


def test_another_persons_fingers_come_back_nearly():
    rng = np.random.default_rng(3)
    poses, _ = posed(4)
    joints = np.array([pose_skeleton(pose, sample_proportions(rng)).points for pose in poses])
    errors = np.abs(fit_hands(joints).angles[:, 1:] - [pose.angles[1:] for pose in poses])
    assert errors.mean() < 2.0
    assert errors.max() < 12.0


def test_wrong_shapes_are_refused_and_no_angle_leaves_its_range():
    with pytest.raises(ValueError, match="21, 3"):
        fit_hands(np.zeros((21, 3)))
    angles = fit_hands(np.random.default_rng(0).normal(size=(50, 21, 3))).angles
    for one in angles:
        np.testing.assert_array_equal(HandPose(one, np.zeros(2)).clipped().angles, one)
    assert fit_hands(np.zeros((0, 21, 3))).angles.shape == (0, 5, 4)


def test_hidden_joints_are_moved_towards_the_sign():
    rng = np.random.default_rng(1)
    fist = token_pose("0", rng, 0.0).angles
    half_open = fist.copy()
    half_open[1:, :3] *= 0.6
    mended = with_hidden_bends(half_open, "0", rng)
    assert (mended[1:, 2] > half_open[1:, 2]).all()
    assert (mended[1:, 2] < fist[1:, 2]).all()
    np.testing.assert_array_equal(with_hidden_bends(half_open, "none", rng), half_open)
    # A stretched finger and a free thumb are as measured.
    pointing = token_pose("pic", rng).angles
    np.testing.assert_array_equal(with_hidden_bends(pointing, "pic", rng)[:2], pointing[:2])


def test_angles_agree_with_their_own_sign_alone():
    rng = np.random.default_rng(2)
    for token in ("0", "1", "2", "3", "4"):
        angles = token_pose(token, rng).angles
        assert [name for name in ("0", "1", "2", "3", "4") if agrees(angles, name)] == [token]
    assert agrees(token_pose("claw", rng).angles, "none")


@pytest.mark.parametrize("token", TOKENS)
def test_turned_hands_go_far_and_still_show_their_sign(token):
    rng = np.random.default_rng(5)
    hand = PosedHand(token_pose(token, rng), np.eye(3), token == "left", token)
    views = [turned_away(hand, rng) for _ in range(60)]
    assert sum(view is None for view in views) < 6
    views = [view for view in views if view is not None]
    turns = [view.turn_deg() for view in views]
    assert max(turns) <= LARGEST_TURN_DEG
    assert np.percentile(turns, 80) > 25.0
    assert all(can_be_told(view) for view in views)


def test_a_view_from_the_edge_tells_no_number():
    pose = token_pose("2", np.random.default_rng(0), 0.0)
    pose.angles[1:3, [0, 2, 3]] = 0.0
    hand = PosedHand(pose, np.eye(3), False, "2")
    assert can_be_told(hand)
    assert not can_be_told(hand.turned(rotation_y(88.0)))
    assert not can_be_told(hand.turned(rotation_x(80.0)))


def test_a_hand_that_hides_its_thumb_has_no_view():
    rng = np.random.default_rng(0)
    hidden = PosedHand(token_pose("0", rng, 0.0), np.eye(3), False, "left")
    assert turned_away(hidden, rng, 20.0) is None


def test_a_mirror_and_half_a_turn_exchange_left_and_right():
    # An upright right hand with its palm to the camera has the thumb on image right.
    hand = PosedHand(token_pose("right", np.random.default_rng(0), 0.0), np.eye(3), False, "right")
    assert can_be_told(hand)
    assert not can_be_told(PosedHand(hand.pose, hand.rotation, False, "left"))
    for other in (hand.mirrored(), hand.turned_round()):
        assert other.token == "left"
        assert can_be_told(other)
    assert hand.mirrored().left
    assert hand.mirrored().mirrored().token == "right"
