"""Video files as cameras, phones and capture cards write them, whole and broken."""

import gc
import json
import os
import threading
import weakref
from contextlib import suppress
from datetime import UTC, datetime

import av
import numpy as np
import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.errors import ExitStatus, InputError
from lightgesture.sources import SourceOptions, open_source
from lightgesture.sources.clock import RecordingClock, creation_time
from lightgesture.sources.conversion import Converter
from lightgesture.sources.decoding import StreamDecoder
from lightgesture.sources.file_size import is_cut_off

from .conftest import RATE, noise


def read(path, **options):
    with open_source(path, SourceOptions(**options)) as source:
        return list(source)


def times(frames):
    return [round(frame.time_s * RATE, 1) for frame in frames]


def differ(frame, picture):
    return float(np.abs(frame.image.astype(int) - picture).mean())


@pytest.mark.parametrize("suffix", ["avi", "mkv", "mov", "mp4", "mpg", "ts", "webm"])
@pytest.mark.parametrize("is_reordered", [False, True])
def test_times_begin_at_nothing_and_are_in_order(write_video, suffix, is_reordered):
    """Transport and programme streams begin somewhere, and AVI tells only when a frame is to be decoded."""
    codec = {"avi": "mpeg4", "mpg": "mpeg2video", "webm": "libvpx-vp9"}.get(suffix, "libx264")
    options = {"bf": "2" if is_reordered else "0"} if codec != "libvpx-vp9" else {"deadline": "realtime"}
    pictures = noise(20)
    frames = read(write_video(f"a.{suffix}", pictures, codec, options=options | {"b": "2000000"}))
    assert times(frames) == list(range(20))
    assert all(differ(frame, picture) < 12 for frame, picture in zip(frames, pictures, strict=True))


def test_av1(write_video):
    assert times(read(write_video("a.mkv", noise(6), "libsvtav1", options={"preset": "12"}))) == list(
        range(6)
    )


def test_interlaced_frames_are_deinterlaced(write_video):
    """Two fields of different moments: no picture has the comb of both."""
    pictures = [np.full((64, 96, 3), 40, np.uint8) for _ in range(12)]
    for number, picture in enumerate(pictures):
        picture[0::2, 4 * number : 4 * number + 30] = 200
        picture[1::2, 4 * number + 2 : 4 * number + 32] = 200
    options = {"flags": "+ildct+ilme", "x264-params": "tff=1", "crf": "10"}
    path = write_video("a.ts", pictures, options=options)
    with av.open(str(path)) as container:
        assert next(container.decode(video=0)).interlaced_frame
    frames = read(path)
    assert times(frames) == list(range(12))
    for frame, picture in zip(frames, pictures, strict=True):
        combs = np.abs(np.diff(picture[8:-8].astype(int), axis=0)).mean()
        assert np.abs(np.diff(frame.image[8:-8].astype(int), axis=0)).mean() < combs / 4
        assert 80 < frame.image[32, :, 0].astype(int).max() <= 255


COLOUR = (40, 90, 180)


def planes(y, u, v, size=(48, 64)):
    levels = np.stack([np.full(size, level, np.uint8) for level in (y, u, v)])
    return av.VideoFrame.from_ndarray(levels.reshape(-1, size[1]).reshape(3, *size), format="yuv444p")


def test_ycgco_in_its_true_colours(write_video):
    blue, green, red = COLOUR
    co, cg = red - blue, green - (red + blue) / 2
    level = round(16 + (green / 2 + (red + blue) / 4) * 219 / 255)
    frame = planes(level, round(128 + cg / 2 * 224 / 255), round(128 + co / 2 * 224 / 255))
    path = write_video("a.mkv", [frame] * 2, pixels="yuv444p", options={"qp": "0"}, colours=8)
    assert np.abs(read(path)[0].image.astype(int) - COLOUR).max() <= 3


@pytest.mark.parametrize("colours", [10, 11, 14])
def test_a_matrix_that_is_not_known_is_taken_for_the_usual_one_and_told(write_video, capsys, colours):
    pictures = noise(3)
    frames = read(write_video("a.mkv", pictures, colours=colours))
    assert all(differ(frame, picture) < 12 for frame, picture in zip(frames, pictures, strict=True))
    assert capsys.readouterr().err.count(f"number {colours} of H.273") == 1


