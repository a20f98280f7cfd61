"""Targets that are files of bytes: archives, nets, pictures, recordings."""

import hashlib
import io
import json
import math
import zipfile
from contextlib import closing, suppress
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from lightgesture.features.archive import HEADER, read_archive
from lightgesture.features.find.selector_file import BUNDLED, load_classical, load_learned
from lightgesture.features.image import as_bgr8
from lightgesture.features.net.file import network_from
from lightgesture.features.net.flatbuffer import network_arrays
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.net.runner import Network
from lightgesture.features.tags.detector import make_detector
from lightgesture.models import load_classifier
from lightgesture.models.loading import SHIPPED
from lightgesture.sources.bag import BagFile
from lightgesture.sources.bag_messages import CDR, PROTOBUF, ROS1, picture_type, read_message
from lightgesture.sources.packets import PacketDecoder
from lightgesture.sources.pictures import depth_of, read_picture
from lightgesture.sources.ros_images import message_to_bgr8
from lightgesture.sources.video import VideoFile
from tests.models.test_cnn import random_model

from .scratch import file_of, folder

FRAMES = 4
"""Pictures that are taken of a recording."""

MOST_VALUES = 1 << 16
"""Of the inputs of a net that is run."""

WRITINGS = (ROS1, CDR, PROTOBUF)
KINDS = (
    *("sensor_msgs/Image", "sensor_msgs/CompressedImage", "foxglove/CompressedImage"),
    *("foxglove/RawImage", "ffmpeg_image_transport/FFMPEGPacket"),
)
FAMILY = "36h11"


def archive(content: bytes) -> None:
    read_archive(file_of(content, "model.npz"))


def member(content: bytes) -> None:
    """One array of an archive whose check sums are right, which blind changes of a zip never are."""
    read_archive(_zip({HEADER: _npy(np.frombuffer(b"{}", np.uint8)), "array": content}))


def svm_header(content: bytes) -> None:
    _load(content, _machine())


def cnn_header(content: bytes) -> None:
    _load(content, {name: _npy(array) for name, array in _net_arrays("net").items()})


def layout(content: bytes) -> None:
    """The text that lists the nodes of a net, with the check sum of its `.tflite` put right."""
    arrays = _net_arrays("net")
    with suppress(ValueError, RecursionError):
        listed = json.loads(content)
        if isinstance(listed, dict):
            listed["sha256"] = hashlib.sha256(arrays["net_tflite"].tobytes()).hexdigest()
            content = json.dumps(listed).encode()
    _run(network_from({**arrays, "net_layout": np.frombuffer(content, np.uint8)}, "net"))


def tflite(content: bytes) -> None:
    """The file that LiteRT is given, with the layout's check sum put right; what it takes is run once."""
    arrays = _net_arrays("net")
    listed = json.loads(arrays["net_layout"].tobytes())
    listed["sha256"] = hashlib.sha256(content).hexdigest()
    text = np.frombuffer(json.dumps(listed).encode(), np.uint8)
    _run(network_from({"net_layout": text, "net_tflite": np.frombuffer(content, np.uint8)}, "net"))


def selector(content: bytes) -> None:
    """Trees of the bundled selector, their numbers overwritten: array, place and bytes are the content's."""
    header, arrays = _selector()
    changed = {name: array.copy() for name, array in arrays.items() if "pair" in name or "places" in name}
    names = sorted(name for name in changed if changed[name].dtype.kind in "iuf" and changed[name].size)
    for number in range(0, len(content) - 3, 4):
        array = changed[names[content[number] % len(names)]].reshape(-1)
        place = int.from_bytes(content[number + 1 : number + 3], "big") % array.size
        array[place] = np.array(content[number + 3]).astype(np.int8).astype(array.dtype)
    whole = {**arrays, **changed}
    members = {name: _npy(array) for name, array in whole.items()}
    path = _zip({HEADER: _npy(np.frombuffer(json.dumps(header).encode(), np.uint8)), **members})
    load_learned(path)
    load_classical(path)


