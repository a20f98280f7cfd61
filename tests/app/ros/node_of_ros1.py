"""Shows the bundled clip to a node of ROS 1, and prints as JSON what it said; run by test_nodes.py with rospy."""

import json
import os
import signal
import socket
import subprocess
import sys
import time

import cv2
import rospy
from sensor_msgs.msg import CompressedImage
from std_msgs.msg import Int32, String

from lightgesture.benchmarks.ros2_latency import frames_of_clip

NAME = "/rov/lightgesture"


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def main():
    port = free_port()
    os.environ["ROS_MASTER_URI"], os.environ["ROS_IP"] = f"http://127.0.0.1:{port}", "127.0.0.1"
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    master = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL, env=clean)
    with_pictures = [sys.executable, "-m", "lightgesture", "ros1", "__ns:=/rov", "--quiet"]
    try:
        while not is_there(port):
            time.sleep(0.2)
        child = subprocess.Popen(with_pictures, stdout=subprocess.DEVNULL)
        said = show_clip()
        child.terminate()
        said["status"] = child.wait(20)
    finally:
        master.send_signal(signal.SIGINT)
        master.wait(20)
    print(json.dumps(said))


def is_there(port):
    with socket.socket() as one:
        return one.connect_ex(("127.0.0.1", port)) == 0


def show_clip():
    rospy.init_node("camera", disable_signals=True)
    said = {"annotated": 0}

    def note_picture(_message):
        said["annotated"] += 1

    for name in ("text", "action", "change"):
        rospy.Subscriber(
            f"{NAME}/{name}", String, lambda message, name=name: said.update({name: message.data})
        )
    rospy.Subscriber(
        f"{NAME}/instruction", String, lambda message: said.update(instruction=json.loads(message.data))
    )
    rospy.Subscriber(f"{NAME}/number", Int32, lambda message: said.update(number=message.data))
    rospy.Subscriber(f"{NAME}/annotated/compressed", CompressedImage, note_picture)
    camera = rospy.Publisher("/rov/image/compressed", CompressedImage, queue_size=1)
    while not camera.get_num_connections():
        time.sleep(0.1)
    time.sleep(1)
    start_s = time.monotonic()
    for number, image in zip(range(285), frames_of_clip(), strict=False):
        time.sleep(max(0.0, start_s + number / 30 - time.monotonic()))
        message = CompressedImage(format="jpeg", data=cv2.imencode(".jpg", image)[1].tobytes())
        message.header.frame_id, message.header.stamp = "camera", rospy.Time.now()
        camera.publish(message)
    time.sleep(1)
    rospy.signal_shutdown("the end")
    return said


if __name__ == "__main__":
    main()