def test_frames_that_cannot_be_shown_fail(write_video, run, fake, monkeypatch):
    def refuse(converter, frame):
        raise ValueError("pixels of the form bayer cannot be converted")

    monkeypatch.setattr(Converter, "bgr8", refuse)
    result = run("decode", write_video("a.mp4", noise(4)))
    assert result.status == ExitStatus.SOME_FAILED
    assert "no frame of this video (h264) can be shown: pixels of the form bayer" in result.err[0]


def test_a_frame_that_cannot_be_shown_is_an_end_with_status_1(write_video, run, fake, monkeypatch):
    convert, seen = Converter.bgr8, []

    def refuse_some(converter, frame):
        seen.append(frame)
        if 4 <= len(seen) < 14:
            raise ValueError("pixels of the form bayer cannot be converted")
        return convert(converter, frame)

    monkeypatch.setattr(Converter, "bgr8", refuse_some)
    result = run("decode", write_video("a.mp4", noise(20)), "--json")
    assert result.status == ExitStatus.SOME_FAILED
    assert "10 of its frames cannot be shown: pixels of the form bayer" in result.err[-1]
    assert sum('"reason":"gap"' in line for line in result.out) == 1


def test_what_cannot_be_deinterlaced_is_passed_on(write_video, monkeypatch):
    monkeypatch.setattr("lightgesture.sources.conversion.DEINTERLACER", "loudnorm")
    path = write_video("a.ts", noise(6), options={"flags": "+ildct+ilme", "x264-params": "tff=1"})
    assert times(read(path)) == list(range(6))


def test_interlaced_ycgco(write_video, capsys):
    options = {"flags": "+ildct+ilme", "x264-params": "tff=1"}
    assert times(read(write_video("a.mkv", noise(6), options=options, colours=8))) == list(range(6))
    assert capsys.readouterr().err == ""


def damage(path, start=0.5, length=None, pattern=7):
    content = bytearray(path.read_bytes())
    length = length or len(content) // 5
    first = round(len(content) * start)
    content[first : first + length] = bytes(number * pattern & 255 for number in range(length))
    path.write_bytes(content)
    return path


def test_a_damaged_place_is_read_over_and_told(write_video, capsys):
    path = damage(write_video("a.mp4", noise(90, (160, 120)), options={"bf": "0", "g": "10"}))
    frames = read(path)
    (gap,) = [frame for frame in frames if frame.gap]
    assert gap.gap.startswith("damaged from")
    assert times(frames) == [frame.index for frame in frames]
    assert frames[-1].index == 89
    assert "left out" in capsys.readouterr().err


def test_a_damaged_avi_keeps_the_time_of_its_index(write_video):
    path = damage(write_video("a.avi", noise(90, (160, 120)), "mjpeg", "yuvj420p"))
    frames = read(path)
    assert 60 < len(frames) < 80
    assert times(frames)[-1] == 89


def test_frames_that_a_codec_drops_without_an_error_are_told(write_video, monkeypatch):
    decode, packets = StreamDecoder.decode, []

    def drop_some(decoder, packet):
        packets.append(packet)
        return [frame for frame in decode(decoder, packet) if not 20 <= len(packets) < 60]

    monkeypatch.setattr(StreamDecoder, "decode", drop_some)
    path = write_video("a.hevc", noise(90), "libx265", options={"x265-params": "log-level=none:bframes=0"})
    frames = read(path)
    assert frames[0].gap is None
    assert frames[-1].index >= 88
    assert sum(frame.gap is not None and frame.gap.startswith("damaged from") for frame in frames) == 1


def test_whole_videos_have_no_gap(write_video):
    for name, codec in (
        ("a.hevc", "libx265"),
        ("a.h264", "libx264"),
        ("a.avi", "mpeg4"),
        ("b.mp4", "libx265"),
    ):
        options = {"x265-params": "log-level=none"} if codec == "libx265" else {"bf": "2"}
        frames = read(write_video(name, noise(60, (160, 120)), codec, options=options))
        assert [frame.index for frame in frames if frame.gap is None] == list(range(60))


def test_lost_frames_of_less_than_a_gap_are_told_at_the_end(write_video, capsys):
    path = write_video("a.mkv", noise(12), "mjpeg", "yuvj420p")
    content = bytearray(path.read_bytes())
    starts = [place for place in range(len(content)) if content[place : place + 3] == b"\xff\xd8\xff"]
    length = starts[5] - starts[4] - 40
    content[starts[4] : starts[4] + length] = bytes(length)
    path.write_bytes(content)
    frames = read(path)
    assert [frame.index for frame in frames] == [0, 1, 2, 3, *range(5, 12)]
    assert not any(frame.gap for frame in frames)
    assert capsys.readouterr().err.endswith("left out 1 damaged frame\n")


