"""Videos, folders of frames and pictures, good and bad."""

import struct

import cv2
import numpy as np
import pytest

from lightgesture.config import DEFAULT_FPS
from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import InputError
from lightgesture.sources import SOURCES, SourceOptions, expand_inputs, natural_key, open_source, read_picture


def read_all(path, options=None):
    with open_source(path, options) as source:
        return list(source)


@pytest.mark.parametrize(("name", "fourcc"), [("a.avi", "MJPG"), ("a.mp4", "mp4v"), ("a.webm", "VP90")])
def test_video_in_sequence_with_its_own_time(make_video, name, fourcc):
    with open_source(make_video(name, 6, fourcc)) as source:
        assert source.frame_count == 6
        frames = list(source)
    assert [frame.index for frame in frames] == list(range(6))
    assert [frame.time_s for frame in frames] == [0.0, 0.05, 0.1, 0.15, 0.2, 0.25]
    assert all(frame.image.shape == (48, 64, 3) and frame.image.dtype == np.uint8 for frame in frames)


def _replace_box(content, path, change):
    """Change the body of the MP4 box at the end of `path`, and the sizes of the boxes that hold it."""
    place = 0
    while place < len(content):
        size, kind = struct.unpack(">I4s", content[place : place + 8])
        if kind == path[0]:
            body = content[place + 8 : place + size]
            body = change(body) if len(path) == 1 else _replace_box(body, path[1:], change)
            return content[:place] + struct.pack(">I4s", len(body) + 8, kind) + body + content[place + size :]
        place += size
    raise AssertionError(f"no box {path[0]}")


def test_variable_frame_rate_keeps_the_container_time(make_video):
    """Durations of 0.02 s and 0.08 s in turn, in a file whose mean rate is 20 frames a second."""
    path = make_video("a.mp4", 6, "mp4v")
    durations = []

    def stretch(body):
        count, delta = struct.unpack(">II", body[8:16])
        assert count == 6
        durations.extend([delta * 2 // 5, delta * 8 // 5] * 3)
        return body[:4] + struct.pack(">I", 6) + b"".join(struct.pack(">II", 1, each) for each in durations)

    boxes = [b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stts"]
    path.write_bytes(_replace_box(path.read_bytes(), boxes, stretch))
    times = [frame.time_s for frame in read_all(path)]
    assert times == pytest.approx([0.0, 0.02, 0.1, 0.12, 0.2, 0.22], abs=1e-3)


@pytest.mark.parametrize(("name", "fourcc"), [("a.avi", "MJPG"), ("a.webm", "VP90")])
def test_video_that_ends_early_yields_what_there_is(make_video, name, fourcc):
    path = make_video(name, 60, fourcc)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    frames = []
    with open_source(path) as source, pytest.raises(InputError, match=r"ends early, after \d+ of 60 frames"):
        frames.extend(source)
    assert 10 < len(frames) < 50


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("a.mp4", b"", r"is empty \(0 bytes\)"),
        ("a.mp4", bytes(range(256)) * 20, "is no video that can be read"),
        ("a.mp4", b"just some words\n" * 99, "is text, no video"),
        ("a.mp4", b"RIFF\x00\x00\x00\x00AVI LIST", "is no video that can be read|no frame"),
        ("a.png", b"\x89PNG", "is a single picture"),
    ],
)
def test_what_is_no_video(tmp_path, name, content, reason):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=reason) as caught:
        open_source(tmp_path / name)
    assert str(caught.value).startswith(str(tmp_path / name))


def test_truncated_mp4_has_lost_its_index(make_video):
    path = make_video("a.mp4", 20, "mp4v")
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(InputError, match="is cut off"):
        open_source(path)


def test_missing_inputs(tmp_path):
    with pytest.raises(InputError, match="no such file or folder"):
        open_source(tmp_path / "none.mp4")
    with pytest.raises(InputError, match="matches no file"):
        open_source(tmp_path / "*.mp4")
    with pytest.raises(InputError, match="no such file"):
        read_picture(tmp_path / "none.png")


def test_link_to_nowhere(tmp_path):
    (tmp_path / "link.mp4").symlink_to(tmp_path / "gone.mp4")
    with pytest.raises(InputError, match="neither a file nor a folder"):
        open_source(tmp_path / "link.mp4")


