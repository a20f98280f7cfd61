"""The worked example of docs/models.md, its commands as they stand there: from folders of pictures to instructions.

The pictures are cut out of the bundled clip, a rendered dive; its signs go by other names than the ten tokens.
"""

import json
import re
import shlex
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

import lightgesture
from lightgesture import Pipeline
from lightgesture.cli import main

SECTION = (
    (Path(__file__).parents[2] / "docs" / "models.md")
    .read_text(encoding="utf-8")
    .split("### An own sign\n")[1]
    .split("\n## ")[0]
)
CLIP = Path(lightgesture.__file__).parent / "data" / "sample.mp4"
OWN_NAMES = {"0": "fist", "5": "five", "ok": "ring", "pic": "point"}
QUICK = {
    "svm": ("--copies", "2", "--steps", "20", "--centres", "150", "--quiet"),
    "cnn": ("--copies", "4", "--steps", "400", "--teachers", "0", "--size", "small", "--quiet"),
}


def block(language: str) -> str:
    """The first block of code of the section in a language."""
    found = re.search(rf"```{language}\n(.*?)```", SECTION, re.DOTALL)
    assert found is not None
    return found[1]


def commands() -> list[list[str]]:
    """The arguments of the section's commands."""
    lines = block("sh").replace("\\\n", " ").splitlines()
    return [shlex.split(line, comments=True)[1:] for line in lines if line.startswith("lightgesture ")]


@pytest.fixture(scope="module")
def signs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder as the section describes it, its grammar, a clip and one of its frames."""
    folder = tmp_path_factory.mktemp("own")
    shutil.copy(CLIP, folder / "dive.mp4")
    (folder / "signs.toml").write_text(block("toml"), encoding="utf-8")
    reader, pipeline = Pipeline(), cv2.VideoCapture(str(CLIP))
    random = np.random.default_rng(0)
    for number in range(4, 285, 9):
        pipeline.set(cv2.CAP_PROP_POS_FRAMES, number)
        frame = pipeline.read()[1]
        hands = reader.recognize(frame).hands
        for hand in hands:
            if hand.token is not None:
                x, y, width, height = hand.box
                cut = frame[max(0, y) : y + height, max(0, x) : x + width]
                # The user's folders hold left hands as they are and right ones mirrored.
                cut = cut if hand.side == "left" else cut[:, ::-1]
                _write(folder / "signs" / OWN_NAMES[hand.token] / f"{number}_{hand.side}.png", cut)
        if {hand.token for hand in hands} == {"5"}:
            cv2.imwrite(str(folder / "hand.jpg"), frame)
        if number % 4 == 0:
            x, y = random.integers(60, 300), random.integers(0, 120)
            _write(folder / "signs" / "none" / f"{number}.png", frame[y : y + 70, x : x + 70])
    return folder


def _write(path: Path, picture: np.ndarray) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    assert cv2.imwrite(str(path), picture)


@pytest.mark.parametrize("kind", ["svm", pytest.param("cnn", marks=pytest.mark.slow)])
def test_the_documented_commands_lead_from_folders_to_instructions(
    kind: str,
    signs: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if kind == "cnn":
        pytest.importorskip("torch")
    shutil.copytree(signs, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    said = {}
    for command in commands():
        arguments = [kind if word == "svm" else word for word in command]
        more = QUICK[kind] if arguments[0] == "train" else ()
        assert main([*arguments, *more]) == 0, arguments
        said[arguments[0]] = capsys.readouterr().out
    assert said["recognize"].count("hand: five") == 2
    assert "STOP HOVER 50 GO" in said["decode"]
    assert main(["decode", "dive.mp4", "--model", "signs.npz", "--jobs", "1"]) == 2  # by the bundled grammar
    assert "tokens of the grammar that the model cannot read: 0, 1, 2" in capsys.readouterr().err
    card = json.loads(Path("signs.json").read_text(encoding="utf-8"))
    assert card["classes"] == ["fist", "five", "point", "ring", "none"]
    assert set(card["data"]["sources_per_class"].values()) == {1}
    assert card["data"]["rendered_hands"] == 0
    assert any("come from one source" in line for line in card["limits"])
    assert any("no source was held out" in line for line in card["limits"])


def test_the_section_trains_checks_reads_and_decodes() -> None:
    assert [command[0] for command in commands()] == ["train", "grammar", "recognize", "decode"]
