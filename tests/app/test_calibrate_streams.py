"""`lightgesture calibrate` from cameras and streams: what `live` reads, for some seconds."""

import io
import sys

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.mjpeg_server import MjpegServer
from lightgesture.errors import ExitStatus
from lightgesture.features.profile import load_profile
from lightgesture.synth.scene import Scene
from lightgesture.synth.spec import DiverSpec, SceneSpec

BOXES = ((60, 60, 90, 120), (400, 80, 90, 120))
HANDS = [word for box in BOXES for word in ("--hands", ",".join(map(str, box)))]


def gloves(seed):
    """Two blue gloves beside a dark suit."""
    image = np.full((300, 560, 3), (120, 150, 160), np.uint8)
    cv2.rectangle(image, (200, 60), (350, 299), (40, 45, 50), cv2.FILLED)
    for x, y, width, height in BOXES:
        middle, axes = (x + width // 2, y + height // 2), (width // 2, height // 2)
        cv2.ellipse(image, middle, axes, 0, 0, 360, (200, 90, 40), -1)
    noise = np.random.default_rng(seed).normal(0, 6, image.shape)
    return np.clip(image + noise, 0, 255).astype(np.uint8)


def jpegs(images):
    return [cv2.imencode(".jpg", image)[1].tobytes() for image in images]


@pytest.fixture(scope="module")
def blue():
    """JPEG files of gloves, which no selector takes for hands."""
    return jpegs(gloves(seed) for seed in range(6))


@pytest.fixture
def piped(monkeypatch):
    """Puts bytes in the place of standard input."""

    def put(content):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(content)))

    return put


def test_some_seconds_of_a_stream_make_a_profile(run, blue, tmp_path):
    out = tmp_path / "blue.json"
    with MjpegServer(blue, fps=30) as server:
        result = run("calibrate", server.address, "--out", out, "--kind", "glove", "--seconds", "0.5", *HANDS)
    assert result.status == ExitStatus.OK
    assert result.err == [
        f"lightgesture: {server.address}: hold both open hands still before the camera for 0.5 s"
    ]
    assert load_profile(out).separation > 0.95
    assert not any("remark" in line for line in result.out)
    assert result.out[-1] == f"written      {out}; use it with: --profile {out}"


def test_bare_hands_in_a_stream_are_found(run, tmp_path):
    scene = Scene(SceneSpec(seed=4, size=(320, 240), diver=DiverSpec()))
    shares = (0.15, 0.35, 0.55, 0.8)
    pictures = jpegs(scene.frame(round(scene.frame_count * share)).image for share in shares)
    with MjpegServer(pictures, fps=20) as server:
        result = run("calibrate", server.address, "--out", tmp_path / "skin.json", "--seconds", "0.5")
    assert result.status == ExitStatus.OK
    assert "hands        both in" in result.out[0]


@pytest.mark.parametrize("pictures", [0, 2])
def test_a_stream_that_ends_too_early_is_told(run, blue, tmp_path, pictures):
    out = tmp_path / "blue.json"
    with MjpegServer(blue, fps=60, limit=pictures) as server:
        result = run("calibrate", server.address, "--out", out, *HANDS)
    assert result.status == ExitStatus.SOME_FAILED
    assert result.err[1:] == [f"lightgesture: {server.address}: the stream ended after {pictures} pictures"]
    assert result.out == []
    assert not out.exists()


def test_a_stream_that_ends_after_enough_is_learnt_from_and_told(run, blue, tmp_path):
    out = tmp_path / "blue.json"
    with MjpegServer(blue, fps=60, limit=6) as server:
        result = run("calibrate", server.address, "--out", out, "--kind", "glove", *HANDS)
    assert result.status == ExitStatus.OK
    assert "both in 6 of 6 pictures" in result.out[0]
    assert result.out[-2].endswith("the stream ended after 6 pictures; what came before was learnt from")
    assert out.exists()


def test_a_stream_without_hands_tells_how_it_ended_too(run, tmp_path):
    grey = jpegs([np.full((48, 64, 3), 90, np.uint8)])
    with MjpegServer(grey, fps=60, limit=5) as server:
        result = run("calibrate", server.address, "--out", tmp_path / "none.json")
        assert "ended after 5 pictures: hands found in 0 of 5 pictures, 4 are needed" in result.err[1]
        endless = MjpegServer(grey, fps=60)
        with endless:
            result = run("calibrate", endless.address, "--out", tmp_path / "none.json", "--seconds", "0.2")
    assert result.status == ExitStatus.SOME_FAILED
    assert f"{endless.address}: hands found in 0 of" in result.err[1]


def test_a_password_is_shown_and_written_nowhere(run, blue, tmp_path):
    out = tmp_path / "blue.json"
    with MjpegServer(blue, fps=60, limit=6) as server:
        address = server.address.replace("http://", "http://diver:secret@")
        result = run("calibrate", address, "--out", out, "--kind", "glove", *HANDS)
    assert result.status == ExitStatus.OK
    assert "secret" not in "\n".join([*result.out, *result.err, out.read_text(encoding="utf-8")])


@pytest.mark.parametrize(
    ("source", "status", "message"),
    [
        ("/dev/video93", ExitStatus.SOME_FAILED, "/dev/video93: cannot be opened; is it there"),
        ("http://127.0.0.1:9/", ExitStatus.SOME_FAILED, "http://127.0.0.1:9/: cannot be opened ("),
        ("ftp://camera/a.jpg", ExitStatus.USAGE, "ftp://camera/a.jpg: is no stream; name a camera"),
        ("missing.mp4", ExitStatus.SOME_FAILED, "missing.mp4: no such file or folder"),
    ],
)
def test_what_cannot_be_opened_is_one_line(run, tmp_path, source, status, message):
    result = run("calibrate", source, "--out", tmp_path / "p.json")
    assert result.status == status
    assert len(result.err) == 1
    assert message in result.err[0]


def test_standard_input_as_mjpeg_and_raw(run, blue, piped, tmp_path):
    out = tmp_path / "blue.json"
    options = ("--out", out, "--kind", "glove", *HANDS)
    piped(b"".join(blue))
    assert run("calibrate", "-", *options).status == ExitStatus.OK
    out.unlink()
    piped(b"".join(gloves(seed).tobytes() for seed in range(6)))
    assert run("calibrate", "-", "--size", "560x300", *options).status == ExitStatus.OK
    assert out.exists()
