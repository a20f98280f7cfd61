"""Leads a node of ROS 2 through its life, and prints as JSON what became of it; run by test_nodes.py with rclpy."""

import json
import subprocess
import sys
import threading
import time
from array import array

import cv2
import rclpy
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CompressedImage
from std_msgs.msg import String

from lightgesture.benchmarks.ros2_latency import frames_of_clip

NAME = "/rov/lightgesture"
STEPS = (
    Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE, Transition.TRANSITION_DEACTIVATE,
    Transition.TRANSITION_ACTIVATE, Transition.TRANSITION_DEACTIVATE, Transition.TRANSITION_CLEANUP,
    Transition.TRANSITION_UNCONFIGURED_SHUTDOWN,
)  # fmt: skip


def listen_without_ros(heard):
    """Take instructions from DDS itself; None where cyclonedds is not installed."""
    try:
        from cyclonedds.core import Policy, Qos
        from cyclonedds.domain import DomainParticipant
        from cyclonedds.idl import IdlStruct
        from cyclonedds.sub import DataReader
        from cyclonedds.topic import Topic
    except ImportError:
        return None
    from dataclasses import dataclass
    from os import environ

    @dataclass
    class Text(IdlStruct, typename="std_msgs::msg::dds_::String_"):
        data: str

    participant = DomainParticipant(int(environ["ROS_DOMAIN_ID"]))
    topic = Topic(participant, f"rt{NAME}/instruction", Text)
    reader = DataReader(participant, topic, Qos(Policy.Reliability.Reliable(1_000_000_000)))

    def poll():
        while True:
            heard.extend(json.loads(text.data)["text"] for text in reader.take(10))
            time.sleep(0.05)

    threading.Thread(target=poll, daemon=True).start()
    return heard


def call(node, kind, name, request):
    client = node.create_client(kind, f"{NAME}/{name}")
    assert client.wait_for_service(20), name
    future = client.call_async(request)
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    assert done.wait(20), name
    return future.result()


def state(node):
    return call(node, GetState, "get_state", GetState.Request()).current_state.label


def change(node, step):
    request = ChangeState.Request(transition=Transition(id=step))
    return call(node, ChangeState, "change_state", request).success


def set_parameter(node, name, value):
    parameter = Parameter(name=name, value=ParameterValue(type=3, double_value=value))
    call(node, SetParameters, "set_parameters", SetParameters.Request(parameters=[parameter]))


def main():
    rclpy.init()
    node = rclpy.create_node("manager")
    texts, heard = [], []
    node.create_subscription(String, f"{NAME}/text", lambda message: texts.append(message.data), 10)
    camera = node.create_publisher(CompressedImage, "/camera", qos_profile_sensor_data)
    spinner = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    spinner.start()
    words = ["-r", "__ns:=/rov", "-r", "image/compressed:=/camera"]
    command = [sys.executable, "-m", "lightgesture", "ros2", "--managed", "--quiet", "--ros-args", *words]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as child:
        set_parameter(node, "threshold", 7.0)
        is_configured = change(node, STEPS[0])
        said = {
            "namespace": NAME,
            "bad parameter": "configured" if is_configured else state(node),
            "states": [],
        }
        set_parameter(node, "threshold", 0.7)
        said["heard without ROS"] = listen_without_ros(heard)
        for step in STEPS:
            assert change(node, step)
            said["states"].append("finalized" if step == STEPS[-1] else state(node))
            if len(said["states"]) == 4:
                show_clip(camera)
        said["status"] = child.wait(20)
    said["texts"] = texts
    rclpy.shutdown()
    spinner.join()
    print(json.dumps(said))


def show_clip(camera):
    """The clip, once, at its own rate; some pictures are lost on the way, for nobody waits for any."""
    while not camera.get_subscription_count():
        time.sleep(0.05)
    start_s = time.monotonic()
    for number, image in zip(range(285), frames_of_clip(), strict=False):
        time.sleep(max(0.0, start_s + number / 30 - time.monotonic()))
        camera.publish(
            CompressedImage(format="jpeg", data=array("B", cv2.imencode(".jpg", image)[1].tobytes()))
        )
    time.sleep(1)


if __name__ == "__main__":
    main()