def test_folder_in_natural_order(make_folder):
    folder = make_folder("frames", 12)
    (folder / "notes.txt").write_text("no picture")
    (folder / ".11.png").write_bytes(b"no picture either")
    (folder / "below.png").mkdir()
    frames = read_all(folder, SourceOptions(fps=10.0))
    first_pixels = [int(frame.image[0, 0, 0]) for frame in frames]
    assert first_pixels == [number * 7 for number in range(1, 13)]
    assert [frame.time_s for frame in frames][:4] == [0.0, 0.1, 0.2, 0.3]
    assert [frame.index for frame in frames] == list(range(12))


def test_default_rate_is_that_of_the_options(make_folder):
    assert SourceOptions().fps == DecodeSettings().fps == DEFAULT_FPS
    assert read_all(make_folder("frames", 4))[3].time_s == pytest.approx(0.1)


def test_folder_without_pictures(tmp_path):
    (tmp_path / "notes.txt").write_text("no picture")
    with pytest.raises(InputError, match="no pictures in this folder"):
        open_source(tmp_path)


def test_folder_leaves_out_what_is_no_picture(make_folder):
    folder = make_folder("frames", 5)
    (folder / "2.png").write_bytes(b"no picture")
    (folder / "4.png").write_bytes(b"")
    frames = []
    with open_source(folder, SourceOptions(fps=10.0)) as source, pytest.raises(InputError) as caught:
        frames.extend(source)
    assert [(frame.index, frame.time_s) for frame in frames] == [(0, 0.0), (2, 0.2), (4, 0.4)]
    assert "2 of 5 pictures left out" in str(caught.value)
    assert str(folder / "2.png") in str(caught.value)


def test_frames_of_another_size_are_passed_on(make_folder, make_picture):
    make_folder("frames", 2)
    folder = make_picture("frames/3.png", np.zeros((20, 30, 3), np.uint8)).parent
    assert [frame.image.shape for frame in read_all(folder)] == [(48, 64, 3), (48, 64, 3), (20, 30, 3)]


def test_each_kind_of_source_has_a_class():
    assert set(SOURCES) == {"bag", "folder", "standard input", "video"}


@pytest.mark.parametrize("suffix", [".png", ".tif"])
def test_depths_and_channels(make_picture, suffix):
    grey = np.full((10, 12), 90, np.uint8)
    assert (read_picture(make_picture(f"grey{suffix}", grey)) == 90).all()
    deep = np.full((10, 12, 3), 90 * 257, np.uint16)
    deep[0, 0] = 65535
    picture = read_picture(make_picture(f"deep{suffix}", deep))
    assert picture.dtype == np.uint8
    assert picture.shape == (10, 12, 3)
    assert (picture[1:] == 90).all()
    assert (picture[0, 0] == 255).all()
    four = np.dstack([np.full((10, 12), value, np.uint8) for value in (10, 20, 30, 0)])
    assert read_picture(make_picture(f"four{suffix}", four))[3, 3].tolist() == [10, 20, 30]


