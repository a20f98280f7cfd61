"""The extension of BlueOS, without Docker: its labels, its start script, its configuration."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from lightgesture._version import __version__
from lightgesture.cli import Parser
from lightgesture.config.declaring import LIVE
from lightgesture.config.options import add_options, read_config
from lightgesture.sinks.mavlink_link import Link

FOLDER = Path(__file__).resolve().parents[2] / "deploy" / "blueos"
DOCKERFILE = FOLDER / "Dockerfile"


def instructions():
    """Of the container file: (word, rest), lines that go on joined, as Docker joins them."""
    text = re.sub(r"^\s*#.*\n", "", DOCKERFILE.read_text("utf-8"), flags=re.MULTILINE)
    lines = text.replace("\\\n", "").splitlines()
    return [tuple(line.split(None, 1)) for line in lines if line.strip()]


def labels():
    found = {}
    for word, rest in instructions():
        if word == "LABEL":
            name, _, value = rest.partition("=")
            # Docker takes quotes as a shell does.
            done = subprocess.run(
                ["sh", "-c", f"printf %s {value}"], capture_output=True, text=True, check=True
            )
            found[name] = done.stdout
    return found


def test_the_labels_are_those_of_an_extension():
    found = labels()
    assert found["version"] == __version__
    for name, kind in {
        "permissions": dict,
        "authors": list,
        "company": dict,
        "links": dict,
        "tags": list,
    }.items():
        assert isinstance(json.loads(found[name]), kind), name
    assert found["type"] in ("device-integration", "example", "theme", "tool", "education", "other")
    assert {"readme", "requirements"} < set(found)


def test_the_permissions_are_no_more_than_it_needs():
    permissions = json.loads(labels()["permissions"])
    host = permissions["HostConfig"]
    assert set(host["PortBindings"]) == set(permissions["ExposedPorts"]) == {"8080/tcp", "5600/udp"}
    assert [bind.rpartition(":")[2] for bind in host["Binds"]] == ["/data"]
    assert not {"Privileged", "Devices", "CapAdd", "NetworkMode", "PidMode"} & set(host)
    assert "docker.sock" not in json.dumps(permissions)
    exposed = next(rest for word, rest in instructions() if word == "EXPOSE")
    assert set(exposed.split()) == set(permissions["ExposedPorts"])


def test_what_is_copied_is_there():
    root = DOCKERFILE.parents[2]
    copies = [rest.split()[:-1] for word, rest in instructions() if word == "COPY" and "--from" not in rest]
    assert copies
    assert [path for paths in copies for path in paths if not (root / path).exists()] == []


def test_the_configuration_serves_the_page_and_commands_nothing():
    options = read_config(str(FOLDER / "lightgesture.toml"))
    ports = json.loads(labels()["permissions"])["ExposedPorts"]
    assert f"{options['web']}/tcp" in ports
    assert (options["web_host"], options["web_blueos"]) == ("0.0.0.0", True)
    assert not {"obey", "hook", "mavlink_map"} & options.keys()
    assert Link(options["mavlink"][0]).name


@pytest.fixture
def start(tmp_path):
    """Runs the start script with a program that tells its arguments in the place of ours."""
    program = tmp_path / "bin" / "lightgesture"
    program.parent.mkdir()
    program.write_text('#!/bin/sh\nprintf "%s\\n" "$@"\n')
    program.chmod(0o755)
    data = tmp_path / "data"

    def run():
        path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path, "LIGHTGESTURE_DATA": str(data)}
        return subprocess.run(
            ["sh", str(FOLDER / "start.sh")], env=environment, capture_output=True, text=True, check=False
        )

    return run, data


def test_the_first_start_puts_the_settings_into_the_volume(start):
    run, data = start
    words = run().stdout.split()
    assert words == ["live", "rtp://0.0.0.0:5600", "--config", str(data / "lightgesture.toml")]
    parser = Parser()
    add_options(parser, LIVE)
    assert read_config(parser.parse_args(words[2:]).config)["web"] == 8080


def test_later_starts_leave_them_alone(start):
    run, data = start
    data.mkdir()
    (data / "source").write_text("rtsp://192.168.2.2:8554/video one")
    (data / "lightgesture.toml").write_text("web = 9090\n")
    assert run().stdout.splitlines()[1] == "rtsp://192.168.2.2:8554/video one"
    assert (data / "lightgesture.toml").read_text() == "web = 9090\n"
    (data / "source").write_text("\n")
    done = run()
    assert done.returncode == 2
    assert "source: is empty; write the stream's address" in done.stderr


@pytest.mark.skipif(shutil.which("shellcheck") is None, reason="no shellcheck on this machine")
def test_the_start_script_has_no_traps():
    done = subprocess.run(["shellcheck", FOLDER / "start.sh"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "")
