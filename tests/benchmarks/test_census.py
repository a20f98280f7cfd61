"""The house in figures: what counts as a call, an import, a field and a box."""

import json
from pathlib import Path

import pytest

from lightgesture.benchmarks.census import __main__ as census
from lightgesture.benchmarks.census.frame import GENERATED, FrameCounts, called, count_calls, frame_counts
from lightgesture.benchmarks.census.sources import box_holders, count_lines, import_closure, settings_fields
from lightgesture.benchmarks.tables import Table

SOURCES = {
    "__init__.py": "",
    "one.py": "import json\nfrom own.deep import two\n\n\ndef late():\n    import own.three\n",
    "deep/__init__.py": "",
    "deep/two.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from own.deep.four import Four\n",
    "deep/four.py": "import own.one\nclass Four: ...\n",
    "three.py": "\n\n",
    "apart.py": "import own.one\n",
}
CLASSES = """
from dataclasses import dataclass
from typing import NamedTuple

@dataclass(frozen=True)
class Region:
    box: Box
    others: tuple[Box, ...]
    score: float

class Pair(NamedTuple):
    box: Float

@dataclass
class Peaks:
    boxes: Float

class NoRecord:
    box: Box

@dataclass
class FindSettings:
    least: int = 3
    most: int = 4
    UNIT = "px"
"""


@pytest.fixture(name="package")
def _package(tmp_path):
    """A package `own` whose modules import each other in all the ways there are."""
    for name, text in SOURCES.items():
        file = tmp_path / "own" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return tmp_path / "own"


def test_the_closure_has_late_imports_packages_and_no_other_modules(package):
    closure = import_closure(["own.one"], package)
    assert sorted(closure) == ["own", "own.deep", "own.deep.four", "own.deep.two", "own.one", "own.three"]
    assert closure["own.deep"] == (package / "deep" / "__init__.py").resolve()
    assert count_lines([*closure.values(), package / "three.py"]) == 6 + 3 + 2 + 2


def test_records_with_one_box_are_told_with_their_fields(tmp_path):
    file = tmp_path / "kinds.py"
    file.write_text(CLASSES, encoding="utf-8")
    assert [(one.name, one.fields) for one in box_holders([file, file])] == [
        ("Region", ("box", "others")),
        ("Pair", ("box",)),
    ]


def test_annotated_fields_of_settings_count(package):
    (package / "kinds.py").write_text(CLASSES, encoding="utf-8")
    (package / "synth").mkdir()
    (package / "synth" / "more.py").write_text("class MoreSettings:\n    a: int\n", encoding="utf-8")
    found = settings_fields(package)
    assert {(one.file, one.name, len(one.fields)) for one in found} == {
        ("own/kinds.py", "FindSettings", 2),
        ("synth/more.py", "MoreSettings", 1),
    }


def test_calls_are_summed_up_by_what_they_are():
    counts = count_calls(
        {
            ("/a/kalman.py", "predict"): 8,
            ("/a/motion.py", "Box.predict"): 2,
            ("/a/motion.py", "Box.all.<locals>.<listcomp>"): 3,
            (GENERATED, "__create_fn__.<locals>.__init__"): 5,
        }
    )
    assert counts == FrameCounts(
        files=2, functions=3, named_functions=2, calls=13, named_calls=10, generated_calls=5, predictions=8
    )


def test_only_functions_of_the_package_are_told():
    table = Table("name", "Title", ("a",), ({"a": 1},))
    places = called(lambda: (table.to_dicts(), json.dumps({"a": 1}), Table("b", "B", (), ())))
    assert {Path(file).name for file, _ in places} == {"tables.py"}
    assert {name for _, name in places} >= {"Table.to_dicts", "_rounded"}


def test_an_error_ends_the_profile():
    def fail():
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        called(fail)
    assert called(lambda: None) == {}


def test_a_frame_of_the_bundled_clip_goes_through_the_stages(monkeypatch, capsys):
    counts = frame_counts(frames=range(8, 10))
    assert counts.files > 10
    assert counts.calls >= counts.named_calls > counts.named_functions
    monkeypatch.setattr(census, "frame_counts", lambda: counts)
    assert census.main(["--json"]) == 0
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert {row["table"] for row in rows} == {"census", "box_types", "settings"}
    assert rows[0] == {"table": "census", "what": "files a frame", "count": counts.files, "goal": 22}
