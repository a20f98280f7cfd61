"""The suite from end to end on a small drawn clip: a flawless reader, a blind one, and the command."""

import argparse
import json
from dataclasses import replace

import pytest

from lightgesture import models
from lightgesture.benchmarks import accuracy
from lightgesture.benchmarks.commands import evaluate
from lightgesture.benchmarks.methods import decoded
from lightgesture.benchmarks.scorer import Reading
from lightgesture.benchmarks.suite import run as suite
from lightgesture.benchmarks.suite import takes as suite_takes
from lightgesture.benchmarks.suite.cache import fetch_clip
from lightgesture.benchmarks.suite.scenarios import LAND, NEGATIVE, REAL, SIZE, WATER, Scenario
from lightgesture.benchmarks.suite.tables import all_tables
from lightgesture.errors import UsageError
from lightgesture.fsm import Decoder, Signs, load_grammar


class Oracle:
    """Knows the labels of one clip and reads them with the real decoder; a blind one sees nothing."""

    def __init__(self, labels, name="oracle", is_blind=False):
        self.labels, self.name, self._is_blind = labels, name, is_blind

    def stream(self, hold):
        assert hold is None
        self._decoder, self._events, self._index = Decoder(load_grammar(), rule="frames"), [], 0
        return self

    def process(self, image, time_s):
        assert image.shape == (48, 64, 3)
        labels = () if self._is_blind else self.labels[self._index]
        tokens = {label.side: label.token for label in labels}
        self._events += self._decoder.step(Signs.of_tokens(tokens.get("left"), tokens.get("right")), time_s)
        self._index += 1
        return [Reading(label.box, label.side, label.token, 1 + (label.side == "left")) for label in labels]

    def finish(self):
        return decoded([*self._events, *self._decoder.finish()])


@pytest.fixture(name="clip")
def _clip(tmp_path, signed_take):
    return fetch_clip(signed_take, tmp_path)


def test_a_flawless_reader_gets_everything(clip):
    answer = suite.run_clip(Oracle(clip.labels), clip)
    score = answer.score
    assert (score.instructions, score.readable, score.right, score.wrong, score.missed) == (1, 1, 1, 0, 0)
    assert (score.gestures, score.gestures_right, score.gestures_wrong) == (3, 3, 0)
    assert score.hands.found == score.hands.read == score.hands.sides_right == score.hands.hands > 90
    assert score.switches == 0
    assert score.delays == pytest.approx([14 / 30] * 3, abs=1e-3)
    assert answer.tiles == ()


def test_a_blind_reader_misses_everything(clip):
    answer = suite.run_clip(Oracle(clip.labels, is_blind=True), clip)
    assert (answer.score.right, answer.score.wrong, answer.score.missed) == (0, 0, 1)
    assert (answer.score.gestures, answer.score.gestures_right) == (3, 0)
    assert answer.score.hands.found == 0
    assert answer.score.delays == ()
    assert len(answer.tiles) == 3


def test_what_is_issued_without_a_sign_is_wrong(clip):
    waving = replace(clip, scenario=Scenario(NEGATIVE, ("~wave",), "waving", "water", clip.scenario.seed))
    score = suite.run_clip(Oracle(clip.labels), waving).score
    assert (score.instructions, score.right, score.wrong, score.missed) == (0, 0, 1, 0)
    assert (score.gestures, score.gestures_wrong) == (0, 3)
    assert score.hands.hands == 0


def test_tables_sum_up_by_suite_and_difficulty_and_list_the_failures(clip):
    answers = [
        suite.run_clip(Oracle(clip.labels), clip),
        suite.run_clip(
            Oracle(clip.labels, is_blind=True),
            replace(clip, scenario=replace(clip.scenario, difficulty="far")),
        ),
    ]
    by_suite, by_difficulty, failures = all_tables(answers, "oracle")
    (row,) = by_suite.to_dicts()
    assert (row["method"], row["suite"], row["clips"]) == ("oracle", "water", 2)
    assert (row["right"], row["missed"], row["wrong"], row["gestures_right"], row["found"]) == (
        1,
        1,
        0,
        3,
        0.5,
    )
    assert [(line["difficulty"], line["right"]) for line in by_difficulty.to_dicts()] == [
        ("clear", 1),
        ("far", 0),
    ]
    (failure,) = failures.to_dicts()
    assert (failure["signed"], failure["issued"], failure["words"]) == ("STOP UP GO", "none", "none")