@pytest.mark.parametrize("bits", [10, 12, 16])
@pytest.mark.parametrize("suffix", [".png", ".pgm"])
def test_a_folder_has_one_bit_depth(tmp_path, capsys, bits, suffix):
    """A light that is dimmed: each picture is darker than the one before, by as much as it was."""
    full = 2**bits - 1
    levels = [full, full // 2, full // 4, full // 16, full // 64, 0]
    for number, level in enumerate(levels):
        picture = np.full((6, 8), level, np.uint16)
        picture[0] = level // 2
        if suffix == ".png":
            cv2.imwrite(str(tmp_path / f"{number}.png"), picture)
        else:
            header = f"P5 # camera\n8 6\n{full}\n".encode()
            (tmp_path / f"{number}.pgm").write_bytes(header + picture.astype(">u2").tobytes())
    seen = [int(frame.image[3, 3, 0]) for frame in read_all(tmp_path)]
    assert seen == [level >> (bits - 8) for level in levels]
    assert capsys.readouterr().err == ""


def test_a_folder_that_grows_brighter_than_its_first_picture_says_so_once(tmp_path, capsys):
    for number, level in enumerate((900, 1000, 4000, 1000, 4095)):
        cv2.imwrite(str(tmp_path / f"{number}.png"), np.full((6, 8), level, np.uint16))
    seen = [int(frame.image[0, 0, 0]) for frame in read_all(tmp_path)]
    assert seen == [900 >> 2, 1000 >> 2, 4000 >> 4, 1000 >> 4, 255]
    assert capsys.readouterr().err.splitlines() == [
        f"lightgesture: {tmp_path}: a picture is brighter than 10 bits can be; read with 12 bits from here on"
    ]


@pytest.mark.parametrize("bits", [10, 12, 14, 16])
def test_a_single_picture_is_scaled_by_itself(make_picture, bits):
    assert (read_picture(make_picture("a.png", np.full((4, 4), 2**bits - 1, np.uint16))) == 255).all()


def test_float_picture(make_picture):
    with pytest.raises(InputError, match=r"frame of float32 \(4, 4, 3\): pixels must be uint8 or uint16"):
        read_picture(make_picture("a.tiff", np.zeros((4, 4, 3), np.float32)))


def test_cut_off_jpeg_is_not_passed_for_a_grey_one(make_picture):
    noise = np.random.default_rng(1).integers(0, 255, (100, 100, 3), dtype=np.uint8)
    path = make_picture("a.jpg", noise)
    content = path.read_bytes()
    assert read_picture(path).shape == (100, 100, 3)
    path.write_bytes(content + b"\xff\xda trailing data of a telephone")
    assert read_picture(path).shape == (100, 100, 3)
    # a thumbnail's own end of image, in a segment before the scan, is not that of the picture
    thumbnail = b"\xff\xe1\x00\x08ab\xff\xd9cd"
    path.write_bytes(content[:2] + thumbnail + content[2 : len(content) * 2 // 3])
    with pytest.raises(InputError, match="is cut off"):
        read_picture(path)


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".webp", ".bmp"])
@pytest.mark.parametrize("share", [0.02, 0.5, 0.9])
def test_cut_off_pictures(make_picture, suffix, share):
    noise = np.random.default_rng(1).integers(0, 255, (60, 60, 3), dtype=np.uint8)
    path = make_picture(f"a{suffix}", noise)
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * share)])
    with pytest.raises(InputError, match=r"is cut off|is no picture"):
        read_picture(path)


def test_picture_of_48_megapixels(tmp_path):
    path = tmp_path / "large.jpg"
    path.write_bytes(cv2.imencode(".jpg", np.zeros((6000, 8000), np.uint8))[1].tobytes())
    assert read_picture(path).shape == (6000, 8000, 3)


HOSTILE = [
    "två dykare.avi",
    "100%d [1]*?.avi",
    "take:1.avi",
    "--json.avi",
    "a'b\"c;$HOME.avi",
    "ダイバー.avi",
]


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_names_of_videos(make_video, name, monkeypatch, tmp_path):
    make_video(name, 3)
    monkeypatch.chdir(tmp_path)
    assert expand_inputs([name]) == [name]
    assert len(read_all(name)) == 3


def test_name_that_is_no_utf8(make_video, make_picture):
    assert len(read_all(make_video("\udcff.avi", 3))) == 3
    assert len(read_all(make_picture("\udcff/\udcff.png").parent)) == 1


@pytest.mark.parametrize("name", ["två dykare", "100%d [1]*?", "take:1"])
def test_hostile_names_of_folders_and_pictures(make_picture, name):
    path = make_picture(f"{name}/{name}.png")
    assert len(read_all(path.parent)) == 1
    assert read_picture(path).shape == (48, 64, 3)


def test_natural_order():
    names = ["f10.png", "F9.png", "f1.png", "f01.png", "b2", "f1a.png"]
    assert sorted(names, key=natural_key) == ["b2", "f01.png", "f1.png", "f1a.png", "F9.png", "f10.png"]


def test_globs_in_the_order_given(tmp_path, monkeypatch):
    for name in ("f10.mp4", "f9.mp4", "a.avi", "[x].mp4", "x.mp4"):
        (tmp_path / name).touch()
    monkeypatch.chdir(tmp_path)
    assert expand_inputs(["f*.mp4", "a.avi"]) == ["f9.mp4", "f10.mp4", "a.avi"]
    assert expand_inputs(["a.avi", "./a.avi", "*.avi", str(tmp_path / "a.avi")]) == ["a.avi"]
    assert expand_inputs(["[x].mp4"]) == ["[x].mp4"]
    assert expand_inputs(["none*.mp4", "gone.mp4"]) == ["none*.mp4", "gone.mp4"]
