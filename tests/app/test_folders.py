"""Folders of videos, chapters of one recording, and files that are not replaced."""

import json
import os

import av
import numpy as np
import pytest

from lightgesture.archive.tasks import make_tasks
from lightgesture.errors import ExitStatus, InputError
from lightgesture.frames import Frame
from lightgesture.results.annotated import open_annotated_video
from lightgesture.results.ownership import is_annotated_copy
from lightgesture.sources import Source, open_source
from lightgesture.sources.chapters import JoinedVideos, group_chapters
from lightgesture.sources.contents import look_into


def names_of(tasks):
    return [os.path.basename(task.name) for task in tasks]


@pytest.fixture
def card(make_video, make_picture, tmp_path):
    """A camera's card: videos in two folders, photographs beside them, and what cameras and systems leave."""
    make_video("card/dive10.avi", 3)
    make_video("card/dive9.AVI", 2)
    make_video("card/deeper/dive1.avi", 4)
    make_picture("card/photo.jpg")
    make_picture("card/deeper/photo.jpg")
    for name in ("card/._dive9.avi", "card/GL010001.LRV", "card/notes.txt", "card/.Trashes/gone.avi"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"junk")
    return tmp_path / "card"


def test_a_folder_of_videos_is_decoded_as_its_videos(run, card, fake):
    result = run("decode", card, "--json")
    assert result.status == ExitStatus.OK
    sources = [record["source"] for record in map(json.loads, result.out) if record["type"] == "summary"]
    assert sources == [str(card / "dive9.AVI"), str(card / "dive10.avi")]
    assert result.err[0] == f"lightgesture: {card}: holds videos; 1 picture beside them passed over"
    assert run("decode", card, "--quiet").err == []


def test_folders_in_it_by_option(card):
    said = []
    tasks = make_tasks([str(card)], recursive=True, tell=said.append)
    assert names_of(tasks) == ["dive1.avi", "dive9.AVI", "dive10.avi"]
    assert said == [f"{card}: holds videos; 2 pictures beside them passed over"]
    assert names_of(make_tasks([str(card), str(card / "dive9.AVI")])) == ["dive9.AVI", "dive10.avi"]


def test_folders_of_frames_stay_what_they_are(make_folder, tmp_path, run, fake):
    for name in ("tank/2", "tank/10"):
        make_folder(name, 3)
    tank = str(tmp_path / "tank")
    assert names_of(make_tasks([os.path.join(tank, "2")])) == ["2"]
    assert names_of(make_tasks([tank], recursive=True)) == ["2", "10"]
    result = run("decode", tank)
    assert result.status == ExitStatus.SOME_FAILED
    assert (
        "no pictures in this folder, and no videos; name a folder of either, or with --recursive"
        in result.err[0]
    )


def test_one_video_in_a_folder_is_opened_and_of_several_one_must_be_named(make_video, card):
    with open_source(make_video("one/dive.avi", 3).parent) as source:
        assert source.frame_count == 3
    with pytest.raises(InputError, match=r"holds 2 videos \(dive9.AVI, dive10.avi, ...\); name one of them"):
        open_source(card)


@pytest.mark.parametrize(
    ("names", "groups"),
    [
        ("GX020042 GX010042 GX010043", "GX010042 GX020042|GX010043"),
        ("GX010042 GH020042", "GX010042|GH020042"),
        ("GP010042 GOPR0042 GP020042 GOPR0043", "GOPR0042 GP010042 GP020042|GOPR0043"),
        ("DJI_0010 DJI_0009 photo", "DJI_0009 DJI_0010|photo"),
        ("DJI_20240501100000_0001_D DJI_20240501101500_0002_D", None),
        ("rov_2024-05-01_10-30-00 rov_2024-05-01_10-00-00 reef", None),
    ],
)
def test_chapters_by_their_names(names, groups):
    paths = [f"card/{name}.MP4" for name in names.split()]
    found = "|".join(" ".join(path[5:-4] for path in group) for group in group_chapters(paths))
    first, *rest = sorted(names.split()[:2])
    assert found == (groups or "|".join([f"{first} {' '.join(rest)}", *names.split()[2:]]))
    assert len(group_chapters([paths[0], paths[0].replace("card", "other")])) == 2


