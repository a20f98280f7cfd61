"""The launch file of ROS 2 and its parameters, without ROS."""

import runpy
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import yaml

from lightgesture.cli import COMMANDS
from lightgesture.config.settings import DecodeSettings
from lightgesture.ros.running import parameter_names, settings_with

FOLDER = Path(__file__).resolve().parents[2] / "deploy" / "ros2"


def module(name, **content):
    one = ModuleType(name)
    vars(one).update(content)
    return one


def test_the_launch_file_starts_the_node_with_its_parameters(monkeypatch):
    def keep(*words, **fields):
        return SimpleNamespace(words=words, **fields)

    for one in (
        module("launch", LaunchDescription=list),
        module("launch.actions", DeclareLaunchArgument=keep),
        module("launch.substitutions", LaunchConfiguration=lambda name: f"<{name}>"),
        module("launch_ros"),
        module("launch_ros.actions", Node=keep),
    ):
        monkeypatch.setitem(sys.modules, one.__name__, one)
    *arguments, node = runpy.run_path(str(FOLDER / "node.launch.py"))["generate_launch_description"]()
    assert (node.executable, node.arguments[0] in COMMANDS) == ("lightgesture", True)
    assert dict(node.remappings) == {"image": "<image>", "image/compressed": "<image>"}
    defaults = {argument.words[0]: argument.default_value for argument in arguments}
    assert Path(defaults["params"]) == FOLDER / "node.yaml"


def test_the_parameters_are_options():
    content = yaml.safe_load((FOLDER / "node.yaml").read_text("utf-8"))
    parameters = content["/**"]["ros__parameters"]
    assert parameters.pop("raw") is False
    assert set(parameters) < set(parameter_names())
    assert settings_with(DecodeSettings(), parameters).hold_seconds == 0.5
