"""The bundled clip in every container, codec, pixel form, matrix and transport: the same instruction out of each.

FFmpeg's command line makes them; where it or an encoder is missing, the row is left out.
"""

import json
import shutil
import socket
import subprocess
import sys
import threading
import time
from itertools import pairwise

import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.errors import ExitStatus

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="needs ffmpeg to make the inputs"),
]

TEXT, TIME_S = "STOP HOVER 50 GO", 8.23
"""What the clip says, and when."""

TOLERANCE_S = 0.2
"""Seconds by which another compression or rate may change when a hold is long enough."""

H264 = "-c:v libx264 -preset veryfast"
HEVC = "-c:v libx265 -preset ultrafast -x265-params log-level=none"
GOOD = "-q:v 3"
INTERLACED = "-flags +ildct+ilme"
PAL = "-vf scale=720:576 -r 25"

FILES = {
    "mp4 h264": ("mp4", f"{H264} -pix_fmt yuv420p"),
    "mp4 h264 baseline": ("mp4", f"{H264} -profile:v baseline -pix_fmt yuv420p"),
    "mp4 h264 yuv422p": ("mp4", f"{H264} -pix_fmt yuv422p"),
    "mp4 h264 yuv444p": ("mp4", f"{H264} -pix_fmt yuv444p"),
    "mp4 h264 yuvj420p": ("mp4", f"{H264} -pix_fmt yuvj420p"),
    "mp4 h264 10 bits": ("mp4", f"{H264} -pix_fmt yuv420p10le"),
    "mp4 h264 yuv422p10le": ("mp4", f"{H264} -pix_fmt yuv422p10le"),
    "mp4 h264 rgb": ("mp4", "-c:v libx264rgb -preset veryfast -pix_fmt rgb24"),
    "mp4 h264 faststart": ("mp4", f"{H264} -pix_fmt yuv420p -movflags +faststart"),
    "mp4 h264 fragments": ("mp4", f"{H264} -pix_fmt yuv420p -g 30 -movflags frag_keyframe+empty_moov"),
    "mp4 h264 interlaced tff": ("mp4", f"{H264} -pix_fmt yuv420p {INTERLACED} -x264opts tff=1"),
    "mp4 h264 interlaced bff": ("mp4", f"{H264} -pix_fmt yuv420p {INTERLACED} -x264opts bff=1"),
    "mp4 h264 50 a second": ("mp4", f"{H264} -pix_fmt yuv420p -r 50"),
    "mp4 h264 29.97 a second": ("mp4", f"{H264} -pix_fmt yuv420p -r 30000/1001"),
    "mp4 h264 cropped to odd": ("mp4", f"{H264} -vf crop=637:479 -pix_fmt yuv444p"),
    "mp4 h264 bt709": (
        "mp4",
        f"{H264} -pix_fmt yuv420p -vf colorspace=bt709:iall=bt601-6-625 -colorspace bt709",
    ),
    "mp4 h264 bt2020nc": ("mp4", f"{H264} -pix_fmt yuv420p -colorspace bt2020nc"),
    "mp4 h264 bt2020c": ("mp4", f"{H264} -pix_fmt yuv420p -colorspace bt2020c"),
    "mp4 h264 ycgco": ("mp4", f"{H264} -pix_fmt yuv420p -colorspace ycgco"),
    "mp4 h264 ictcp": ("mp4", f"{H264} -pix_fmt yuv420p -colorspace ictcp"),
    "mp4 h264 smpte240m": ("mp4", f"{H264} -pix_fmt yuv420p -colorspace smpte240m"),
    "mp4 h264 log100": ("mp4", f"{H264} -pix_fmt yuv420p -color_trc log100"),
    "mp4 h264 pq": ("mp4", f"{H264} -pix_fmt yuv420p -color_trc smpte2084 -color_primaries bt2020"),
    "mp4 h264 hlg": ("mp4", f"{H264} -pix_fmt yuv420p -color_trc arib-std-b67"),
    "mp4 hevc": ("mp4", f"{HEVC} -pix_fmt yuv420p"),
    "mp4 hevc 10 bits": ("mp4", f"{HEVC} -pix_fmt yuv420p10le"),
    "mp4 mpeg4": ("mp4", f"-c:v mpeg4 -bf 2 {GOOD}"),
    "mp4 av1": ("mp4", "-c:v libsvtav1 -preset 12 -crf 35"),
    "mp4 vp9": ("mp4", "-c:v libvpx-vp9 -deadline realtime -cpu-used 8 -b:v 2M"),
    "mov h264": ("mov", f"{H264} -pix_fmt yuv420p"),
    "mov prores": ("mov", "-c:v prores_ks -pix_fmt yuv422p10le"),
    "mov prores interlaced": ("mov", f"-c:v prores_ks -pix_fmt yuv422p10le {INTERLACED}"),
    "mov mjpeg": ("mov", f"-c:v mjpeg -pix_fmt yuvj422p {GOOD}"),
    "mov png": ("mov", "-c:v png -pix_fmt rgb24"),
    "mov uyvy422": ("mov", "-c:v rawvideo -pix_fmt uyvy422"),
    "mkv h264": ("mkv", f"{H264} -pix_fmt yuv420p"),
    "mkv hevc": ("mkv", f"{HEVC} -pix_fmt yuv422p"),
    "mkv vp8": ("mkv", "-c:v libvpx -deadline realtime -cpu-used 8 -b:v 2M"),
    "mkv av1": ("mkv", "-c:v libsvtav1 -preset 12 -crf 35 -pix_fmt yuv420p10le"),
    "mkv ffv1": ("mkv", "-c:v ffv1 -pix_fmt yuv420p"),
    "mkv ffv1 yuv444p16le": ("mkv", "-c:v ffv1 -pix_fmt yuv444p16le"),
    "mkv ffv1 bgr0": ("mkv", "-c:v ffv1 -pix_fmt bgr0"),
    "mkv ffv1 yuva420p": ("mkv", "-c:v ffv1 -pix_fmt yuva420p"),
    "mkv huffyuv": ("mkv", "-c:v huffyuv -pix_fmt yuv422p"),
    "mkv utvideo": ("mkv", "-c:v utvideo -pix_fmt gbrp"),
    "mkv mjpeg": ("mkv", f"-c:v mjpeg -pix_fmt yuvj444p {GOOD}"),
    "mkv mpeg2": ("mkv", f"-c:v mpeg2video -bf 2 {GOOD}"),
    "mkv theora": ("mkv", "-c:v libtheora -q:v 8"),
    "mkv yuyv422": ("mkv", "-c:v rawvideo -pix_fmt yuyv422"),
    "webm vp8": ("webm", "-c:v libvpx -deadline realtime -cpu-used 8 -b:v 2M"),
    "webm vp9": ("webm", "-c:v libvpx-vp9 -deadline realtime -cpu-used 8 -b:v 2M"),
    "webm vp9 yuv444p": ("webm", "-c:v libvpx-vp9 -deadline realtime -cpu-used 8 -b:v 2M -pix_fmt yuv444p"),
    "webm av1": ("webm", "-c:v libsvtav1 -preset 12 -crf 35"),
    "avi mjpeg": ("avi", f"-c:v mjpeg -pix_fmt yuvj420p {GOOD}"),
    "avi mpeg4": ("avi", f"-c:v mpeg4 -bf 2 {GOOD}"),
    "avi msmpeg4v2": ("avi", f"-c:v msmpeg4v2 {GOOD}"),
    "avi msmpeg4v3": ("avi", f"-c:v msmpeg4 {GOOD}"),
    "avi h264": ("avi", f"{H264} -bf 2 -pix_fmt yuv420p"),
    "avi bgr24": ("avi", "-c:v rawvideo -pix_fmt bgr24"),
    "avi ffvhuff": ("avi", "-c:v ffvhuff -pix_fmt yuv420p"),
    "avi dv pal": ("avi", f"{PAL} -c:v dvvideo -pix_fmt yuv420p"),
    "dv pal": ("dv", f"{PAL} -c:v dvvideo -pix_fmt yuv420p -f dv"),
    "dv ntsc": ("dv", "-vf scale=720:480 -r 30000/1001 -c:v dvvideo -pix_fmt yuv411p -f dv"),
    "ts h264": ("ts", f"{H264} -pix_fmt yuv420p"),
    "ts hevc": ("ts", f"{HEVC} -pix_fmt yuv420p"),
    "ts mpeg2 interlaced": ("ts", f"-c:v mpeg2video {GOOD} {INTERLACED} -top 1"),
    "m2ts h264 interlaced": ("m2ts", f"{H264} -pix_fmt yuv420p {INTERLACED} -x264opts tff=1"),
    "mpg mpeg1": ("mpg", f"-c:v mpeg1video -bf 2 {GOOD}"),
    "vob mpeg2": ("vob", f"-c:v mpeg2video -bf 2 {GOOD}"),
    "flv flv1": ("flv", f"-c:v flv {GOOD}"),
    "flv h264": ("flv", f"{H264} -pix_fmt yuv420p"),
    "wmv wmv1": ("wmv", f"-c:v wmv1 {GOOD}"),
    "asf wmv2": ("asf", f"-c:v wmv2 {GOOD}"),
    "ogv theora": ("ogv", "-c:v libtheora -q:v 8"),
    "3gp mpeg4": ("3gp", f"-c:v mpeg4 {GOOD}"),
    "nut h264": ("nut", f"{H264} -pix_fmt yuv420p"),
    "mxf mpeg2": ("mxf", f"-c:v mpeg2video {GOOD} -r 25"),
    "y4m yuv420p": ("y4m", "-pix_fmt yuv420p"),
    "bare h264": ("h264", f"{H264} -pix_fmt yuv420p"),
    "bare hevc": ("hevc", f"{HEVC} -pix_fmt yuv420p"),
    "bare mjpeg": ("mjpeg", f"-c:v mjpeg -pix_fmt yuvj420p {GOOD}"),
    "bare mpeg2": ("m2v", f"-c:v mpeg2video {GOOD}"),
    "bare mpeg4": ("m4v", f"-c:v mpeg4 {GOOD}"),
}
"""Name of a row to the suffix of its file and what FFmpeg is told."""