def test_takes_are_chosen_by_part_clip_and_speed():
    takes = [take for name in (WATER, LAND, NEGATIVE) for take in suite_takes.takes_of(name, None)]
    assert len(suite_takes.choose_takes(takes, (), False)) == 62
    assert [take.scenario.name for take in suite_takes.choose_takes(takes, ["water-03"], False)] == [
        "water-03"
    ]
    quick = [take.scenario.name for take in suite_takes.choose_takes(takes, [LAND], True)]
    assert quick == ["land-01", "land-06", "land-11", "land-16"]


def test_real_hands_need_a_data_folder(data):
    assert suite_takes.takes_of(REAL, None) == []
    assert suite_takes.takes_of(REAL, data) == []


def test_real_hands_are_held_by_the_divers_own_sides(real_data):
    take = suite_takes.takes_of(REAL, real_data)[0]
    frames = take.frames()
    first = next(frames)
    assert first.image.shape == (SIZE[1], SIZE[0], 3)
    signed = next(frame for frame in frames if all(hand.token for hand in frame.record.hands))
    boxes = {hand.side: hand.box for hand in signed.record.hands}
    assert boxes["right"][0] < boxes["left"][0]
    assert {hand.side: hand.token for hand in signed.record.hands} == {"left": "ok", "right": "0"}


@pytest.fixture(name="command")
def _command(monkeypatch, tmp_path, clip, signed_take):
    """Runs `evaluate suite` with one drawn clip and a flawless reader."""
    monkeypatch.setattr(suite_takes, "takes_of", lambda name, _data: [signed_take] if name == WATER else [])
    monkeypatch.setattr(models, "load_classifier", lambda _name: None)
    asked = []

    def methods_of(_classifier, _model, _data, selectors):
        asked.append(list(selectors))
        return [Oracle(clip.labels), Oracle(clip.labels, "blind", True)]

    monkeypatch.setattr(accuracy, "default_methods", methods_of)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    parser = argparse.ArgumentParser()
    evaluate.add_arguments(parser)

    def run(*arguments):
        return evaluate.run(parser.parse_args([*arguments, "--data", str(tmp_path)]))

    run.asked = asked
    return run


def test_the_command_prints_tables_and_draws_what_was_missed(command, tmp_path, capsys):
    assert command("suite", "--out", str(tmp_path / "sheets")) == 0
    captured = capsys.readouterr()
    assert [block.splitlines()[0] for block in captured.out.split("\n\n")] == [
        "Scenario suite",
        "Scenario suite by difficulty (oracle)",
    ]
    assert [path.name for path in (tmp_path / "sheets").iterdir()] == ["water_blind.jpg"]
    assert list((tmp_path / "cache" / "lightgesture" / "suite").iterdir())


def test_the_command_gives_json(command, capsys):
    assert command("suite", "--json", "--only", "water") == 0
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [row["right"] for row in rows if row["table"] == "suite"] == [1, 0]


@pytest.mark.parametrize(
    "arguments", [("suite", "--only", "moon"), ("hands", "--quick"), ("--only", "water")]
)
def test_wrong_choices_are_refused(command, arguments):
    with pytest.raises(UsageError, match="--only"):
        command(*arguments)


def test_selectors_of_the_whole_chain_are_named(command):
    command("suite", "--json")
    command("suite", "--json", "--selector", "classical", "--selector", "learned")
    assert command.asked == [["learned"], ["classical", "learned"]]
    with pytest.raises(UsageError, match=r"--selector own\.npz: with suite it must be learned or classical"):
        command("suite", "--selector", "own.npz")
