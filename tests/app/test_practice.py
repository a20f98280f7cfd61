"""What a session of practice makes of signs, and what it asks for."""

import pytest

from lightgesture.errors import UsageError
from lightgesture.fsm import load_grammar
from lightgesture.practice.session import NOT_READ, Session
from lightgesture.practice.summary import view
from lightgesture.practice.tasks import STUDY, drawn_tasks, named_tasks, study_tasks
from tests.app.practice_makers import GRAMMAR, Diver

SONAR = load_grammar("docs/grammars/sonar.toml")


def test_a_sentence_that_is_signed_as_asked():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO", "CONTD SNAP GO"]))
    assert diver.session.asked.pair == ("ok", "0")
    diver.sign("ok,0 5,5")
    assert diver.session.asked.word == "GO"
    diver.sign("ok,ok pic,0 pic,pic ok,ok")
    assert diver.session.is_done
    first, second = diver.session.progress
    assert (first.is_done, first.mistakes, second.is_done) == (True, [], True)
    assert first.seconds == pytest.approx([0.5, 0.9, 0.9])
    assert first.total_s == pytest.approx(2.3)
    assert not diver.session.confusions
    assert diver.session.last == ("right", "CONTD SNAP GO in 2.6 s")
    diver.sign("5,5")  # nothing is asked for any more
    assert view(diver.session)["is_done"]


def test_digits_need_no_joining_word():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER 50 GO"]))
    diver.sign("ok,0 5,5 ok,5 ok,0 ok,ok")
    progress = diver.session.progress[0]
    assert progress.is_done
    assert [seconds is None for seconds in progress.seconds] == [False, False, False, True, False, False]


def test_another_word_begins_the_sentence_again():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.sign("ok,0 5,1")
    progress = diver.session.progress[0]
    assert [(mistake.reason, mistake.word, mistake.is_fatal) for mistake in progress.mistakes] == [
        ("wrong_word", "HOVER", True)
    ]
    assert diver.decoder.state == "idle"
    diver.sign("ok,0 5,5 ok,ok")
    assert progress.is_done
    assert (progress.fatal, progress.slips) == (1, 0)


def test_a_pair_that_is_no_word_is_a_slip():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.sign("ok,0 3,5 5,5 ok,ok")
    progress = diver.session.progress[0]
    assert progress.is_done
    assert (progress.fatal, progress.slips) == (0, 1)
    assert progress.mistakes[0].detail == "3,5 was read for HOVER, and is no word; show it again"
    assert diver.session.confusions == {("5", "3"): 1}
    assert diver.session.readings["5"] == 4


def test_another_sentence_and_a_rejection_are_mistakes():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER 5 GO"]))
    diver.sign("ok,0 5,5 ok,ok")
    diver.sign("ok,0 5,5 pic,0")
    reasons = [mistake.reason for mistake in diver.session.progress[0].mistakes]
    assert reasons == ["other_sentence", "out_of_order"]


def test_hands_that_are_not_read_are_noted_and_passages_are_not():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    for _ in range(2):
        diver.look("1", "2")  # on the way
    for _ in range(6):
        diver.look("ok", None)
    assert diver.session.confusions == {("0", NOT_READ): 1}
    assert diver.session.readings == {"ok": 1, "0": 1}


def test_the_last_sign_held_on_is_no_confusion():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.sign("ok,0", frames=20)
    assert not diver.session.confusions


def test_time_is_over():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO", "STOP UP GO"]), limit_s=3.0)
    diver.sign("ok,0 1,1 1,1 1,1")
    first = diver.session.progress[0]
    assert not first.is_done
    assert first.mistakes[-1].reason == "time"
    assert diver.session.number == 1
    assert diver.decoder.state == "idle"
    diver.sign("ok,0 right,right ok,ok")
    assert diver.session.progress[1].is_done


def test_a_sentence_to_be_confirmed():
    diver = Diver(named_tasks(SONAR, ["STOP SONAR 3 GO"]), SONAR)
    for sign in diver.session.current.task.sentence.signs:
        diver.sign(",".join(sign.pair))
        diver.look(None, None)
    assert diver.session.progress[0].is_done


def test_words_that_are_taken_back_are_no_mistakes():
    """By the rule "sentence" words come before the verdict."""
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.session = Session(named_tasks(GRAMMAR, ["STOP HOVER GO"]), GRAMMAR, 60.0, is_revised=True)
    diver.sign("ok,0 5,1")
    assert diver.session.progress[0].mistakes == []


def test_random_sentences_can_be_said_and_come_again_with_the_seed():
    for name in (None, "docs/grammars/sonar.toml", "docs/grammars/repeat.toml"):
        grammar = load_grammar(name)
        texts = [task.sentence.text for task in drawn_tasks(grammar, 6, seed=3)]
        assert len(set(texts)) == 6
        assert texts == [task.sentence.text for task in drawn_tasks(grammar, 6, seed=3)]
        assert texts != [task.sentence.text for task in drawn_tasks(grammar, 6, seed=4)]
    assert "ABORT" not in [task.sentence.text for task in drawn_tasks(SONAR, 50, seed=1)]


def test_the_study_has_the_papers_gestures():
    tasks = study_tasks(GRAMMAR)
    gestures = {
        kind: sum(len(task.sentence.signs) for task in tasks if task.kind == kind) for _, kind, _ in STUDY
    }
    assert gestures == {"STOP": 10, "CONTD": 10, "complex": 16}
    with pytest.raises(UsageError, match="study's sentences"):
        study_tasks(SONAR)
