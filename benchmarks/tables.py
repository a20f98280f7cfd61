"""Tables of results: aligned text for people, one object per row for programs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

Cell = str | int | float | None


@dataclass(frozen=True, slots=True)
class Table:
    """A titled table.

    name: short key that stands in every JSON row. title: heading of the text. columns: keys of the rows.
    rows: one mapping a row; a missing key is an empty cell. note: a line below the text, or "".
    """

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[Mapping[str, Cell], ...]
    note: str = ""

    def to_dicts(self) -> list[dict[str, Cell]]:
        """One object per row, floats rounded to six digits."""
        return [
            {"table": self.name, **{column: _rounded(row.get(column)) for column in self.columns}}
            for row in self.rows
        ]

    def to_text(self) -> str:
        """The table as aligned columns under its title: text to the left, numbers to the right."""
        cells = [[_text(row.get(column)) for column in self.columns] for row in self.rows]
        widths = [
            max([len(column), *(len(line[index]) for line in cells)])
            for index, column in enumerate(self.columns)
        ]
        leads = [any(isinstance(row.get(column), str) for row in self.rows) for column in self.columns]
        lines = [_aligned(line, widths, leads) for line in [list(self.columns), *cells]]
        rule = "  ".join("-" * width for width in widths)
        note = [self.note] if self.note else []
        return "\n".join([self.title, lines[0], rule, *lines[1:], *note])


def to_text(tables: Sequence[Table]) -> str:
    """All tables, an empty line between them."""
    return "\n\n".join(table.to_text() for table in tables)


def side_by_side(tables: Sequence[Table], key: str | None = None) -> Table:
    """The rows of several like tables as one: rows with an equal cell in the column `key` stand together, in the order
    in which the cells first appear; without a key, one table's rows follow the other's.
    """
    columns = tuple(dict.fromkeys(column for table in tables for column in table.columns))
    rows = [row for table in tables for row in table.rows]
    if key is not None:
        places = {cell: place for place, cell in enumerate(dict.fromkeys(row[key] for row in rows))}
        rows.sort(key=lambda row: places[row[key]])
    first = tables[0]
    return Table(first.name, first.title, columns, tuple(rows), first.note)


def _aligned(cells: Sequence[str], widths: Sequence[int], leads: Sequence[bool]) -> str:
    padded = [
        cell.ljust(width) if is_left else cell.rjust(width)
        for cell, width, is_left in zip(cells, widths, leads, strict=True)
    ]
    return "  ".join(padded).rstrip()


def _text(cell: Cell) -> str:
    if cell is None:
        return ""
    return f"{cell:.3f}" if isinstance(cell, float) else str(cell)


def _rounded(cell: Cell) -> Cell:
    return round(cell, 6) if isinstance(cell, float) else cell
