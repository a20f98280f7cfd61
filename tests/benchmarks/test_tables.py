"""Tables as text and as JSON rows."""

import json

from lightgesture.benchmarks.tables import Table, to_text

TABLE = Table(
    "t", "A title", ("name", "n", "share"), ({"name": "a", "n": 7, "share": 0.5}, {"name": "long"}), "A note."
)


def test_text_is_aligned_under_its_title():
    assert TABLE.to_text().splitlines() == [
        "A title",
        "name  n  share",
        "----  -  -----",
        "a     7  0.500",
        "long",
        "A note.",
    ]


def test_rows_are_plain_json_with_every_column():
    rows = json.loads(json.dumps(TABLE.to_dicts()))
    assert rows == [
        {"table": "t", "name": "a", "n": 7, "share": 0.5},
        {"table": "t", "name": "long", "n": None, "share": None},
    ]


def test_tables_are_separated_by_an_empty_line():
    assert to_text([TABLE, TABLE]).count("\n\n") == 1
