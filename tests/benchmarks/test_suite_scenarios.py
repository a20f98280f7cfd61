"""The list of the suite: the paper's totals, every form of the language, seeds of its own."""

import pytest

from lightgesture.benchmarks.suite.scenarios import (
    LAND,
    NEGATIVE,
    REAL,
    SIZE,
    SUITE_SEEDS,
    SUITES,
    WATER,
    scenarios,
    scene_spec,
)
from lightgesture.fsm import Decoder, Instruction, Signs, load_grammar
from lightgesture.synth.script import sentence_words, word_pairs


def words_of(suite):
    return [word for item in scenarios(suite) for line in item.sentences for word in sentence_words(line)]


@pytest.mark.parametrize(("suite", "clips", "gestures"), [(WATER, 30, 162), (LAND, 20, 132), (REAL, 30, 162)])
def test_totals_are_the_papers(suite, clips, gestures):
    assert len(scenarios(suite)) == clips
    assert len(words_of(suite)) == gestures


def test_every_form_direction_change_and_digit_occurs_in_both_places():
    tasks = {"HOVER", "FOLLOW", "LEFT", "RIGHT", "UP", "DOWN", "EXEC", "SNAP", "AND", "STOP", "CONTD", "GO"}
    expected = tasks | set("012345")
    assert expected | {"INCREASE", "DECREASE", "DEFAULT"} <= set(words_of(WATER))
    assert expected | {"DECREASE", "DEFAULT"} <= set(words_of(LAND))
    assert {f"PARAM {number}" for number in (0, 1, 3, 5)} <= set(words_of(WATER))


@pytest.mark.parametrize("suite", [WATER, LAND])
def test_signed_without_a_flaw_each_sentence_is_issued_as_it_stands(suite):
    grammar = load_grammar()
    for scenario in scenarios(suite):
        decoder, events, clock = Decoder(grammar, hold=15), [], 0
        for pair, _ in word_pairs(grammar, sentence_words(scenario.sentences[0])):
            for shown in [pair] * 16 + [(None, None)] * 4:
                events += decoder.step(Signs.of_tokens(*shown), clock / 30.0)
                clock += 1
        issued = [event.text for event in events if isinstance(event, Instruction)]
        assert issued == list(scenario.sentences), scenario.name


def test_seeds_and_names_are_the_suites_own():
    listed = [item for suite in SUITES for item in scenarios(suite)]
    assert {item.seed for item in listed} <= set(SUITE_SEEDS)
    assert len({item.seed for item in listed}) == len({item.name for item in listed}) == len(listed)
    assert scenarios(WATER)[2].name == "water-03"


def test_every_scenario_is_a_valid_scene_and_always_the_same():
    for suite in SUITES:
        for scenario in scenarios(suite):
            spec = scene_spec(scenario)
            assert spec == scene_spec(scenario)
            assert spec.size == SIZE
            assert spec.sentences == scenario.sentences
            assert (spec.water.kind == "none") == (scenario.place == "room")


def test_a_scenario_has_its_own_difficulty_and_no_other():
    specs = {item.name: (item.difficulty, scene_spec(item)) for item in scenarios(WATER)}
    for difficulty, spec in specs.values():
        assert (spec.backdrop.surface_m > 0.0) == (difficulty == "reflection")
        assert (spec.backdrop.bubbles > 0.0) == (difficulty == "bubbles")
        assert (spec.diver.glove is not None) == (difficulty == "gloves")
        assert (spec.diver.distance_mm > 1500.0) == (difficulty == "far")
        assert (spec.diver.wrist_mm[0] < 150.0) == (difficulty == "face")


def test_negatives_sign_nothing():
    assert all(name.startswith("~") for item in scenarios(NEGATIVE) for name in item.sentences)
