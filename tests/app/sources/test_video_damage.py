"""Videos with damaged or lost places are read over, and it is told."""

import av
import pytest

from lightgesture.sources import video
from lightgesture.sources.decoding import StreamDecoder
from tests.app.sources.video_makers import read, times

from .conftest import RATE, noise


@pytest.fixture(autouse=True, params=[video.SMALL_PIXELS, 0], ids=["one thread", "threads"])
def decoding_threads(request, monkeypatch):
    """Small pictures in one thread, as they are decoded, and in several, as large ones are."""
    monkeypatch.setattr(video, "SMALL_PIXELS", request.param)


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
