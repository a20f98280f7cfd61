"""Targets that are texts: TOML, JSON, tables, sentences."""

from contextlib import suppress
from pathlib import Path

from lightgesture.archive.dives import write_dives
from lightgesture.archive.folder import open_archive_folder
from lightgesture.archive.tasks import Task
from lightgesture.config.options import read_config
from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.export.files import check_folder
from lightgesture.features.motion.shapes import load_shapes
from lightgesture.features.profile import load_profile
from lightgesture.fsm import load_grammar
from lightgesture.grammar.replay import explain_records
from lightgesture.grammar.report import check, explain, show
from lightgesture.practice.study import read_people, tabulate, to_csv
from lightgesture.signs.sentences import read_sentence
from lightgesture.sinks.mavlink_map import load_map
from lightgesture.sources.rtp import read_description
from lightgesture.synth.spec import load_scene_spec
from lightgesture.training.pool.left_out import read_left_out
from lightgesture.training.tables import table_rows
from lightgesture.vehicle.profile_file import load_vehicle

from .scratch import clean, file_of

GRAMMAR = load_grammar()


def grammar(content: bytes) -> None:
    path = str(file_of(content, "grammar.toml"))
    check(path)
    show(load_grammar(path))


def config(content: bytes) -> None:
    read_config(str(file_of(content, "config.toml")))


def vehicle(content: bytes) -> None:
    load_vehicle(str(file_of(content, "vehicle.toml")))


def mavlink_map(content: bytes) -> None:
    load_map(str(file_of(content, "map.toml")))


def scene(content: bytes) -> None:
    try:
        load_scene_spec(file_of(content, "scene.toml"))
    except ValueError as error:  # which the command makes a line of
        raise UsageError(str(error)) from error


def profile(content: bytes) -> None:
    load_profile(file_of(content, "profile.json"))


def shapes(content: bytes) -> None:
    load_shapes(file_of(content, "shapes.json"))


def card(content: bytes) -> None:
    read_left_out(file_of(content, "model.json"))


def study(content: bytes) -> None:
    path = clean("study")
    (path / "person-a.json").write_bytes(content)
    to_csv(tabulate(read_people(str(path))))


def records(content: bytes) -> None:
    explain_records(GRAMMAR, str(file_of(content, "records.jsonl")))


def pairs(content: bytes) -> None:
    text = content.decode("utf-8", "surrogateescape")
    with suppress(UsageError):
        explain(GRAMMAR, text)
    read_sentence(GRAMMAR, text)


def description(content: bytes) -> None:
    read_description(str(file_of(content, "camera.sdp")))


def table(content: bytes) -> None:
    list(table_rows(file_of(content, "table.csv"), ("path", "token"), "give a table"))


def manifest(content: bytes) -> None:
    path = clean("results")
    (path / ".lightgesture.json").write_bytes(content)
    video = path / "dive.mp4"
    video.write_bytes(b"0")
    task = Task(0, str(video), "dive.mp4", "dive")
    with open_archive_folder(DecodeSettings(out=str(path))) as kept:
        assert kept is not None
        kept.look_up(task)
        kept.refuse_to_replace([task], [".csv"])


def dives(content: bytes) -> None:
    path = clean("dives")
    (path / "dive.csv").write_bytes(content)
    write_dives(path)


def export_manifest(content: bytes) -> None:
    path: Path = clean("export")
    (path / "manifest.json").write_bytes(content)
    check_folder(path)