def test_joined_chapters_are_one_input(run, make_video, fake, tmp_path):
    for name, frames in (("GX010042.avi", 6), ("GX020042.avi", 4), ("GX010043.avi", 2)):
        make_video(f"card/{name}", frames)
    card = tmp_path / "card"
    result = run("decode", card, "--join", "--json", "--out", tmp_path / "out")
    assert result.status == ExitStatus.OK
    first, second = (pipeline for pipeline in fake.made if pipeline.seen)
    assert [seen[0] for seen in first.seen] == list(range(10))
    assert [seen[1] for seen in first.seen] == pytest.approx([number / 20 for number in range(10)])
    assert (first.source, len(second.seen)) == (str(card / "GX010042.avi"), 2)
    assert result.err[0] == f"lightgesture: {card / 'GX010042.avi'}: joined with GX020042.avi"
    assert (tmp_path / "out" / "GX010042.jsonl").exists()
    assert not (tmp_path / "out" / "GX020042.jsonl").exists()
    fake.made.clear()
    run("decode", card, "--join", "--out", tmp_path / "out", "--json")
    assert not any(pipeline.seen for pipeline in fake.made), "done before"
    make_video("card/GX020042.avi", 5)
    run("decode", card, "--join", "--out", tmp_path / "out", "--json")
    assert [len(pipeline.seen) for pipeline in fake.made if pipeline.seen] == [11]


def test_nothing_to_join_is_told(make_video, tmp_path):
    said = []
    tasks = make_tasks(
        [str(make_video("reef.avi")), str(make_video("wreck.avi"))], join=True, tell=said.append
    )
    assert (len(tasks), said) == (2, ["--join: no two inputs are chapters of one recording by their names"])


class Chapter(Source):
    """Gives the times it is named after, then fails where it is told to."""

    def __init__(self, path):
        if "missing" in path:
            raise InputError(f"{path}: no such file")
        self.name, self.is_open = path, True

    def close(self):
        self.is_open = False

    def __iter__(self):
        for number, time_s in enumerate((0.0, 0.1, 0.2)):
            yield Frame(np.zeros((2, 2, 3), np.uint8), number, time_s)
        if "cut" in self.name:
            raise InputError(f"{self.name}: ends early")


def test_a_chapter_that_is_broken_costs_itself():
    frames = []
    source = JoinedVideos(["1", "2 cut", "3 missing", "4"], Chapter)
    with source, pytest.raises(InputError, match=r"^2 cut: ends early; and 1 more$"):
        frames.extend(source)
    assert [frame.index for frame in frames] == list(range(9))
    assert [frame.gap for frame in frames if frame.gap] == [frames[6].gap] == ["3 missing: no such file"]
    assert [frame.time_s for frame in frames] == pytest.approx([number / 10 for number in range(9)])
    with pytest.raises(InputError, match="missing"):
        JoinedVideos(["1 missing", "2"], Chapter)


def make_annotated(path, originals=()):
    with open_annotated_video(path, originals) as video:
        for number in range(30):
            video.write(np.zeros((48, 64, 3), np.uint8), number / 10, [])
    return path


def test_annotated_copies_are_no_inputs(run, make_video, tmp_path, fake):
    video = make_video("dives/a.avi", 3)
    copy = make_annotated(tmp_path / "dives" / "a_annotated.mp4")
    own = make_video("b_annotated.mp4", 3, "mp4v").rename(tmp_path / "dives" / "b_annotated.mp4")
    assert (is_annotated_copy(copy), is_annotated_copy(own), is_annotated_copy(video)) == (True, False, False)
    assert names_of(make_tasks([str(tmp_path / "dives")])) == ["a.avi", "b_annotated.mp4"]
    said = []
    assert names_of(make_tasks([str(copy), str(video)], tell=said.append)) == ["a.avi"]
    assert said == ["1 annotated copies among the inputs passed over"]
    result = run("decode", copy)
    assert (result.status, len(result.err)) == (ExitStatus.SOME_FAILED, 1)
    assert "is an annotated copy; decode the video that it was made of" in result.err[0]
    assert look_into(str(tmp_path / "dives"), recursive=False).copies == 1


OPTIONS = ("--annotate", "--plot")


