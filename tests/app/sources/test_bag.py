"""Bags of ROS 1 and ROS 2 and MCAP files, written here by the library that reads them."""

import struct
from datetime import UTC, datetime
from fractions import Fraction

import av
import cv2
import numpy as np
import pytest
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from lightgesture.errors import ExitStatus, InputError
from lightgesture.sources import SourceOptions, open_source
from lightgesture.sources.bag_clock import BagClock

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


def noise_image(image):
    """So large that a chunk holds three at most, and nothing packs it."""
    return np.random.default_rng(int(image[0, 0, 0])).integers(0, 255, (600, 280, 3), np.uint8)


def noise(store, version, time_ns, image):
    return raw(store, version, time_ns, noise_image(image))


TYPES = {noise: "Image", raw: "Image", compressed: "CompressedImage", garbage: "CompressedImage"}


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
                name = (
                    "std_msgs/msg/String"
                    if message is text
                    else f"sensor_msgs/msg/{TYPES.get(message, 'Image')}"
                )
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


@pytest.mark.parametrize(
    ("stamps_s", "times"),
    [
        ((5, 5.1, 0, 5.3), [0, 0.1, 0.203, 0.3]),  # a simulation whose driver leaves some out
        ((0, 5.1, 5.2, 5.3), [0, 0.101, 0.201, 0.301]),
        ((0, 0, 0, 7), [0, 0.101, 0.204, 0.309]),  # hardly any: the recording has the clock
        ((9, 9, 9, 9), [0, 0.101, 0.204, 0.309]),
        ((9, 8, 7, 6), [0, 0.101, 0.204, 0.309]),
        ((5, 5.1, 5.2, 5.15), [0, 0.1, 0.2, 0.2]),  # neighbours swapped
    ],
)
def test_a_bag_has_one_clock(make_bag, stamps_s, times):
    stamps_ns = iter([round(stamp * 10**9) for stamp in stamps_s])

    def stamped(store, version, time_ns, image):
        return raw(store, version, next(stamps_ns), image)

    with open_source(make_bag("ros2", camera=stamped)) as source:
        assert [frame.time_s for frame in source] == pytest.approx(times, abs=1e-6)
        assert source.start_utc == datetime.fromtimestamp((START_NS + 7_000_000) / 1e9, UTC)


def test_a_clock_that_is_set_during_the_dive_goes_on():
    clock = BagClock(by_header=True)
    day = 86_400 * 10**9
    clock.start(day, 50)
    moves = [(day, 50), (day + 10, 60), (11, 70), (21, 80), (3 * day, 95), (3 * day + 10, 105), (0, 115)]
    assert [clock.read(*move) for move in moves] == [0, 10, 20, 30, 45, 55, 65]


def test_the_moment_of_the_first_message(make_bag):
    with open_source(make_bag("mcap", camera=raw)) as source:
        assert source.start_utc == datetime.fromtimestamp(START_NS / 1e9, UTC)


FOXGLOVE, FFMPEG = "foxglove_msgs/msg/CompressedVideo", "ffmpeg_image_transport_msgs/msg/FFMPEGPacket"
DEFINITIONS = {
    FOXGLOVE: "builtin_interfaces/Time timestamp\nstring frame_id\nuint8[] data\nstring format",
    FFMPEG: "std_msgs/Header header\nint32 width\nint32 height\nstring encoding\nuint64 pts\nuint8 flags\n"
    "bool is_bigendian\nuint8[] data",
}


def encode(codec, count=12, **options):
    """Packets of a video that grows brighter."""
    context = av.CodecContext.create(codec, "w")
    context.width, context.height, context.pix_fmt, context.time_base = 64, 48, "yuv420p", Fraction(1, 10)
    context.options = {"preset": "veryfast", "tune": "zerolatency", **options}
    packets = []
    for number in range(count):
        frame = av.VideoFrame.from_ndarray(np.full((48, 64, 3), 20 * number, np.uint8), format="bgr24")
        frame.pts = number
        packets += context.encode(frame)
    return [bytes(packet) for packet in [*packets, *context.encode(None)]]


