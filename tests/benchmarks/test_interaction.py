"""The arithmetic of the study and of the suite of cards; nothing is rendered."""

import numpy as np
import pytest

from lightgesture.benchmarks.cards.scenes import SIGNINGS, takes_of
from lightgesture.benchmarks.cards.suite import CardAnswer, missed_table, suite_table
from lightgesture.benchmarks.interaction.__main__ import keep, kept_trials, run_trials, trial_keys
from lightgesture.benchmarks.interaction.report import draw_study, trials_table
from lightgesture.benchmarks.interaction.trials import Trial, scene_of, vocabulary_of, with_slips
from lightgesture.benchmarks.interaction.users import TASKS, USERS, WAYS, slip_chance, word_seconds
from lightgesture.fsm import load_grammar
from lightgesture.synth.script import sentence_words


def test_slips_make_the_mistakes_of_the_paper():
    for mistakes in (1.0, 2.0, 7.0):
        chance = slip_chance(mistakes, (6, 4))
        rights = [(1 - chance) ** length for length in (6, 4)]
        assert sum((1 - one) / one for one in rights) == pytest.approx(mistakes)
    assert slip_chance(0.0, (6, 4)) == 0.0


def test_gestures_are_as_many_as_in_the_paper():
    counts = {
        kind: sum(len(sentence_words(one)) for task in tasks for one in task) for kind, tasks in TASKS.items()
    }
    assert counts == {"STOP": 10, "CONTD": 10, "complex": 16}


def test_hands_are_quickest_and_the_book_costs_novices_most():
    for user in USERS.values():
        seconds = {way: word_seconds(user, way, 27, ("up", "up")) for way in WAYS}
        assert seconds["hands"] == min(seconds.values())
    assert word_seconds(USERS["beginner"], "tags", 27) > word_seconds(
        USERS["beginner"], "tag-motion", 27, ("wave", "wave")
    )


def test_a_slip_is_another_word():
    words, rng = ["STOP", "UP", "GO"], np.random.default_rng(0)
    vocabulary = vocabulary_of(load_grammar())
    assert with_slips(words, 0.0, vocabulary, rng) == words
    shown = with_slips(words, 1.0, vocabulary, rng)
    assert all(one != other and one in vocabulary for one, other in zip(shown, words, strict=True))


def test_the_study_is_that_of_ten_people():
    assert len(trial_keys()) == 10 * 6 * 3
    assert trial_keys()[: 3 * 6 * 3] == trial_keys(is_quick=True)


def test_without_pictures_slips_are_the_only_mistakes():
    trials = [*run_trials(trial_keys(), 1, is_rendered=False)]
    assert {trial.misread + trial.wrong_slips + trial.wrong_misread for trial in trials} == {0}
    assert sum(trial.slips for trial in trials if trial.skill == "expert") == 0
    seconds = {way: sum(trial.seconds for trial in trials if trial.way == way) for way in WAYS}
    assert seconds["hands"] < seconds["tag-motion"] < seconds["tags"]


def test_trials_are_kept(tmp_path):
    path = tmp_path / "study.jsonl"
    assert kept_trials(path) == []
    trials = [Trial("expert", 0, way, "STOP", 1, 2, 10.5, 1, 0, 0, 0, True) for way in WAYS]
    for trial in trials:
        keep(trial, path)
    assert kept_trials(path) == trials
    assert trials[0].key in trial_keys()
    path.write_text('{"skill": 3}\n', encoding="utf-8")
    with pytest.raises(SystemExit, match=r"study.jsonl: holds no trials of this study"):
        kept_trials(path)


def test_moved_cards_stay_in_the_picture():
    for suite in ("water", "land"):
        for take in takes_of("tag-motion", suite):
            assert take.spec.diver.distance_mm > 1100.0
    near = {way: scene_of(["STOP", "GO"], way, 3, 5).diver.distance_mm for way in WAYS}
    assert near["tags"] == near["hands"] < near["tag-motion"]


def test_tables_and_picture_of_a_study(tmp_path):
    pytest.importorskip("matplotlib")
    trials = [
        Trial(skill, 0, way, kind, task, 2, 10.0, 1, 0, 0, 0, True)
        for skill in USERS
        for way in WAYS
        for kind in TASKS
        for task in (0, 1)
    ]
    table = trials_table(trials)
    assert len(table.rows) == 27
    assert (table.rows[0]["seconds"], table.rows[0]["slips"], table.rows[0]["paper"]) == (20.0, 2.0, 2)
    draw_study(trials, tmp_path / "study.png")
    assert (tmp_path / "study.png").read_bytes().startswith(b"\x89PNG")


def test_the_suite_of_cards_shows_the_sentences_of_the_paper():
    for signing in SIGNINGS:
        assert [len(takes_of(signing, suite)) for suite in ("water", "land")] == [30, 20]
    first, *others = takes_of("tags", "water")
    assert first.spec.signing == "tags"
    assert first.spec.cards.tilt_deg == 60.0
    answers = [CardAnswer(first, ("STOP HOVER 50 GO",), (), tuple("ab"), 1, 9, 8, 0, 40, 2.0)]
    answers.append(CardAnswer(others[0], ("STOP UP GO",), (), (), 1, 9, 8, 0, 40, 2.0))
    (row,) = suite_table(answers, "suite").rows
    assert (row["sentences"], row["right"], row["wrong"], row["missed"], row["tags_read"]) == (
        2,
        1,
        1,
        1,
        0.889,
    )
    assert [row["issued"] for row in missed_table(answers).rows] == ["STOP UP GO"]