def trim(path, first):
    """As phones trim: the packets from a key frame on, those before `first` outside the edit list."""
    target = path.with_name(f"trimmed_{path.name}")
    with av.open(str(path)) as source, av.open(str(target), "w") as container:
        stream = source.streams.video[0]
        copy = container.add_stream_from_template(stream)
        shift = round(first / RATE / stream.time_base)
        for packet in source.demux(stream):
            if packet.dts is not None:
                packet.pts, packet.dts, packet.stream = packet.pts - shift, packet.dts - shift, copy
                container.mux(packet)
    return target


def test_an_edit_list_promises_more_than_it_shows(write_video):
    path = trim(write_video("a.mp4", noise(40), options={"bf": "0", "g": "60"}), 9)
    frames = read(path)
    assert times(frames) == list(range(31))


def test_sound_that_lasts_longer_is_no_early_end(write_video):
    path = write_video("a.mkv", noise(20), sound=(5, "pcm_s16le"))
    assert times(read(path)) == list(range(20))


def test_time_counts_from_the_sound_that_begins_first(write_video):
    stamps = [2 + number / RATE for number in range(20)]
    frames = read(write_video("a.mp4", noise(20), times=stamps, sound=(4, "aac")))
    assert times(frames) == [60 + number for number in range(20)]


@pytest.mark.parametrize(
    ("name", "codec"), [("a.h264", "libx264"), ("a.hevc", "libx265"), ("a.mjpeg", "mjpeg")]
)
def test_a_stream_without_a_clock_takes_the_rate_of_the_user(write_video, capsys, name, codec):
    pixels, options = ("yuvj420p", {}) if codec == "mjpeg" else ("yuv420p", {"x265-params": "log-level=none"})
    path = write_video(name, noise(12), codec, pixels, options=options)
    assert [frame.time_s for frame in read(path, fps=10)] == [round(index / 10, 6) for index in range(12)]
    assert capsys.readouterr().err == (
        f"lightgesture: {path}: has no clock; taken for 10 frames a second (--fps)\n"
    )


@pytest.mark.parametrize("suffix", ["mp4", "mkv"])
def test_when_it_was_taken(write_video, suffix):
    path = write_video(f"a.{suffix}", noise(3), metadata={"creation_time": "2026-05-04T10:20:30Z"})
    with open_source(path) as source:
        assert source.start_utc == datetime(2026, 5, 4, 10, 20, 30, tzinfo=UTC)


def test_records_have_the_time_of_day(write_video, run):
    path = write_video("a.mp4", noise(4), metadata={"creation_time": "2026-05-04T10:20:30Z"})
    records = [json.loads(line) for line in run("decode", path, "--json", "--frames").out]
    assert [record["utc"] for record in records[:2]] == [
        "2026-05-04T10:20:30.000Z",
        "2026-05-04T10:20:30.033Z",
    ]
    assert records[-1]["utc"] == "2026-05-04T10:20:30.100Z"


@pytest.mark.parametrize(
    ("text", "moment"),
    [
        ("2026-05-04T12:20:30+02:00", datetime(2026, 5, 4, 10, 20, 30, tzinfo=UTC)),
        ("2026-05-04 10:20:30", datetime(2026, 5, 4, 10, 20, 30, tzinfo=UTC)),
        ("1970-01-01T00:00:00Z", None),
        ("1904-01-01T00:00:00Z", None),
        ("yesterday", None),
    ],
)
def test_times_of_day_as_cameras_write_them(text, moment):
    assert creation_time({"CREATION_TIME": text}) == moment
    assert creation_time({"title": text}) is None


def test_stamps_that_jump_back_by_a_day():
    clock = RecordingClock(None, 0.1)
    assert [clock.read(stamp) for stamp in (86_400.0, 86_400.1, 86_400.05)] == [0.0, 0.1, 0.05]
    assert (clock.read(3.0), clock.jump_s) == (0.15, pytest.approx(86_397.05))
    assert (clock.read(3.1), clock.jump_s) == (0.25, 0.0)
    assert (clock.read(None), clock.read(None, 3)) == (0.35, 0.65)