@pytest.mark.parametrize("name", ["dive.csv", "dive.vtt", "dive.jsonl", "dive.png", "dive_annotated.mp4"])
def test_files_of_others_are_not_replaced(run, make_video, fake, name):
    video = make_video("dives/dive.avi", 3)
    (video.parent / name).write_bytes(b"mine")
    result = run("decode", video, "--out", video.parent, *OPTIONS)
    assert (result.status, result.out, len(result.err)) == (ExitStatus.USAGE, [], 1)
    assert (
        f"{video.parent / name}: was not written by this program and would be replaced; name" in result.err[0]
    )
    assert (video.parent / name).read_bytes() == b"mine"
    assert not any(pipeline.seen for pipeline in fake.made)


def test_an_input_is_not_replaced(run, make_video, tmp_path, fake):
    video = make_video("dive.mp4", 3, "mp4v")
    before = video.read_bytes()
    assert run("decode", video, "--out", tmp_path, *OPTIONS).status == ExitStatus.OK
    assert video.read_bytes() == before
    other = make_video("other.mp4", 3, "mp4v").rename(tmp_path / "other_annotated.mp4")
    original = make_video("other.mp4", 3, "mp4v")
    result = run("decode", original, other, "--out", tmp_path, *OPTIONS)
    assert result.status == ExitStatus.USAGE
    assert f"{other}: is an input, and results of {original} would replace it" in result.err[0]


def test_own_files_are_known_without_the_account_of_them(run, make_video, tmp_path, fake):
    video = make_video("dive.avi", 3)
    for _ in range(2):
        assert run("decode", video, "--out", tmp_path / "out", *OPTIONS).status == ExitStatus.OK
        (tmp_path / "out" / ".lightgesture.json").unlink()


@pytest.mark.parametrize(
    ("codec", "suffix"), [("aac", "mp4"), ("pcm_s16le", "mov"), ("mp3", "mkv"), (None, "mp4")]
)
def test_annotated_videos_keep_sound_and_metadata(tmp_path, codec, suffix):
    """The sound begins half a second before the pictures, as cameras have it."""
    path = tmp_path / f"dive.{suffix}"
    with av.open(str(path), "w") as out:
        out.metadata.update({"title": "Dive 7", "comment": "cold"})
        video = out.add_stream("libx264", 10, options={"preset": "ultrafast"})
        video.width, video.height, video.pix_fmt = 64, 48, "yuv420p"
        sound = out.add_stream(codec, 44100, layout="mono") if codec else None
        for number in range(30):
            frame = av.VideoFrame.from_ndarray(np.zeros((48, 64, 3), np.uint8), format="bgr24")
            frame.pts = number + 5
            out.mux(video.encode(frame))
        if sound is not None:
            size = sound.codec_context.frame_size or 1024
            kind = sound.codec_context.format.name
            for start in range(0, 44100 * 3, size):
                wave = np.sin(np.arange(start, start + size) / 20)[np.newaxis]
                scales = {
                    "s16": (20_000, np.int16),
                    "s32": (1_300_000_000, np.int32),
                    "flt": (0.6, np.float32),
                }
                scale, number_type = scales[kind[:3]]
                wave = (wave * scale).astype(number_type)
                part = av.AudioFrame.from_ndarray(wave, format=kind, layout="mono")
                part.sample_rate, part.pts = 44100, start
                out.mux(sound.encode(part))
            out.mux(sound.encode(None))
        out.mux(video.encode(None))
    copy = make_annotated(tmp_path / "copy_annotated.mp4", [str(path)])
    with av.open(str(copy)) as found:
        assert (found.metadata["title"], found.metadata["comment"]) == (
            "Dive 7",
            "cold; annotated by lightgesture",
        )
        assert [stream.type for stream in found.streams] == ["video", "audio"][: 2 if codec else 1]
        if codec:
            stream = found.streams.audio[0]
            kept = {"pcm_s16le": "aac"}.get(codec, codec)
            assert stream.codec_context.codec.canonical_name == kept
            assert float(stream.start_time * stream.time_base) == pytest.approx(0, abs=0.06)
            loud = sum(np.abs(part.to_ndarray()).max() > 0.1 for part in found.decode(stream))
            assert loud * 1024 / 44100 == pytest.approx(3.0, abs=0.4)


def test_pictures_of_stages_do_not_come_among_frames(run, make_folder, tmp_path, fake):
    result = run("decode", make_folder("frames", 2), "--debug-dir", tmp_path)
    assert (result.status, len(result.err)) == (ExitStatus.USAGE, 1)
    assert f"{tmp_path / 'frames'} is an input; name another folder" in result.err[0]
    assert len(os.listdir(tmp_path / "frames")) == 2
