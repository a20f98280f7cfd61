"""The examples run and do what they say."""

import importlib.util
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from lightgesture.actions.decode import SAMPLE

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_decode_video(monkeypatch, capsys):
    module = load("decode_video")
    monkeypatch.setattr(sys, "argv", ["decode_video.py", str(SAMPLE)])
    module.main()
    assert capsys.readouterr().out == "0.4 to 8.3 s: STOP HOVER 50 GO (98%)\n"


def test_own_reader():
    done = subprocess.run(
        [sys.executable, EXAMPLES / "own_reader.py"], capture_output=True, text=True, check=True
    )
    assert done.stdout == "STOP HOVER 50 GO\n"


def test_follow_records():
    documented = (EXAMPLES.parent / "docs" / "records.md").read_text(encoding="utf-8")
    lines = re.findall(r"^\{.*\}$", documented, re.MULTILINE)
    module = load("follow_records")
    assert module.follow(lines) == ["hover for 50 s"]
    found = json.loads(lines[0])
    unsure = json.dumps({**found, "confidence": 0.5})
    assert module.follow([unsure]) == ["not done: STOP HOVER 50 GO is not sure enough, 0.50"]
    assert module.follow([json.dumps({**found, "action": "EXEC"})])[0].endswith("has no action here")
    assert module.follow([json.dumps({**found, "type": "rejected"})]) == []


def cells(notebook):
    content = json.loads(notebook.read_text(encoding="utf-8"))
    assert (content["nbformat"], content["nbformat_minor"]) == (4, 5)
    assert len({cell["id"] for cell in content["cells"]}) == len(content["cells"])
    return content["cells"]


@pytest.mark.parametrize("notebook", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda path: path.name)
def test_notebooks_run_from_top_to_bottom_and_are_kept_without_output(notebook, monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    names = {}
    for cell in cells(notebook):
        if cell["cell_type"] == "code":
            assert (cell["outputs"], cell["execution_count"]) == ([], None)
            exec("".join(cell["source"]), names)
    assert [one.text for one in names["records"] if one.type == "instruction"] == ["STOP HOVER 50 GO"]
    matplotlib.pyplot.close("all")
