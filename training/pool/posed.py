"""Rendered hands in the poses of real ones, turned away from the camera as far as their signs can be told.

Pictures of hands show each sign from the front, where it is easiest to label. A real hand's joints, posed anew, show it
from every side, and as crooked, with fingers as close, as people make it.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from lightgesture.synth.crops import CropMaker, CropSettings
from lightgesture.synth.poses import bring_together, with_hidden_bends
from lightgesture.synth.skeleton import HandPose
from lightgesture.synth.views import PosedHand, turned_away
from lightgesture.training.pictures.augment import shifted_box
from lightgesture.training.pool.altered import behind
from lightgesture.training.pool.diver_kinds import DiveLooks
from lightgesture.training.pool.joints import Poses
from lightgesture.training.pool.kept_hands import kept_out
from lightgesture.training.pool.originals import Originals, PoolSettings
from lightgesture.training.samples import TrainingSample

Random = np.random.Generator

POSED_SOURCES: Final = 80
"""Names over which posed hands are spread: weights treat them as so many people."""
POSED_SOURCE: Final = "posed"
"""Beginning of these names."""
NOISE_DEG: Final = 3.0
"""Standard deviation of what is added to each angle: detectors err by more, people repeat themselves by less."""
TOGETHER: Final = 0.2
"""Share of hands whose stretched fingers are laid side by side, beside those that held them so."""
BACKS: Final = 0.12
"""Share of hands that are turned round, whose back is seen where the palm was."""
DIVES: Final = 0.5
"""Share of hands that look as on a real dive, where divers are given."""
ELSEWHERE: Final = 0.5
"""Share of hands before a picture of a real place, the others before a rendered one."""
ARM_DEG: Final = np.array([12.0, 7.0])
"""Standard deviations of the wrist's flexion and deviation, which the 21 joints do not tell."""
ARM_MEAN_DEG: Final = np.array([-4.0, -2.0])
"""Their means, as of other rendered hands."""
TRIES: Final = 10
"""Poses that are tried for a hand."""
CROPS: Final = CropSettings(backdrops=3, atlases=6)
"""Every task draws anew what its hands share."""


def posed(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    """Posed hands, the classes in turn. No pose of a hand that is kept from the net is used."""
    poses = originals.poses
    poses = poses.chosen(~kept_out(originals.hands)[poses.hands])
    if not len(poses):
        return
    maker = CropMaker(int(random.integers(2**31)), "train", CROPS)
    places, looks = behind(originals), DiveLooks.of(originals.divers)
    for number in range(first, last):
        hand = draw_posed(poses, number, random)
        if hand is None:
            continue
        is_dive = len(looks) > 0 and random.random() < DIVES
        is_elsewhere = len(places) > 0 and random.random() < ELSEWHERE
        place = places[int(random.integers(len(places)))] if is_elsewhere else None
        crop = maker.posed(hand, dry=is_dive, place=place)
        image = crop.image
        if is_dive:
            image = looks.give(image, crop.cover, max(crop.box[2:]), random)
        yield TrainingSample(
            image=image,
            box=shifted_box(crop.box, settings.augment, random),
            # A crop obeys the rule of upright crops: the thumb's direction in the picture names the token.
            side="left",
            token=crop.token,
            source=f"{POSED_SOURCE} {number % POSED_SOURCES}",
            original=False,
            landmarks=crop.landmarks.astype(np.float32),
        )


def draw_posed(poses: Poses, number: int, random: Random) -> PosedHand | None:
    """A hand of the class whose turn it is, posed as one of the real ones, in another view.

    None if none of some poses shows its sign in any view.
    """
    classes = np.unique(poses.tokens)
    rows = np.flatnonzero(poses.tokens == classes[number % len(classes)])
    for _ in range(TRIES):
        hand = _in_another_view(poses, int(rows[int(random.integers(len(rows)))]), random)
        if hand is not None:
            return hand.mirrored() if random.random() < 0.5 else hand
    return None


def _in_another_view(poses: Poses, row: int, random: Random) -> PosedHand | None:
    token = str(poses.tokens[row])
    angles = with_hidden_bends(poses.angles[row], token, random) + random.normal(0.0, NOISE_DEG, (5, 4))
    if random.random() < TOGETHER:
        angles = bring_together(angles, random)
    pose = HandPose(angles, random.normal(ARM_MEAN_DEG, ARM_DEG)).clipped()
    hand = PosedHand(pose, poses.rotations[row], False, token)
    if random.random() < BACKS:
        hand = hand.turned_round()
    return turned_away(hand, random)
