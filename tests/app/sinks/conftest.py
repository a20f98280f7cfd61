"""Records to send, and a station that hears them."""

import socket

import pytest
from pymavlink.dialects.v20 import common

from lightgesture.records import HeartbeatRecord
from lightgesture.sinks.mavlink_map import load_map
from tests.makers import hover


@pytest.fixture
def instruction():
    """Makes an instruction; the keywords change its fields."""

    def make(**changes):
        return hover(**{"source": "cam", **changes})

    return make


@pytest.fixture
def heartbeat():
    """Makes a heartbeat with a number that tells it from others."""

    def make(frames=0):
        return HeartbeatRecord(
            source="cam", time_s=1.0, frames=frames, dropped=0, ms_per_frame=0.8, state="idle"
        )

    return make


@pytest.fixture
def station():
    """A ground station on UDP: `address`, and `messages()`, what came."""

    class Station:
        def __init__(self):
            self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.socket.bind(("127.0.0.1", 0))
            self.socket.settimeout(0.2)
            self.link = f"udpout:127.0.0.1:{self.socket.getsockname()[1]}"
            self.parser = common.MAVLink(None)

        def messages(self):
            found = []
            while True:
                try:
                    content = self.socket.recv(65536)
                except TimeoutError:
                    return found
                assert content[0] == 0xFD  # MAVLink 2
                found += self.parser.parse_buffer(content)

    one = Station()
    yield one
    one.socket.close()


@pytest.fixture
def mapping(tmp_path):
    path = tmp_path / "map.toml"
    path.write_text(
        "target_system = 7\ntarget_component = 2\n"
        '[[value]]\naction = "HOVER"\nname = "LG_HOVER"\nvalue = "duration_s"\nmissing = -1\n'
        '[[value]]\naction = "HOVER"\nname = "LG_SURE"\nvalue = "confidence"\nis_float = true\n'
        '[[value]]\naction = "PARAM"\nparameter = 3\nchange = "DECREASE"\nname = "TENLETTERS"\nvalue = 3e9\n'
        '[[command]]\naction = "SNAP"\ncommand = "MAV_CMD_IMAGE_START_CAPTURE"\nparams = [0, 0.5, 1]\n'
        '[[command]]\naction = "EXEC"\ncommand = "MAV_CMD_USER_1"\nparams = ["program", "duration_s"]\n'
    )
    return load_map(str(path))