def picture(content: bytes) -> None:
    as_bgr8(read_picture(file_of(content, "picture.png")))


def tags(content: bytes) -> None:
    """A grey picture of the width that its first byte tells."""
    width = 16 + (content[0] if content else 0)
    pixels = np.frombuffer(content[1:], np.uint8)
    grey = np.ascontiguousarray(pixels[: pixels.size // width * width].reshape(-1, width))
    if len(grey) >= 16:
        for detector in _detectors():
            detector.process(grey, 0.0)


def video(content: bytes) -> None:
    with VideoFile(str(file_of(content, "dive.mp4"))) as source:
        for _ in islice(source, FRAMES):
            pass


def bag(content: bytes) -> None:
    name = "dive.bag" if content.startswith(b"#ROSBAG") else "dive.mcap"
    with closing(BagFile(str(file_of(content, name)))) as source:
        for _ in islice(source, FRAMES):
            pass


def message(content: bytes) -> None:
    """A message of a bag: its first byte tells how it is written and of what kind it is."""
    if not content:
        return
    kind = picture_type(KINDS[content[0] % len(KINDS)])
    assert kind is not None
    try:
        message_to_bgr8(
            read_message(kind, content[1:], WRITINGS[content[0] // len(KINDS) % 3]), depth_of("bag")
        )
    except ValueError:  # which the bag makes a line of
        return


def packets(content: bytes) -> None:
    """Packets of H.264, parted at their start codes."""
    decoder = PacketDecoder("h264", lambda _: None)
    for number, part in enumerate(content.split(b"\0\0\0\1")[: 4 * FRAMES]):
        with suppress(ValueError):
            decoder.feed(number, number, np.frombuffer(b"\0\0\0\1" + part, np.uint8))
    decoder.flush()


def _run(network: IntegerNetwork) -> None:
    """Once, of blank pictures that are not too large, by LiteRT where it is installed."""
    runner = Network(network)
    if sum(math.prod(shape) for shape in network.inputs.values()) < MOST_VALUES:
        runner.run({name: np.zeros((1, *shape), np.int8) for name, shape in network.inputs.items()})


def _load(header: bytes, members: dict[str, bytes]) -> None:
    classifier = load_classifier(_zip({HEADER: _npy(np.frombuffer(header, np.uint8)), **members}))
    classifier.probabilities(np.full((48, 48, 3), 90, np.uint8), [(4, 4, 40, 40)], ["left"])


def _zip(members: dict[str, bytes]) -> Path:
    path = folder() / "members.npz"
    with zipfile.ZipFile(path, "w") as zipped:
        for name, content in members.items():
            zipped.writestr(f"{name}.npy", content)
    return path


def _npy(array: Any) -> bytes:
    stream = io.BytesIO()
    np.save(stream, np.asarray(array), allow_pickle=False)
    return stream.getvalue()


@cache
def _machine() -> dict[str, bytes]:
    """The arrays of a machine with two expansion vectors of four numbers."""
    _, arrays = read_archive(SHIPPED["svm"])
    small = {
        "mean": arrays["mean"],
        "projection": arrays["projection"][:, :4],
        "centres": arrays["centres"][:2, :4],
        "weights": arrays["weights"][:2],
        "bias": arrays["bias"],
    }
    return {name: _npy(array) for name, array in small.items()}


@cache
def _detectors() -> list[Any]:
    return [make_detector("aruco", FAMILY), make_detector("apriltag", FAMILY)]


@cache
def _selector() -> tuple[dict[str, Any], dict[str, Any]]:
    return read_archive(BUNDLED)


@cache
def _net_arrays(prefix: str) -> dict[str, Any]:
    """A small net of every operation but one, and the two arrays that stand beside it."""
    model = random_model(3, has_outline=True)
    return {
        **network_arrays(prefix, model.network),
        "contour_mean": model.contour_mean,
        "contour_deviation": model.contour_deviation,
    }