def test_a_picture_of_another_size_between_is_a_gap(tmp_path, write_video):
    parts = [
        write_video(f"{number}.h264", noise(8, size)) for number, size in enumerate([(64, 48), (96, 64)])
    ]
    path = tmp_path / "both.h264"
    path.write_bytes(b"".join(part.read_bytes() for part in (parts[0], parts[1], parts[0])))
    frames = read(path)
    assert [(frame.index, frame.gap) for frame in frames if frame.gap] == [
        (8, "the picture changes from 64 x 48 to 96 x 64"),
        (16, "the picture changes from 96 x 64 to 64 x 48"),
    ]


@pytest.mark.parametrize("suffix", ["avi", "mkv", "mov", "mp4"])
def test_a_file_that_was_cut_off(write_video, suffix):
    path = write_video(f"a.{suffix}", noise(60), "mjpeg", "yuvj420p", movflags="faststart")
    assert not is_cut_off(str(path))
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * 2 // 3])
    assert is_cut_off(str(path))
    frames = []
    with open_source(path) as source, pytest.raises(InputError, match=r"ends early, after \d\d of 60 frames"):
        frames.extend(source)
    assert 30 < len(frames) < 50


def test_a_file_that_lost_only_its_index_is_whole(write_video):
    path = write_video("a.avi", noise(30), "mjpeg", "yuvj420p")
    path.write_bytes(path.read_bytes()[:-100])
    assert is_cut_off(str(path))
    assert len(read(path)) == 30


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"RIFF",
        b"\0\0\0\x10ftyp",
        b"\0\0\0\1ftyp" + bytes(4),
        b"\x1aE\xdf\xa3",
        b"\x1aE\xdf\xa3\0",
        b"\x1aE\xdf\xa3\x80\x18S\x80g\x01" + b"\xff" * 7,
        bytes(99),
    ],
)
def test_headers_of_any_length_are_endured(tmp_path, content):
    path = tmp_path / "a.mp4"
    path.write_bytes(content)
    with suppress(IndexError):
        assert is_cut_off(str(path)) in (True, False)
    with pytest.raises(InputError):
        open_source(path)


def test_a_file_that_grows_while_it_is_read(write_video):
    path = write_video("a.ts", noise(90))
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    frames = []
    with open_source(path) as source:
        pictures = iter(source)
        frames.append(next(pictures))
        path.write_bytes(content)
        with pytest.raises(InputError, match="is still being written"):
            frames.extend(pictures)
    assert len(frames) > 30


def test_a_pipe_is_sent_to_standard_input(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match=r"is a pipe; send pictures to standard input"):
        open_source(tmp_path / "pipe")


def test_raw_video_whose_pixels_look_like_text(write_video):
    path = write_video("a.y4m", [np.full((48, 64, 3), 90, np.uint8)] * 3, "wrapped_avframe")
    assert times(read(path)) == [0, 1, 2]


def test_a_header_without_a_size(write_video):
    path = write_video("a.avi", noise(9), "mjpeg", "yuvj420p")
    content = bytearray(path.read_bytes())
    for name, place in ((b"avih", 40), (b"strf", 12)):
        start = content.find(name) + place
        content[start : start + 8] = bytes(8)
    path.write_bytes(content)
    frames = read(path)
    assert (len(frames), frames[0].image.shape) == (9, (48, 64, 3))


def test_a_picture_of_one_row(write_video, run):
    wide = np.tile(noise(1)[0][:1], (1, 1563, 1))[:, :100_000]
    result = run("decode", write_video("a.mkv", [wide] * 2, "ffv1", "bgr0"))
    assert (result.status, result.err) == (ExitStatus.OK, [])


def test_a_video_of_one_frame(write_video, run):
    result = run("decode", write_video("a.mp4", noise(1)))
    assert (result.status, result.err) == (ExitStatus.OK, [])
    assert "1 frame in 0.00 s" in result.out[-1]


def test_sound_alone(tmp_path):
    path = tmp_path / "a.wav"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=48_000)
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 4800), np.int16), format="s16", layout="mono")
        frame.sample_rate = 48_000
        container.mux([*stream.encode(frame), *stream.encode(None)])
    with pytest.raises(InputError, match="holds no pictures"):
        open_source(path)


def test_sources_of_several_threads(write_video):
    path, found = write_video("a.mp4", noise(20)), []
    threads = [threading.Thread(target=lambda: found.append(len(read(path)))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [20] * 3


def test_a_video_that_was_read_is_given_back_at_once():
    """Not when Python collects what hangs in circles: by then the decoders of many videos would fill the memory."""
    gc.disable()
    try:
        with open_source(str(SAMPLE)) as source:
            next(iter(source))
        left = weakref.ref(source)
        del source
        assert left() is None
    finally:
        gc.enable()
