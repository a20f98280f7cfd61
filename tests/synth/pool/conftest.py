"""A simulated vehicle and somebody who talks to it, without a network and faster than time."""

from importlib.util import find_spec

import pytest
from pymavlink.dialects.v20 import common


class Talk:
    """A ground station (`pilot`, system 255) and a companion (`companion`) of a vehicle; `heard`: what it sent."""

    def __init__(self, **options):
        if find_spec("mujoco") is None:
            pytest.skip("needs lightgesture[sim]")
        from lightgesture.synth.pool.vehicle import Vehicle

        self.sent = []
        self.vehicle = Vehicle(self.sent.append, **options)
        self.parser = common.MAVLink(None)
        self.pilot, self.companion = self.voice(255, 190), self.voice(options.get("system", 1), 191)
        self.heard = []

    def voice(self, system, component):
        return common.MAVLink(self, system, component)

    def write(self, content):
        self.vehicle.front.receive(bytes(content), self.vehicle.body.time_s)

    def run(self, seconds, sticks=None, each_s=0.1, voice=None):
        """Let time pass, with the sticks (x, y, z, r of MANUAL_CONTROL) held."""
        until_s = self.vehicle.body.time_s + seconds
        while self.vehicle.body.time_s < until_s - 1e-3:
            if sticks is not None:
                (voice or self.pilot).manual_control_send(self.vehicle.front.system, *sticks, 0)
            self.vehicle.advance(min(self.vehicle.body.time_s + each_s, until_s))
        return self.vehicle.motion

    def messages(self, kind):
        """What it sent of a kind since the last call, oldest first; the rest stays."""
        for content in self.sent:
            self.heard += self.parser.parse_buffer(bytes(content)) or []
        self.sent.clear()
        found = [message for message in self.heard if message.get_type() == kind]
        self.heard = [message for message in self.heard if message.get_type() != kind]
        return found

    def command(self, number, *params, component=1, voice=None):
        """Send a command; the result that was acknowledged."""
        (voice or self.companion).command_long_send(
            self.vehicle.front.system, component, number, 0, *params, *[0] * (7 - len(params))
        )
        (answer,) = self.messages("COMMAND_ACK")
        assert answer.command == number
        return answer.result


@pytest.fixture
def talk():
    """Makes a vehicle, by default armed and holding its depth."""

    def make(mode=2, **options):
        one = Talk(**options)
        one.vehicle.pilot.arm(mode is not None)
        if mode is not None:
            assert one.vehicle.pilot.set_mode(mode)
        return one

    return make
