"""What the tests of faults share: the vehicle's profile, and when its sticks were in their middle."""

import os

NEUTRAL_S = 0.3
"""Within which the sticks must be in their middle, seconds."""

PROFILE = """
name = "Faults"
[modes]
MANUAL = 19
ALT_HOLD = 2
POSHOLD = 16
AUTO = 3
[link]
timeout_s = 1.5
answer_s = 0.1
[stick]
rate_hz = 20
ramp_s = 0.1
neutral_s = 0.4
[safety]
fault_modes = ["POSHOLD", "ALT_HOLD"]
pilot_channels = [3, 4, 5, 6]
[[instruction]]
action = "UP"
steps = [{ mode = ["ALT_HOLD"] }, { stick = { z = 1 }, seconds = 20 }]
[[instruction]]
action = "EXEC"
steps = [{ mission = 0 }]
"""


def first_neutral(autopilot, moment_s):
    sticks = [(at_s, z) for at_s, z, _, one in autopilot.sticks() if one.get_srcComponent() == 191]
    pushed_s = max(at_s for at_s, z in sticks if z != 500)
    return min(
        (at_s for at_s, z in sticks if z == 500 and at_s > max(pushed_s, moment_s - 0.001)), default=None
    )


def is_neutral_after(autopilot, moment_s):
    return first_neutral(autopilot, moment_s) is not None


def note_time(name, seconds):
    """For the table of the documents: LIGHTGESTURE_TIMES names a file that the times are added to."""
    if path := os.environ.get("LIGHTGESTURE_TIMES"):
        with open(path, "a", encoding="utf-8") as file:
            file.write(f"{name}\t{seconds:.3f}\n")
