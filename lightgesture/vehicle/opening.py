"""From options to an executor that runs on the first link."""

import threading
from collections.abc import Callable

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.sinks.mavlink_link import Link
from lightgesture.sinks.registry import read_map
from lightgesture.vehicle.executor import Executor, Publish
from lightgesture.vehicle.mavlink_vehicle import MavlinkVehicle
from lightgesture.vehicle.profile_file import load_vehicle
from lightgesture.vehicle.runner import Runner


def open_runner(
    settings: DecodeSettings,
    publish: Publish,
    report: Callable[[str], None],
    clock: Callable[[], float],
    ending: threading.Event,
) -> Runner:
    """What `--obey` asks for, not yet started. UsageError: the profile or the link is wrong.

    publish: takes records, from any thread. report: takes lines for the user. clock: seconds since the start.
    ending: set where the program is asked to end.
    """
    assert settings.obey is not None
    if not settings.mavlink:
        raise UsageError("--obey: there is no link to a vehicle; name it by --mavlink")
    profile = load_vehicle(settings.obey)
    vehicle = MavlinkVehicle(
        Link(settings.mavlink[0]),
        profile,
        system=settings.mavlink_system,
        mapping=read_map(settings),
        report=report,
        clock=clock,
    )
    executor = Executor(profile, vehicle, publish, clock)
    return Runner(executor, vehicle, profile, report, clock, ending)
