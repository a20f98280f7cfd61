"""What is mutated, and by which tests each part is held."""

from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True, slots=True)
class Group:
    """Modules, and the files or folders of the tests that hold them.

    unfit: names of tests, as -k of pytest has them, that look at the clock or at other processes.
    """

    modules: tuple[str, ...]
    tests: tuple[str, ...]
    unfit: str = ""


def _modules(folder: str, package: str, *without: str) -> tuple[str, ...]:
    names = sorted(file.stem for file in (ROOT / folder).glob("*.py"))
    return tuple(f"lightgesture.{package}.{name}" for name in names if name not in ("__init__", *without))


LINK = (
    "mavlink_missions",
    "mavlink_modes",
    "mavlink_parameters",
    "mavlink_pilot",
    "mavlink_state",
    "mavlink_vehicle",
)
"""The MAVLink half of the vehicle, whose tests take the time of its time-outs."""
PROCESSES = ("runner", "watchdog", "watchdog_process")
"""A thread and a process of its own, in which an exchange of code does not arrive; slow tests hold them."""
IN_TIME = "bounded_time or refused_at_once or import_is_light"

VEHICLE_TESTS = (
    *("executor", "executor_ends", "executor_pictures", "guard", "intake"),
    *("nods", "pilot", "profile", "step_parameters", "step_pictures"),
)
"""What is tried on the executor, by the ends of the modules' names."""
GROUPS: dict[str, Group] = {
    "fsm": Group(_modules("fsm", "fsm"), ("tests/fsm",), IN_TIME),
    "language": Group(_modules("fsm/language", "fsm.language"), ("tests/fsm",), IN_TIME),
    "rules": Group(_modules("fsm/rules", "fsm.rules"), ("tests/fsm",), IN_TIME),
    "tracker": Group(
        _modules("features/track", "features.track"),
        (
            "tests/features/test_kalman.py",
            "tests/features/test_follow.py",
            *(
                f"tests/features/{file.name}"
                for file in sorted((ROOT / "tests/features").glob("test_track*.py"))
            ),
        ),
    ),
    "reading": Group(
        _modules("lightgesture/hands", "hands", "pictures"),  # which are for looking at
        (
            "tests/app/test_front_end.py",
            "tests/app/test_halves.py",
            "tests/app/test_hand_reader.py",
            "tests/app/test_hidden_hands.py",
            "tests/app/test_pipeline.py",
            "tests/app/test_reading_bounds.py",
            "tests/app/test_reading_memory.py",
            "tests/app/test_standing_readings.py",
        ),
    ),
    "executor": Group(
        _modules("lightgesture/vehicle", "vehicle", *LINK, *PROCESSES),
        tuple(f"tests/app/vehicle/test_{name}.py" for name in VEHICLE_TESTS),
    ),
    "link": Group(tuple(f"lightgesture.vehicle.{name}" for name in LINK), ("tests/app/vehicle",)),
}
