"""Bags of ROS 1 and ROS 2 and MCAP files, written here by the library that reads them."""

import cv2
import numpy as np
import pytest
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore

from lightgesture.errors import ExitStatus, InputError
from lightgesture.sources import SourceOptions, open_source

IMAGES = [np.full((12, 16, 3), (10 + 40 * n, 200 - 40 * n, 90), np.uint8) for n in range(4)]
STORES = {1: get_typestore(Stores.ROS1_NOETIC), 2: get_typestore(Stores.ROS2_HUMBLE)}
START_NS = 1_700_000_000_000_000_000


def header(store, version, time_ns):
    types = store.types
    stamp = types["builtin_interfaces/msg/Time"](time_ns // 10**9, time_ns % 10**9)
    extra = {"seq": 0} if version == 1 else {}
    return types["std_msgs/msg/Header"](stamp=stamp, frame_id="camera", **extra)


def raw(store, version, time_ns, image, encoding="bgr8"):
    rows = image.reshape(image.shape[0], -1).view(np.uint8)
    padded = np.pad(rows, ((0, 0), (0, 8)))  # rows that are longer than the picture is wide
    return store.types["sensor_msgs/msg/Image"](
        header=header(store, version, time_ns),
        height=image.shape[0],
        width=image.shape[1],
        encoding=encoding,
        is_bigendian=0,
        step=padded.shape[1],
        data=padded.ravel(),
    )


def compressed(store, version, time_ns, image, encoding="png"):
    data = cv2.imencode(f".{encoding}", image)[1].ravel()
    return store.types["sensor_msgs/msg/CompressedImage"](
        header=header(store, version, time_ns), format=encoding, data=data
    )


def text(store, version, time_ns, image):
    return store.types["std_msgs/msg/String"](data="depth 3 m")


def garbage(store, version, time_ns, image):
    return compressed(store, version, time_ns, image).__class__(
        header=header(store, version, time_ns), format="jpeg", data=np.arange(90, dtype=np.uint8)
    )


TYPES = {raw: "Image", compressed: "CompressedImage", garbage: "CompressedImage"}


@pytest.fixture
def make_bag(tmp_path):
    """Writes a bag of `kind` ("ros1", "ros2", "mcap") with a topic for each keyword, stamped 0.1 s apart."""

    def make(kind, has_stamps=True, **topics):
        version = 1 if kind == "ros1" else 2
        store = STORES[version]
        path = tmp_path / ("dive.bag" if version == 1 else f"dive_{kind}")
        plugin = {"storage_plugin": StoragePlugin.MCAP} if kind == "mcap" else {}
        writer = Writer1(path) if version == 1 else Writer2(path, version=9, **plugin)
        serialize = store.serialize_ros1 if version == 1 else store.serialize_cdr
        with writer:
            for topic, message in topics.items():
                name = f"sensor_msgs/msg/{TYPES[message]}" if message in TYPES else "std_msgs/msg/String"
                connection = writer.add_connection(f"/{topic}", name, typestore=store)
                for number, image in enumerate(IMAGES):
                    taken_ns = START_NS + number * 100_000_000
                    stamp_ns = taken_ns if has_stamps else 0
                    content = serialize(message(store, version, stamp_ns, image), name)
                    # Recorded later and less evenly than taken.
                    writer.write(connection, taken_ns + 7_000_000 + number * number * 1_000_000, content)
        return next(path.glob("*.mcap")) if kind == "mcap" else path

    return make


@pytest.mark.parametrize("kind", ["ros1", "ros2", "mcap"])
@pytest.mark.parametrize("message", [raw, compressed])
def test_pictures_with_the_time_of_their_headers(make_bag, kind, message):
    with open_source(make_bag(kind, camera=message, depth=text)) as source:
        assert source.frame_count == 4
        frames = list(source)
    assert [frame.index for frame in frames] == [0, 1, 2, 3]
    assert [frame.time_s for frame in frames] == [0.0, 0.1, 0.2, 0.3]
    assert all(np.array_equal(frame.image, image) for frame, image in zip(frames, IMAGES, strict=True))


def test_without_stamps_the_time_of_recording_counts(make_bag):
    with open_source(make_bag("ros2", has_stamps=False, camera=raw)) as source:
        assert [frame.time_s for frame in source] == [0.0, 0.101, 0.204, 0.309]


def test_topics(make_bag):
    path = make_bag("ros1", left=raw, right=compressed, depth=text)
    with open_source(path, SourceOptions(topic="/right")) as source:
        assert len(list(source)) == 4
    with pytest.raises(InputError, match=r"holds 2 image topics; choose one with --topic: /left, /right$"):
        open_source(path)
    with pytest.raises(InputError, match=r"has no image topic /depth; those there are: /left, /right$"):
        open_source(path, SourceOptions(topic="/depth"))


def test_a_bag_without_pictures(make_bag):
    with pytest.raises(InputError, match=r"holds no image topic; its topics: /depth$"):
        open_source(make_bag("ros2", depth=text))


def test_messages_that_hold_no_picture_are_left_out(make_bag):
    with pytest.raises(
        InputError, match=r"4 of 4 messages left out; the first: message 0 holds no picture .*'jpeg'"
    ):
        list(open_source(make_bag("mcap", camera=garbage)))


@pytest.mark.parametrize("kind", ["ros1", "ros2", "mcap"])
def test_damaged_bags(make_bag, kind):
    path = make_bag(kind, camera=raw)
    file = next(path.glob("*.db3")) if kind == "ros2" else path
    content = file.read_bytes()
    for length in (0, 10, len(content) // 2):
        file.write_bytes(content[:length])
        with pytest.raises(InputError, match=r"(is no bag that can be read|the bag is damaged) \("):
            list(open_source(path))


def test_a_folder_of_frames_with_metadata_of_its_own_is_no_bag(make_folder):
    folder = make_folder(count=2)
    (folder / "metadata.yaml").write_text("camera: left\n")
    with open_source(folder) as source:
        assert len(list(source)) == 2


def test_decode_takes_a_bag(make_bag, run, fake):
    result = run("decode", make_bag("ros1", left=raw, right=raw), "--topic", "/right", "--json")
    assert result.status == ExitStatus.OK
    assert [seen[:2] for seen in fake.made[-1].seen] == [(0, 0.0), (1, 0.1), (2, 0.2), (3, 0.3)]


def test_without_the_extra(make_bag, monkeypatch):
    path = make_bag("ros1", camera=raw)
    monkeypatch.setitem(__import__("sys").modules, "rosbags.highlevel", None)
    with pytest.raises(InputError, match=r"is a bag; install lightgesture\[bag\] to read it"):
        open_source(path)
