"""Videos of moving noise in any container and codec, written by PyAV on the spot."""

from fractions import Fraction

import av
import numpy as np
import pytest

RATE = 30
TICKS = Fraction(1, 15_360)


def noise(count, size=(64, 48), seed=0):
    """Grey pictures whose columns move to the right by one each, for a decoder to get wrong."""
    first = np.random.default_rng(seed).integers(30, 220, (size[1] // 4, size[0] // 4, 1))
    first = first.repeat(4, 0).repeat(4, 1).repeat(3, 2).astype(np.uint8)
    return [np.roll(first, number, 1) for number in range(count)]


def add_sound(container, seconds, codec):
    """Silence from 0 on."""
    stream = container.add_stream(codec, rate=48_000)
    samples = np.zeros((1, 48_000), np.int16)
    for second in range(seconds):
        frame = av.AudioFrame.from_ndarray(samples, format="s16", layout="mono")
        frame.sample_rate, frame.pts, frame.time_base = 48_000, second * 48_000, Fraction(1, 48_000)
        yield from stream.encode(frame)
    yield from stream.encode(None)


@pytest.fixture
def write_video(tmp_path):
    """Writes a video.

    frames: BGR pictures or frames of PyAV. times: their stamps, seconds. sound: seconds and codec of silence.
    """

    def write(
        name,
        frames,
        codec="libx264",
        pixels="yuv420p",
        times=None,
        sound=None,
        options=None,
        metadata=(),
        colours=None,
        **container_options,
    ):
        path = tmp_path / name
        with av.open(str(path), "w", options=container_options) as container:
            container.metadata.update(metadata)
            stream = container.add_stream(codec, RATE, options={"threads": "1", **(options or {})})
            pictures = [
                frame
                if isinstance(frame, av.VideoFrame)
                else av.VideoFrame.from_ndarray(frame, format="bgr24")
                for frame in frames
            ]
            stream.width, stream.height, stream.pix_fmt = pictures[0].width, pictures[0].height, pixels
            has_rate = path.suffix in (".avi", ".mpg", ".y4m")  # or each tick would be a frame
            ticks = stream.codec_context.time_base = Fraction(1, RATE) if has_rate else TICKS
            if colours is not None:
                stream.codec_context.colorspace = colours
            sounds = list(add_sound(container, *sound)) if sound else []
            for packet in sounds:
                container.mux(packet)
            for number, picture in enumerate(pictures):
                time_s = number / RATE if times is None else times[number]
                picture.pts, picture.time_base = round(time_s / ticks), ticks
                container.mux(stream.encode(picture))
            container.mux(stream.encode(None))
        return path

    return write
