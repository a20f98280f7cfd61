"""Tables as text and as JSON rows."""

import json

from lightgesture.benchmarks.tables import Table, side_by_side, to_text

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


def test_like_tables_stand_side_by_side():
    def table(model, *keys):
        return Table("t", "T", ("model", "key"), tuple({"model": model, "key": key} for key in keys), "N")

    joined = side_by_side([table("a", "x", "y"), table("b", "y", "z", "x")], "key")
    assert [(row["key"], row["model"]) for row in joined.rows] == [
        *(("x", "a"), ("x", "b"), ("y", "a"), ("y", "b"), ("z", "b")),
    ]
    assert (joined.name, joined.note) == ("t", "N")
    wide = Table("t", "T", ("model", "more"), ({"model": "c", "more": 1},))
    both = side_by_side([table("a", "x"), wide])
    assert both.columns == ("model", "key", "more")
    assert [row["model"] for row in both.rows] == ["a", "c"]