def ffmpeg(*arguments):
    command = ["ffmpeg", "-nostdin", "-v", "error", "-y", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    if "Unknown encoder" in done.stderr:
        pytest.skip(done.stderr.splitlines()[0])
    assert done.returncode == 0, done.stderr


def instructions(lines):
    records = [json.loads(line) for line in lines]
    return [(one["text"], one["time_s"]) for one in records if one["type"] == "instruction"]


def check(run, name, *options, delay_s=0.0):
    result = run("decode", name, "--json", "--fps", 30, *options)
    assert instructions(result.out) == [(TEXT, pytest.approx(TIME_S + delay_s, abs=TOLERANCE_S))]
    assert result.status == ExitStatus.OK


@pytest.mark.parametrize("row", FILES)
def test_files(tmp_path, run, row):
    suffix, options = FILES[row]
    path = tmp_path / f"clip.{suffix}"
    ffmpeg("-i", SAMPLE, *options.split(), path)
    check(run, path, *(["--hold-seconds", 0.5] if "-r " in options else []))


def whole(tmp_path, *options):
    path = tmp_path / "whole.mp4"
    ffmpeg("-i", SAMPLE, *H264.split(), "-pix_fmt", "yuv420p", "-bf", 3, "-g", 60, *options, path)
    return path


SOUND = {
    "longer": ("mkv", ["-f", "lavfi", "-i", "sine=d=30", "-i", "WHOLE"], "libopus", 0.0),
    "first": ("mp4", ["-f", "lavfi", "-i", "sine=d=12", "-itsoffset", 2, "-i", "WHOLE"], "aac", 2.0),
    "first in a transport stream": (
        "ts",
        ["-f", "lavfi", "-i", "sine=d=12", "-itsoffset", 2, "-i", "WHOLE"],
        "aac",
        2.0,
    ),
    "first in mkv": ("mkv", ["-f", "lavfi", "-i", "sine=d=12", "-itsoffset", 2, "-i", "WHOLE"], "aac", 2.0),
}


@pytest.mark.parametrize("row", SOUND)
def test_sound(tmp_path, run, row):
    suffix, inputs, codec, delay_s = SOUND[row]
    path = whole(tmp_path)
    inputs = [path if each == "WHOLE" else each for each in inputs]
    target = tmp_path / f"sound.{suffix}"
    ffmpeg(*inputs, "-map", "1:v", "-map", "0:a", "-c:v", "copy", "-c:a", codec, "-b:a", "32k", target)
    check(run, target, delay_s=delay_s)


def test_a_damaged_place(tmp_path, run):
    path = tmp_path / "damaged.mp4"
    ffmpeg("-i", SAMPLE, *H264.split(), "-pix_fmt", "yuv420p", "-bf", 0, "-movflags", "+faststart", path)
    content = bytearray(path.read_bytes())
    start = len(content) // 3
    content[start : start + 60_000] = bytes(number * 7 & 255 for number in range(60_000))
    path.write_bytes(content)
    result = run("decode", path, "--json")
    records = [json.loads(line) for line in result.out]
    assert (result.status, instructions(result.out)) == (ExitStatus.OK, [])
    assert [record["reason"] for record in records if record["type"] == "notice"][:1] == ["gap"]
    assert next(record["reason"] for record in records if record["type"] == "rejected") == "timeout"
    assert records[-1]["frames"] > 200


def test_an_edit_list(tmp_path, run):
    target = tmp_path / "trimmed.mp4"
    ffmpeg("-ss", 0.3, "-i", whole(tmp_path), "-c", "copy", target)
    check(run, target, delay_s=-0.3)


def test_a_variable_rate(tmp_path, run):
    target = tmp_path / "variable.mp4"
    drop = "select='mod(n,3)'"  # steps of one and two frames
    ffmpeg("-i", SAMPLE, "-vf", drop, "-vsync", "vfr", *H264.split(), "-pix_fmt", "yuv420p", target)
    check(run, target, "--hold-seconds", 0.5)


def test_an_annotated_copy_is_none_of_the_diver(tmp_path, run):
    out = tmp_path / "out"
    assert run("decode", SAMPLE, "--annotate", "--out", out).status == ExitStatus.OK
    result = run("decode", next(out.glob("sample*.mp4")))
    assert result.status == ExitStatus.SOME_FAILED
    assert [line for line in result.err if "is an annotated copy; decode the video" in line]


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif", "webp", "bmp"])
def test_folders_of_frames(tmp_path, run, suffix):
    (tmp_path / "frames").mkdir()
    options = ["-c:v", "libwebp", "-quality", 90] if suffix == "webp" else ["-q:v", 3]
    ffmpeg("-i", SAMPLE, *options, tmp_path / "frames" / f"%d.{suffix}")
    check(run, tmp_path / "frames")


@pytest.mark.parametrize(
    "options", ["-c:v mjpeg -q:v 3 -f mjpeg", "-c:v rawvideo -pix_fmt bgr24 -f rawvideo"]
)
def test_standard_input(tmp_path, options):
    path = tmp_path / "pictures"
    ffmpeg("-i", SAMPLE, *options.split(), path)
    size = ["--size", "640x480"] if "raw" in options else []
    command = [sys.executable, "-m", "lightgesture", "decode", "-", "--json", *size]
    with path.open("rb") as stream:
        done = subprocess.run(command, stdin=stream, capture_output=True, text=True, timeout=120, check=True)
    assert instructions(done.stdout.splitlines()) == [(TEXT, pytest.approx(TIME_S, abs=TOLERANCE_S))]


TRANSPORTS = {
    "udp ts h264": (
        "udp://127.0.0.1:{port}?pkt_size=1316",
        "udp://127.0.0.1:{port}",
        f"{H264} -g 15 -f mpegts",
    ),
    "udp ts mpeg2": (
        "udp://127.0.0.1:{port}?pkt_size=1316",
        "udp://127.0.0.1:{port}",
        f"-c:v mpeg2video {GOOD} -f mpegts",
    ),
    "tcp ts h264": ("tcp://127.0.0.1:{port}?listen=1", "tcp://127.0.0.1:{port}", f"{H264} -g 15 -f mpegts"),
    "tcp ts hevc": (
        "tcp://127.0.0.1:{port}?listen=1",
        "tcp://127.0.0.1:{port}",
        f"-vf scale=320:240 {HEVC} -g 15 -f mpegts",
    ),
    "tcp h264 interlaced": (
        "tcp://127.0.0.1:{port}?listen=1",
        "tcp://127.0.0.1:{port}",
        f"{H264} -g 15 {INTERLACED} -x264opts tff=1 -f mpegts",
    ),
}


@pytest.mark.parametrize("row", TRANSPORTS)
def test_transports(row):
    """In real time: the clip twice, so that what a decoder misses at the start does no harm."""
    theirs, ours, options = TRANSPORTS[row]
    with socket.socket(type=socket.SOCK_DGRAM if row.startswith("udp") else socket.SOCK_STREAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = ["ffmpeg", "-nostdin", "-v", "error", "-re", "-stream_loop", "1", "-i", str(SAMPLE)]
    command += ["-pix_fmt", "yuv420p", "-tune", "zerolatency"] if "libx26" in options else []
    sender = subprocess.Popen([*command, *options.split(), theirs.format(port=port)])
    live = [sys.executable, "-m", "lightgesture", "live", ours.format(port=port), "--json", "--quiet"]
    found, threads = [], []
    with subprocess.Popen(live, stdout=subprocess.PIPE, text=True) as receiver:
        threads.append(threading.Thread(target=lambda: found.extend(receiver.stdout)))
        threads[0].start()
        try:
            sender.wait(60)
            time.sleep(1)
        finally:
            sender.kill()
            sender.wait()
            receiver.terminate()
            receiver.wait(20)
            threads[0].join()
    spoken = instructions(found)
    assert spoken
    assert {text for text, _ in spoken} == {TEXT}
    assert all(
        later - earlier == pytest.approx(9.5, abs=1.0) for (_, earlier), (_, later) in pairwise(spoken)
    )
