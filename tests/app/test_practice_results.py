"""The table of a group, the picture and the summary of a practice."""

import json

import pytest

from lightgesture.errors import UsageError
from lightgesture.practice.picture import summary_page
from lightgesture.practice.study import read_people, tabulate, tell_table, to_csv
from lightgesture.practice.summary import summary, tell_summary
from lightgesture.practice.tasks import named_tasks, study_tasks
from lightgesture.signs.sheet import Text
from tests.app.practice_makers import GRAMMAR, Diver


def summary_of(session, person=None, level=None):
    return summary(session, "test", "grammar.toml", person, level)


def a_person(person, level, *, wrong=0):
    """Signs all of the study, the first sentence wrong some times before."""
    diver = Diver(study_tasks(GRAMMAR))
    for _ in range(wrong):
        diver.sign("ok,0 5,1")
    for progress in diver.session.progress:
        diver.sign(" ".join(",".join(sign.pair) for sign in progress.task.sentence.signs))
    assert diver.session.is_done
    return summary_of(diver.session, person, level)


def test_the_table_of_a_group(tmp_path):
    people = [a_person("a", "beginner", wrong=2), a_person("b", "beginner"), a_person("c", "medium")]
    for content in people:
        (tmp_path / f"person-{content['person']}.json").write_text(json.dumps(content), encoding="utf-8")
    rows = tabulate(read_people(str(tmp_path)))
    assert [(row.kind, row.level, row.people, row.mistakes) for row in rows] == [
        ("STOP", "beginner", 2, 1.0),
        ("STOP", "medium", 1, 0.0),
        ("CONTD", "beginner", 2, 0.0),
        ("CONTD", "medium", 1, 0.0),
        ("complex", "beginner", 2, 0.0),
        ("complex", "medium", 1, 0.0),
    ]
    assert [(row.instructions, row.gestures) for row in rows[::2]] == [(2, 10), (2, 10), (2, 16)]
    assert to_csv(rows).splitlines()[1].startswith("STOP,2,10,beginner,2,1.0,0.0,")
    assert len(tell_table(rows)) == 7


def test_a_table_says_what_was_given_up(tmp_path):
    content = a_person("a", "expert")
    content["sentences"][0] |= {"done": False, "seconds": None}
    row = tabulate([content])[0]
    assert (row.seconds, row.given_up) == (None, 1)
    assert "1 given up" in tell_table([row])[1]


def test_a_file_that_is_no_result_is_named(tmp_path):
    (tmp_path / "person-x.json").write_text("{}", encoding="utf-8")
    with pytest.raises(UsageError, match="person-x"):
        read_people(str(tmp_path))


def test_the_picture_holds_all_words_and_confusions():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    for page in (summary_page(summary_of(diver.session)),):
        assert {"no sign was read", "no hand was read"} <= {
            item.text for item in page.items if isinstance(item, Text)
        }
    diver.sign("ok,0 3,5 5,5 ok,ok")
    page = summary_page(summary_of(diver.session, person="anna"))
    texts = [item.text for item in page.items if isinstance(item, Text)]
    assert {"STOP", "HOVER", "GO", "3", "Practice of anna"} <= set(texts)
    for item in page.items:
        assert item.x >= 0
        assert item.y <= page.height


def test_the_summary_in_lines():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.sign("ok,0 3,5 5,5 ok,ok")
    lines = list(tell_summary(summary_of(diver.session)))
    assert lines[0] == "1 of 1 sentence signed, 0 mistakes, 1 slip; 1.1 s a sign"
    assert lines[2] == "  5 as 3: 1 of 4"
