"""Every reader takes or refuses, in one line, what is kept of fuzzing, and what hypothesis makes of it."""

import time

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from .changes import documents, inputs
from .engines import SLOW_S
from .scratch import feed
from .targets import CORPUS, TARGETS, seeds

LARGEST_CORPUS = 200_000
"""Bytes of all that is kept."""


@pytest.mark.parametrize("name", TARGETS)
def test_what_is_kept_is_taken_or_refused(name):
    kept = seeds(name)
    assert kept, "a target without an input shows nothing"
    for content in kept:
        start_s = time.monotonic()
        feed(TARGETS[name].run, content)
        assert time.monotonic() - start_s < SLOW_S


def test_every_folder_belongs_to_a_target_and_all_are_small():
    assert {folder.name for folder in CORPUS.iterdir()} == set(TARGETS)
    assert sum(file.stat().st_size for file in CORPUS.glob("*/*")) < LARGEST_CORPUS


@pytest.mark.slow
@pytest.mark.parametrize("name", TARGETS)
def test_what_hypothesis_makes_of_it(name):
    @settings(max_examples=100, database=None, suppress_health_check=list(HealthCheck))
    @given(inputs(TARGETS[name], seeds(name)))
    def examples(content):
        feed(TARGETS[name].run, content)

    examples()


@settings(max_examples=20, suppress_health_check=[HealthCheck.too_slow])
@given(st.data())
def test_changed_texts_are_taken_or_refused(data):
    name = data.draw(st.sampled_from([name for name, target in TARGETS.items() if target.shape != "bytes"]))
    feed(TARGETS[name].run, data.draw(inputs(TARGETS[name], seeds(name))))


@settings(max_examples=5)
@given(documents("json", [b"8"]))
def test_a_kept_document_that_is_one_value_has_nothing_to_change(content):
    assert content == b"8"


def test_a_fault_is_no_refusal():
    def breaks(content):
        raise KeyError(content)

    with pytest.raises(KeyError):
        feed(breaks, b"x")
