"""The lock, its audit and licences, and a wheel that comes out the same twice."""

import json
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from lightgesture.benchmarks import supply

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / supply.LOCK).read_text("utf-8")


def test_the_lock_has_every_dependency_with_hashes_and_no_place_they_come_from():
    found = {name.lower().replace("_", "-") for name in supply.pinned(TEXT)}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    wanted = [*project["dependencies"], *project["optional-dependencies"][supply.EXTRA]]
    names = {re.match(r"[A-Za-z0-9._-]+", one)[0].lower() for one in wanted}
    assert names <= found
    entries = re.split(r"\n(?=[a-z])", TEXT.partition("\n\n")[0])
    assert len(entries) > 15
    assert all("--hash=sha256:" in entry for entry in entries[1:])
    assert "://" not in TEXT
    assert "index" not in TEXT


def answer(monkeypatch, status=0, out="", err=""):
    monkeypatch.setattr(
        subprocess, "run", lambda words, **_: subprocess.CompletedProcess(words, status, out, err)
    )


@pytest.mark.parametrize(
    ("out", "err", "said"),
    [
        ("", "Traceback\nConnectionError: no such host", "no such host"),
        (json.dumps({"dependencies": [{"name": "av", "skip_reason": "not found"}]}), "", "1 of 1 packages"),
    ],
)
def test_an_audit_without_advisories_fails_and_says_so(monkeypatch, capsys, out, err, said):
    answer(monkeypatch, 0, out, err)
    assert supply.main(["audit"]) == 2
    text = capsys.readouterr().err
    assert said in text
    assert "could not be audited" in text or "cannot be audited" in text
    assert text.count("\n") == 1


def test_an_audit_names_what_is_weak(monkeypatch, capsys):
    one = {"name": "av", "version": "1", "vulns": [{"id": "X-1", "fix_versions": ["2"]}]}
    answer(monkeypatch, 1, json.dumps({"dependencies": [one]}))
    assert supply.main(["audit"]) == 1
    assert "av 1: X-1; mended in 2" in capsys.readouterr().out
    answer(monkeypatch, 0, json.dumps({"dependencies": [{**one, "vulns": []}]}))
    assert supply.main(["audit"]) == 0


def test_a_tool_that_is_not_there_is_one_line(monkeypatch, capsys):
    monkeypatch.setenv("PATH", "")
    monkeypatch.chdir(ROOT)
    assert supply.main(["lock"]) == 2
    assert "uv: is not installed; install lightgesture[hold]" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("licence", "expected"),
    [
        ("MIT", True),
        ("MPL-2.0 AND MIT", True),
        ("GNU Lesser General Public License v3 (LGPLv3)", True),
        ("GNU General Public License v3 (GPLv3)", False),
        ("MIT AND GPL-3.0", False),
        ("UNKNOWN", False),
    ],
)
def test_licences_that_go_with_ours(licence, expected):
    assert supply.is_allowed(licence) is expected


@pytest.mark.slow
def test_two_builds_are_one_wheel(monkeypatch, capsys):
    pytest.importorskip("build")
    monkeypatch.chdir(ROOT)
    assert supply.main(["wheel"]) == 0
    assert "two builds, one hash" in capsys.readouterr().out


@pytest.mark.slow
def test_what_is_locked_has_licences_that_go_with_ours(monkeypatch, capsys):
    pytest.importorskip("piplicenses")
    monkeypatch.chdir(ROOT)
    assert supply.main(["licences"]) == 0
    assert "0 with a licence that is not allowed" in capsys.readouterr().out
