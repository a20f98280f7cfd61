"""The service and its configuration, as they lie in `deploy/`."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from lightgesture.cli import Parser
from lightgesture.config.declaring import LIVE
from lightgesture.config.options import add_options, read_config

DEPLOY = Path(__file__).resolve().parents[2] / "deploy"
UNIT = DEPLOY / "lightgesture.service"
CONFIG = DEPLOY / "lightgesture.toml"


def lines_of(section):
    """The (key, value) pairs of a section; a key may come more than once."""
    text = UNIT.read_text("utf-8").partition(f"[{section}]\n")[2].partition("\n[")[0]
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return [tuple(line.split("=", 1)) for line in lines]


def test_the_configuration_is_valid_and_keeps_to_this_machine():
    options = read_config(str(CONFIG))
    assert options["web"] == 8080
    assert "web_host" not in options
    assert not {"mavlink", "mavlink_map", "hook"} & options.keys()


def test_the_service_gives_options_that_live_has():
    (command,) = [value for key, value in lines_of("Service") if key == "ExecStart"]
    words = command.split()
    assert words[1:3] == ["live", "${LIGHTGESTURE_SOURCE}"]
    parser = Parser()
    add_options(parser, LIVE)
    assert parser.parse_args(words[3:]).config == "/etc/lightgesture/lightgesture.toml"


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("DynamicUser", "yes"),
        ("Restart", "on-failure"),
        ("SupplementaryGroups", "video"),
        ("DeviceAllow", "char-video4linux rw"),
        ("ProtectSystem", "strict"),
        ("CapabilityBoundingSet", ""),
        ("MemoryMax", "384M"),
    ],
)
def test_limits_and_rights(key, value):
    assert (key, value) in lines_of("Service")


def test_the_processor_can_be_read():
    assert "ProcSubset" not in dict(lines_of("Service"))


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="no systemd on this machine")
def test_systemd_takes_the_unit(tmp_path):
    unit = tmp_path / UNIT.name
    program = "/opt/lightgesture/bin/lightgesture"
    unit.write_text(UNIT.read_text("utf-8").replace(program, shutil.which("true") or "/bin/true"))
    done = subprocess.run(["systemd-analyze", "verify", unit], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd-analyze is not installed")
def test_systemd_finds_little_that_is_exposed():
    words = ["systemd-analyze", "security", "--offline=true", "--no-pager", "--threshold=20", str(UNIT)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    level = re.search(r"Overall exposure level for lightgesture\.service: ([0-9.]+)", done.stdout)
    assert level is not None, done.stderr
    assert float(level[1]) <= 2.0
    assert done.returncode == 0
