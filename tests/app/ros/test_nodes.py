"""The nodes with real ROS, if a Python has rclpy (LIGHTGESTURE_ROS2_PYTHON), one rospy (LIGHTGESTURE_ROS1_PYTHON).

The first may be made from the package index: a virtual environment with this package and ros-rclpy, ros-sensor-msgs,
ros-std-msgs, ros-diagnostic-msgs and ros-rmw-fastrtps-cpp; for the listener without ROS also cyclonedds.
"""

import json
import os
import re
import subprocess
from pathlib import Path

import pytest

ROS2, ROS1 = (os.environ.get(f"LIGHTGESTURE_ROS{number}_PYTHON", "") for number in (2, 1))
HERE = Path(__file__).parent
needs_ros2 = pytest.mark.skipif(not ROS2, reason="LIGHTGESTURE_ROS2_PYTHON names no Python with rclpy")
needs_ros1 = pytest.mark.skipif(not ROS1, reason="LIGHTGESTURE_ROS1_PYTHON names no Python with rospy")


def run(python, program, *words, **environment):
    command = [python, *program, *words]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=150, check=False, env={**os.environ, **environment}
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
@needs_ros2
def test_pictures_go_through_the_node_of_ros2():
    program = ("-m", "lightgesture.benchmarks.ros2_latency")
    out = run(ROS2, program, "--seconds", "10", ROS_DOMAIN_ID="91")
    assert "STOP HOVER 50 GO" in out
    decoded = int(re.search(r"decoded (\d+)", out)[1])
    assert decoded > 200


@pytest.mark.slow
@needs_ros2
def test_a_lifecycle_manager_leads_the_node_and_a_listener_without_ros_hears_it():
    said = json.loads(run(ROS2, [str(HERE / "managed_node.py")], ROS_DOMAIN_ID="92"))
    assert said["namespace"] == "/rov/lightgesture"
    assert said["bad parameter"] == "unconfigured"
    assert said["states"] == [
        "inactive",
        "active",
        "inactive",
        "active",
        "inactive",
        "unconfigured",
        "finalized",
    ]
    assert said["texts"] == ["STOP HOVER 50 GO"]
    assert said["heard without ROS"] in (["STOP HOVER 50 GO"], None)
    assert said["status"] == 0


@pytest.mark.slow
@needs_ros1
def test_pictures_go_through_the_node_of_ros1():
    said = json.loads(run(ROS1, [str(HERE / "node_of_ros1.py")]))
    assert said["instruction"]["text"] == said["text"] == "STOP HOVER 50 GO"
    assert (said["action"], said["number"], said["change"]) == ("HOVER", 50, "")
    assert said["instruction"]["frame_id"] == "camera"
    assert said["annotated"] > 30
    assert said["status"] == 0