def packet_message(kind, store, packet, time_ns, form):
    stamp = store.types["builtin_interfaces/msg/Time"](time_ns // 10**9, time_ns % 10**9)
    data = np.frombuffer(packet, np.uint8)
    if kind == FOXGLOVE:
        return store.types[kind](timestamp=stamp, frame_id="camera", data=data, format=form)
    header = store.types["std_msgs/msg/Header"](stamp=stamp, frame_id="camera")
    if kind == FFMPEG:
        extra = {"pts": 0, "flags": 0, "is_bigendian": False}
        return store.types[kind](header=header, width=64, height=48, encoding=form, data=data, **extra)
    return store.types[kind](header=header, format=form, data=data)


def write_packets(path, kind, packets, form, plugin=StoragePlugin.MCAP):
    store = get_typestore(Stores.ROS2_HUMBLE)
    if kind in DEFINITIONS:
        store.register(get_types_from_msg(DEFINITIONS[kind], kind))
    with Writer2(path, version=9, storage_plugin=plugin) as writer:
        connection = writer.add_connection("/camera", kind, typestore=store)
        for number, packet in enumerate(packets):
            time_ns = START_NS + number * 100_000_000
            content = packet_message(kind, store, packet, time_ns, form)
            writer.write(connection, time_ns + 5, store.serialize_cdr(content, kind))
    return path


@pytest.mark.parametrize(
    ("kind", "codec", "form", "options"),
    [
        (FOXGLOVE, "libx264", "h264", {}),
        (FOXGLOVE, "libx265", "h265", {"x265-params": "log-level=none"}),
        (FFMPEG, "libx264", "libx264", {"bf": "2", "tune": "film"}),
        (FFMPEG, "libx265", "hevc_nvenc;yuv420p;bgr8", {"x265-params": "log-level=none"}),
        ("sensor_msgs/msg/CompressedImage", "libx264", "h264", {}),
    ],
)
def test_topics_of_videos(tmp_path, kind, codec, form, options):
    with open_source(write_packets(tmp_path / "dive", kind, encode(codec, **options), form)) as source:
        frames = list(source)
    assert [frame.index for frame in frames] == list(range(12))
    assert [frame.time_s for frame in frames] == pytest.approx([number / 10 for number in range(12)])
    assert [round(float(frame.image.mean()) / 20) for frame in frames] == list(range(12))


def test_a_topic_that_begins_between_two_whole_pictures(tmp_path, capsys):
    packets = encode("libx264", g="6", forced_idr="1")
    path = write_packets(tmp_path / "dive", FOXGLOVE, packets[2:], "h264")
    with open_source(path) as source:
        frames = list(source)
    assert frames[0].time_s == pytest.approx(0.4)
    assert round(float(frames[0].image.mean()) / 20) == 6
    assert len(frames) == 6


def test_a_codec_that_is_not_known(tmp_path):
    path = write_packets(tmp_path / "dive", FOXGLOVE, encode("libx264"), "h999")
    with pytest.raises(
        InputError, match="12 of 12 messages left out; the first: message 0 is coded as 'h999'"
    ):
        list(open_source(path))


def protobuf(number, value):
    """A field: a whole number, or bytes."""

    def varint(rest):
        return bytes([rest]) if rest < 0x80 else bytes([rest & 0x7F | 0x80]) + varint(rest >> 7)

    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    return varint(number << 3 | 2) + varint(len(value)) + value


def test_foxglove_messages_as_protocol_buffers(tmp_path):
    """MCAP by hand, without chunks and index, as a logger that knows no ROS may write it."""

    def record(kind, content):
        return struct.pack("<BQ", kind, len(content)) + content

    def text(words):
        return struct.pack("<I", len(words)) + words.encode()

    content = b"\x89MCAP0\r\n" + record(1, text("") + text("logger"))
    schema = struct.pack("<H", 1) + text("foxglove.CompressedVideo") + text("protobuf") + text("")
    content += record(3, schema) + record(
        4, struct.pack("<HH", 7, 1) + text("/video") + text("protobuf") + text("")
    )
    for number, packet in enumerate(encode("libx264")):
        time_ns = START_NS + number * 100_000_000
        stamp = protobuf(1, time_ns // 10**9) + protobuf(2, time_ns % 10**9)
        message = protobuf(1, stamp) + protobuf(2, b"camera") + protobuf(3, packet) + protobuf(4, b"h264")
        content += record(5, struct.pack("<HIQQ", 7, number, time_ns, time_ns) + message)
    path = tmp_path / "dive.mcap"
    path.write_bytes(content)
    with open_source(path) as source:
        assert [frame.time_s for frame in source] == pytest.approx([number / 10 for number in range(12)])


def test_bags_that_are_cut_off_are_read_as_far_as_they_go(make_bag, capsys):
    for kind in ("ros1", "ros2", "mcap"):
        path = make_bag(kind, camera=noise)
        file = next(path.glob("*.db3")) if kind == "ros2" else path
        content = file.read_bytes()
        for length in (0, 10):
            file.write_bytes(content[:length])
            with pytest.raises(InputError, match=r"is no bag that can be read \("):
                open_source(path)
        file.write_bytes(content[: len(content) * (9 if kind == "ros2" else 7) // 10])
        frames = []
        with (
            open_source(path) as source,
            pytest.raises(InputError, match=r": the bag is cut off.*, [123] pictures of it"),
        ):
            frames.extend(source)
        assert [frame.time_s for frame in frames] == [0.0, 0.1], kind
        assert all(
            np.array_equal(frame.image, noise_image(image))
            for frame, image in zip(frames, IMAGES, strict=False)
        )
    assert "is read from its start, for its index cannot be" in capsys.readouterr().err


def test_a_bag_whose_recorder_was_killed(make_bag, capsys):
    path = make_bag("ros1", camera=raw)
    content = bytearray(path.read_bytes())
    place = content.index(b"index_pos=") + 10
    end = int.from_bytes(content[place : place + 8], "little")
    content[place : place + 8] = bytes(8)
    active = path.with_name("dive.bag.active")
    active.write_bytes(content[:end])
    with open_source(active) as source:
        assert [frame.time_s for frame in source] == [0.0, 0.1, 0.2, 0.3]
    assert (
        "the bag was not closed by its recorder; read as far as it goes, 4 pictures"
        in capsys.readouterr().err
    )


@pytest.mark.parametrize("is_alone", [False, True])
def test_a_data_base_without_metadata(make_bag, tmp_path, is_alone):
    path = make_bag("ros2", camera=raw)
    (path / "metadata.yaml").unlink()
    with open_source(next(path.glob("*.db3")) if is_alone else path) as source:
        assert [frame.time_s for frame in source] == [0.0, 0.1, 0.2, 0.3]


def test_a_bag_that_lacks_one_of_its_files(make_bag):
    path = make_bag("ros2", camera=raw)
    metadata = path / "metadata.yaml"
    line = next(line for line in metadata.read_text().splitlines() if line.strip() == f"- {path.name}.db3")
    another = line.replace(path.name, "gone_1")
    metadata.write_text(metadata.read_text().replace(line, f"{line}\n{another}"))
    frames = []
    with open_source(path) as source, pytest.raises(InputError, match=r"the bag lacks its file gone_1\.db3"):
        frames.extend(source)
    assert len(frames) == 4


@pytest.mark.parametrize("kind", ["ros1", "mcap"])
def test_a_damaged_chunk_is_left_out(make_bag, kind):
    path = make_bag(kind, camera=noise)
    content = bytearray(path.read_bytes())
    place = content.index(noise_image(IMAGES[1]).tobytes()[:200]) - 90
    content[place : place + 40] = bytes(40)
    path.write_bytes(content)
    frames = []
    with (
        open_source(path) as source,
        pytest.raises(InputError, match=r"the bag is damaged (in 1 place|and lacks 2)"),
    ):
        frames.extend(source)
    assert [frame.time_s for frame in frames] == [0.0, 0.3]
