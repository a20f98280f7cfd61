"""Files that promise more than fits the memory are refused before there is room made for it."""

import bz2
import struct
import zlib
from contextlib import closing, suppress
from pathlib import Path

import av
import cv2
import numpy as np
import pytest
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_typestore

from lightgesture.errors import InputError
from lightgesture.sources import decoding, inflate, pictures, video
from lightgesture.sources.bag_messages import PROTOBUF, read_message
from lightgesture.sources.bag_scan import ScanError
from lightgesture.sources.bag_storage import Bag
from lightgesture.sources.picture_size import picture_size
from lightgesture.sources.pictures import decode_picture, read_picture
from lightgesture.sources.video import VideoFile

from .conftest import noise

SIZE = (48, 32)
SUFFIXES = (".bmp", ".jp2", ".jpg", ".pgm", ".png", ".ppm", ".tif", ".webp", ".pbm")


def encoded(suffix, size=SIZE, kind=np.uint8):
    image = np.full((size[1], size[0], 3), 90, kind)
    if suffix in (".pgm", ".pbm"):
        image = image[:, :, 0]
    return cv2.imencode(suffix, image)[1].tobytes()


def png(width, height):
    """A PNG of a few bytes that promises this size."""

    def chunk(name, content):
        return (
            struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
        )

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")
    )


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_size_that_opencv_gives_is_the_one_that_was_read_before(suffix):
    content = encoded(suffix)
    assert picture_size(content) == SIZE
    image = decode_picture(content)
    assert image is not None
    assert image.shape[:2] == SIZE[::-1]


def test_sizes_of_other_layouts():
    assert picture_size(encoded(".tif", kind=np.uint16)) == SIZE
    assert picture_size(b"BM" + bytes(12) + struct.pack("<IHH", 12, *SIZE)) == SIZE
    assert picture_size(b"BM" + bytes(12) + struct.pack("<Iii", 40, SIZE[0], -SIZE[1])) == SIZE
    assert picture_size(b"P5\n# a remark\n48 # another\n32\n255\n") == SIZE
    big = b"II+\0\x08\0\0\0" + struct.pack("<QQ", 16, 2)
    big += struct.pack("<HHQQ", 256, 4, 1, 48) + struct.pack("<HHQQ", 257, 3, 1, 32)
    assert picture_size(big) == SIZE
    webp = cv2.imencode(".webp", np.full((32, 48, 3), 9, np.uint8), [cv2.IMWRITE_WEBP_QUALITY, 101])[
        1
    ].tobytes()
    assert picture_size(webp) == SIZE
    extended = b"RIFF\0\0\0\0WEBPVP8X" + bytes(8) + (47).to_bytes(3, "little") + (31).to_bytes(3, "little")
    assert picture_size(extended) == SIZE


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_is_cut_has_a_size_or_none(suffix):
    content = encoded(suffix)
    for size in (picture_size(content[:length]) for length in range(40)):
        assert size is None or (size[0] <= SIZE[0] and size[1] <= SIZE[1])


@pytest.mark.parametrize(
    "content",
    [b"", b"GIF89a" + bytes(40), b"<svg/>", b"\0" * 64, b"II+\0\x08\0\0\0" + b"\xff" * 8 + bytes(40)],
)
def test_other_files_are_no_pictures(content):
    assert picture_size(content) is None
    assert decode_picture(content) is None


def test_a_picture_that_promises_too_much_is_refused_unopened(tmp_path, monkeypatch):
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("it was decoded"))
    content = png(60_000, 60_000)
    (tmp_path / "bomb.png").write_bytes(content)
    with pytest.raises(
        InputError, match="promises 60000 x 60000 pixels, more than 120,000,000; make it smaller"
    ):
        read_picture(tmp_path / "bomb.png")
    assert decode_picture(content) is None


def test_a_chunk_of_a_png_that_goes_beyond_the_end_is_never_decoded(tmp_path, monkeypatch):
    """Of such a file of 73 bytes OpenCV made four gigabytes."""
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("it was decoded"))
    content = png(12, 8)
    place = content.index(b"IDAT")
    for length in (1 << 24, len(content), (1 << 32) - 1):
        hostile = content[: place - 4] + struct.pack(">I", length) + content[place:]
        (tmp_path / "bomb.png").write_bytes(hostile)
        assert picture_size(hostile) is None
        with pytest.raises(InputError, match="no picture that can be read"):
            read_picture(tmp_path / "bomb.png")


def test_the_frames_of_an_animation_count():
    head, end = png(12, 8).split(b"\0\0\0\x08IDAT")
    frame = struct.pack(">IIIII", 0, 60_000, 50_000, 0, 0) + bytes(6)
    content = head + struct.pack(">I4s", len(frame), b"fcTL") + frame + bytes(4) + b"\0\0\0\x08IDAT" + end
    assert picture_size(content) == (60_000, 50_000)


