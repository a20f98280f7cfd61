"""What divers' hands do when they do not sign: wave, point, swim, adjust the mask, hold on, fold the arms.

Positions are those of the left hand in the body frame, millimetres; the right one is mirrored. Turns are yaw, pitch and
roll in degrees, as in `diver.ArmState`.
"""

from __future__ import annotations

from dataclasses import dataclass

Vector = tuple[float, float, float]
NO_SWAY: Vector = (0.0, 0.0, 0.0)
LOWERED_WRIST: Vector = (330.0, -400.0, 120.0)
LOWERED_TURN: Vector = (60.0, 15.0, 150.0)
"""Edge to the camera, fingers down."""


@dataclass(frozen=True, slots=True)
class HandActivity:
    """One hand: `shape` (a token or a name of poses.OTHER_SHAPES) held at `wrist` and `turn`, swaying by `sway` (mm,
    amplitude) at `hz`. token: what a reader of single hands would rightly call it, None for no token.
    """

    shape: str
    wrist: Vector
    turn: Vector
    sway: Vector = NO_SWAY
    hz: float = 1.0
    token: str | None = None


REST = HandActivity("relaxed", LOWERED_WRIST, LOWERED_TURN)
ACTIVITIES: dict[str, tuple[HandActivity, HandActivity]] = {
    "rest": (REST, REST),
    "wave": (REST, HandActivity("5", (330.0, 190.0, 180.0), (0.0, 0.0, 0.0), (90.0, 15.0, 0.0), 1.3, "5")),
    "point": (REST, HandActivity("1", (260.0, -20.0, 380.0), (75.0, 65.0, 20.0))),
    "mask": (
        HandActivity("pinch", (75.0, 150.0, 170.0), (60.0, 0.0, 35.0), (6.0, 8.0, 0.0), 0.8),
        HandActivity("pinch", (75.0, 150.0, 170.0), (60.0, 0.0, 35.0), (6.0, 8.0, 0.0), 0.8),
    ),
    "swim": (
        HandActivity("relaxed", (330.0, 0.0, 240.0), (85.0, 30.0, 60.0), (140.0, 40.0, 120.0), 0.5),
        HandActivity("relaxed", (330.0, 0.0, 240.0), (85.0, 30.0, 60.0), (140.0, 40.0, 120.0), 0.5),
    ),
    "grip": (REST, HandActivity("grip", (170.0, -150.0, 260.0), (70.0, 20.0, -60.0))),
    "fold": (
        HandActivity("relaxed", (-120.0, -170.0, 170.0), (120.0, 0.0, -70.0)),
        HandActivity("relaxed", (-120.0, -230.0, 150.0), (120.0, 0.0, -70.0)),
    ),
}
MARK = "~"
"""A script names an activity by this sign and its name, e.g. "~wave"."""
