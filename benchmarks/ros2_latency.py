"""ROS 2 end to end: pictures of the bundled clip at a steady rate through the node, loss and latency.

    python -m lightgesture.benchmarks.ros2_latency [--fps 30] [--seconds 20] [--raw]

Run it with a Python that has rclpy. It starts `lightgesture ros2` in a process of its own, publishes the pictures with
the time of publishing as their stamp, and compares it with the time at which a record that names the stamp comes back:
the way through Fast DDS, the decoder and back again.
"""

import argparse
import importlib
import json
import os
import subprocess
import sys
import threading
import time
from array import array
from collections.abc import Iterator, Sequence
from typing import Any, Final

import cv2
import numpy as np

from lightgesture.console import print_line
from lightgesture.features.types import Image
from lightgesture.sources import open_source

START_S: Final = 20.0
"""Longest wait for the node to appear, seconds."""
SETTLE_S: Final = 1.0
"""From the discovery to the first picture, and from the last to the end."""
NANO: Final = 1_000_000_000


class Measurement:
    """A camera and a listener of one node."""

    def __init__(self, rclpy: Any, is_raw: bool) -> None:
        qos = importlib.import_module("rclpy.qos")
        images = importlib.import_module("sensor_msgs.msg")
        texts = importlib.import_module("std_msgs.msg")
        self.node = rclpy.create_node("measurement")
        self._is_raw = is_raw
        self._kind = images.Image if is_raw else images.CompressedImage
        topic = "image" if is_raw else "image/compressed"
        self.camera = self.node.create_publisher(self._kind, topic, qos.qos_profile_sensor_data)
        self.late_ms: dict[str, list[float]] = {"state": [], "event": [], "instruction": []}
        self.texts: list[str] = []
        self.pictures = 0
        self.annotated_ms: list[float] = []
        for name in self.late_ms:
            self.node.create_subscription(texts.String, f"lightgesture/{name}", self._note(name), 10)
        annotated = "lightgesture/annotated/compressed"
        self.node.create_subscription(
            images.CompressedImage, annotated, self._note_picture, qos.qos_profile_sensor_data
        )

    def _since(self, stamp_ns: int) -> float:
        return float(self.node.get_clock().now().nanoseconds - stamp_ns) / 1e6

    def _note(self, name: str) -> Any:
        def take(message: Any) -> None:
            record = json.loads(message.data)
            if record["stamp"] is not None:
                self.late_ms[name].append(self._since(record["stamp"][0] * NANO + record["stamp"][1]))
            if record["type"] == "instruction":
                self.texts.append(record["text"])

        return take

    def _note_picture(self, message: Any) -> None:
        stamp = message.header.stamp
        self.annotated_ms.append(self._since(stamp.sec * NANO + stamp.nanosec))

    def publish(self, image: Image) -> None:
        """One picture, stamped now."""
        if self._is_raw:
            height, width = image.shape[:2]
            message = self._kind(height=height, width=width, step=3 * width, encoding="bgr8")
            message.data = array("B", image.tobytes())
        else:
            message = self._kind(format="jpeg", data=array("B", cv2.imencode(".jpg", image)[1].tobytes()))
        message.header.stamp = self.node.get_clock().now().to_msg()
        self.camera.publish(message)
        self.pictures += 1


def frames_of_clip() -> Iterator[Image]:
    """The bundled clip again and again."""
    clip = os.path.join(os.path.dirname(__file__), "..", "lightgesture", "data", "sample.mp4")
    with open_source(os.path.realpath(clip)) as source:
        images = [frame.image for frame in source]
    while True:
        yield from images


def main(argv: Sequence[str] | None = None) -> int:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fps", type=float, default=30.0, help="pictures a second (default: 30)")
    parser.add_argument("--seconds", type=float, default=20.0, help="how long (default: 20)")
    parser.add_argument("--raw", action="store_true", help="raw pictures and not JPEG")
    args = parser.parse_args(argv)
    rclpy = importlib.import_module("rclpy")
    rclpy.init()
    command = [sys.executable, "-m", "lightgesture", "ros2", "--json", *["--raw"] * args.raw]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        lines: list[str] = []
        reader = threading.Thread(target=lambda: lines.extend(child.stdout or ()), daemon=True)
        reader.start()
        try:
            measurement = _measure(rclpy, args.fps, args.seconds, args.raw)
        finally:
            child.terminate()
            child.wait()
        reader.join()
    summary = json.loads(lines[-1])
    _print_table(measurement, summary)
    return 0


def _measure(rclpy: Any, fps: float, seconds: float, is_raw: bool) -> Measurement:
    measurement = Measurement(rclpy, is_raw)
    spinner = threading.Thread(target=rclpy.spin, args=(measurement.node,), daemon=True)
    spinner.start()
    deadline_s = time.monotonic() + START_S
    while not measurement.camera.get_subscription_count():
        if time.monotonic() > deadline_s:
            raise TimeoutError(f"the node did not subscribe within {START_S:g} s")
        time.sleep(0.1)
    time.sleep(SETTLE_S)
    images = frames_of_clip()
    start_s = time.monotonic()
    while (due_s := measurement.pictures / fps) < seconds:
        time.sleep(max(0.0, start_s + due_s - time.monotonic()))
        measurement.publish(next(images))
    time.sleep(SETTLE_S)
    rclpy.shutdown()
    spinner.join()
    return measurement


def _print_table(measurement: Measurement, summary: dict[str, Any]) -> None:
    sent, decoded = measurement.pictures, summary["frames"]
    print_line(f"pictures sent {sent}, decoded {decoded}, lost {sent - decoded} ({1 - decoded / sent:.1%})")
    print_line(f"instructions {summary['instructions']}: {'; '.join(measurement.texts)}")
    late = {**measurement.late_ms, "annotated": measurement.annotated_ms}
    print_line(f"{'topic':<12}{'messages':>9}{'median ms':>11}{'p95 ms':>9}{'max ms':>9}")
    for name, values in late.items():
        if values:
            median, high, most = np.percentile(values, (50, 95, 100))
            print_line(f"{name:<12}{len(values):>9}{median:>11.1f}{high:>9.1f}{most:>9.1f}")


if __name__ == "__main__":
    sys.exit(main())