def test_a_picture_file_that_is_too_large_is_refused_unread(tmp_path, monkeypatch):
    monkeypatch.setattr(pictures, "LARGEST_FILE", 100)
    (tmp_path / "large.png").write_bytes(bytes(101))
    with pytest.raises(InputError, match="larger than 100 bytes"):
        read_picture(tmp_path / "large.png")


def test_a_video_that_promises_too_much_is_refused(write_video, monkeypatch):
    path = str(write_video("large.mp4", noise(3)))
    monkeypatch.setattr(video, "MAX_PIXELS", 1000)
    with pytest.raises(InputError, match="promises frames of 64 x 48 pixels, more than 1,000"):
        VideoFile(path)


def test_a_frame_that_is_larger_than_its_container_says_is_not_decoded(write_video, monkeypatch):
    path = str(write_video("large.mp4", noise(3)))
    monkeypatch.setattr(decoding, "MAX_PIXELS", 1000)
    with pytest.raises(InputError, match="no frame of this video"), VideoFile(path) as source:
        list(source)


def test_a_video_that_wants_more_memory_than_any_is_told_from_a_memory_that_is_too_small(monkeypatch):
    """Found by fuzzing: a length in a header that FFmpeg makes room for at once."""
    path = Path(__file__).parents[2] / "fuzz" / "corpus" / "video" / "fault-a57b7053"
    with pytest.raises(InputError, match="wants more memory to be opened than any video does"):
        VideoFile(str(path))
    monkeypatch.setattr(video, "ROOM", 1 << 60)
    with pytest.raises(MemoryError):
        VideoFile(str(path))


def test_a_codec_that_ffmpeg_does_not_know_is_told(write_video):
    path = write_video("odd.mp4", noise(3))
    path.write_bytes(path.read_bytes().replace(b"avc1", b"zzzz"))
    with av.open(str(path)) as container:
        assert container.streams.video[0].codec_context is None
    with pytest.raises(InputError, match="codec is not known here"):
        VideoFile(str(path))


def test_a_chunk_that_unpacks_to_too_much_is_cut_there(monkeypatch):
    packed = bz2.compress(bytes(10 << 20))
    assert len(packed) < 1000
    monkeypatch.setattr(inflate, "LARGEST", 1 << 20)
    assert len(inflate.inflate(packed, "bz2")) == 1 << 20
    assert len(inflate.inflate(bytes(2 << 20), "none")) == 1 << 20


@pytest.mark.parametrize("kind", ["bz2", "lz4", "zstd"])
def test_a_chunk_of_a_whole_bag_unpacks_to_no_more(tmp_path, monkeypatch, kind):
    """What the bag's own reader unpacks is bounded as what is read from the start of a damaged bag."""
    store = get_typestore(Stores.ROS2_HUMBLE if kind == "zstd" else Stores.ROS1_NOETIC)
    if kind == "zstd":
        writer = rosbag2.Writer(tmp_path / "dive", version=9, storage_plugin=rosbag2.StoragePlugin.MCAP)
        writer.set_compression(rosbag2.CompressionMode.STORAGE, rosbag2.CompressionFormat.ZSTD)
    else:
        writer = rosbag1.Writer(tmp_path / "dive.bag")
        writer.set_compression(rosbag1.Writer.CompressionFormat[kind.upper()])
    name = "std_msgs/msg/String"
    serialize = store.serialize_cdr if kind == "zstd" else store.serialize_ros1
    with writer:
        topic = writer.add_connection("/text", name, typestore=store)
        for number in range(3):
            writer.write(topic, 10**18 + number, serialize(store.types[name](data="a" * 200_000), name))
    path = str(next(tmp_path.glob("dive*/*.mcap" if kind == "zstd" else "dive.bag")))

    def messages():
        bag = Bag(path)
        with suppress(ScanError), closing(bag):
            yield from bag.messages("/text")

    assert len(list(messages())) == 3
    monkeypatch.setattr(inflate, "LARGEST", 300_000)
    assert len(list(messages())) == 1


@pytest.mark.parametrize(
    "content",
    [
        b"\x08" + b"\xff" * 9 + b"\x7f",  # a time of which the number is taken for a count of bytes
        b"\x08\x80\x80\x80\x80\x08",
        b"\x30\x80\x80\x80\x80\x04",  # data that are a number
        b"\x10" + b"\xff" * 1000,  # a number without an end
        b"\x12\x04wide",  # a width that is a text
        b"\x0a\x06\x0a\x04\x08\x01\x10\x02",  # seconds that are a message
    ],
)
def test_fields_of_another_kind_are_refused_before_they_are_taken_for_a_size(content):
    with pytest.raises(ValueError, match="cannot be read"):
        read_message("foxglove/RawImage", content, PROTOBUF)
