"""What programs of others import: names at the top, types, and the example of the README."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lightgesture
from lightgesture.fsm import Decoder, load_grammar

ROOT = Path(__file__).resolve().parents[2]

OF_OTHERS = """
import cv2

from lightgesture import FrameRecord, HeartbeatRecord, Instruction, Pipeline, Record, find_hands

capture = cv2.VideoCapture(0)


def tell(record: Record) -> str | None:
    if isinstance(record, FrameRecord):
        return ", ".join(hand.token or str(hand.reason) for hand in record.hands)
    if record.type == "summary":
        return f"{record.frames} frames, {record.status}"
    return record.text if isinstance(record, Instruction) else None


def state(record: HeartbeatRecord) -> str:
    return record.state


with Pipeline(model="svm") as pipeline:
    is_read, image = capture.read()
    texts: list[str | None] = [tell(record) for record in pipeline.process(image, 0.0)]
    boxes: list[tuple[int, int, int, int]] = [hand.box for hand in find_hands(image)]
"""
"""A program that checks itself strictly, with pictures typed as OpenCV types them."""


def test_every_name_is_there_and_the_package_itself_loads_nothing():
    assert all(getattr(lightgesture, name) is not None for name in lightgesture.__all__)
    assert set(lightgesture.__all__) <= set(dir(lightgesture))
    with pytest.raises(AttributeError, match="has no attribute 'Pipe'"):
        lightgesture.Pipe  # noqa: B018
    code = "import sys, lightgesture; print([name for name in ('numpy', 'cv2') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_a_pipeline_is_a_context_manager():
    with lightgesture.Pipeline(decoder=Decoder(load_grammar(), hold=3), selector="classical") as pipeline:
        other = pipeline.for_stream("another")
        pipeline.process(np.zeros((48, 64, 3), np.uint8), 0.0)
    assert pipeline.finish()[-1].frames == 1
    for ask in (lambda image: pipeline.process(image, 1.0), pipeline.recognize):
        with pytest.raises(ValueError, match="this pipeline is closed; make another"):
            ask(np.zeros((48, 64, 3), np.uint8))
    other.process(np.zeros((48, 64, 3), np.uint8), 0.0)


@pytest.mark.slow
def test_programs_of_others_pass_a_strict_check(tmp_path):
    example = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text("utf-8"), re.DOTALL)
    assert example is not None
    (tmp_path / "example.py").write_text(example[1])
    (tmp_path / "others.py").write_text(OF_OTHERS)
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "example.py", "others.py"]
    # A checkout that is installed to be edited is found by an import hook, which type checkers do not run.
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env={**os.environ, "MYPYPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=400,
        check=False,
    )
    assert (done.returncode, done.stdout[-2000:]) == (0, "Success: no issues found in 2 source files\n")
