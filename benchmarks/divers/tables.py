"""Tables of how divers' hands were found and read, made of rows of hands and of frames."""

from collections.abc import Sequence

from lightgesture.benchmarks.divers.pictures import TOKENS
from lightgesture.benchmarks.divers.rows import FrameRow, HandRow, by_method
from lightgesture.benchmarks.scorer import FOUND_IOU, auroc, share
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.hands.reading import ReadingSettings

SIZES = (40.0, 60.0, 100.0)
"""Bounds of the groups by size, pixels."""

CONTRASTS = (8.0, 16.0, 24.0)
"""Bounds of the groups by contrast, CIE76."""

ALL = "all"
UNTOLD = "not told"
"""Shape of hands of sets that do not say what they show."""
SIGN_AXES = (ALL, "glove", "place", "size", "contrast", "view", "token")
OTHER_AXES = (ALL, "glove", "place", "shape")
"""By what shown signs, and hands that show none, are told apart."""


def group_of(row: HandRow, axis: str) -> str:
    """The group of a hand along one of the axes."""
    match axis:
        case "glove" | "place" | "view":
            return str(getattr(row, axis))
        case "shape":
            return row.shape or UNTOLD
        case "token":
            return row.shape
        case "size":
            return bin_name(row.size, SIZES)
        case "contrast":
            return bin_name(row.contrast, CONTRASTS)
        case _:
            return ALL


def bin_name(value: float, bounds: Sequence[float]) -> str:
    """Name of the group of a value among those that the bounds part."""
    low = max((bound for bound in bounds if bound <= value), default=None)
    high = min((bound for bound in bounds if bound > value), default=None)
    if low is None:
        return f"under {high:g}"
    return f"{low:g} or more" if high is None else f"{low:g} to {high:g}"


def _order(axis: str, name: str) -> tuple[float, str]:
    """Groups by size and contrast go up, all others by name."""
    if axis not in ("size", "contrast"):
        return 0.0, name
    return (-1.0 if name.startswith("under") else float(name.split()[0])), name


def diver_tables(hands: Sequence[HandRow], frames: Sequence[FrameRow]) -> list[Table]:
    """All tables; those without rows are left out."""
    tables = [signs_table(hands), others_table(hands), stray_table(frames)]
    return [table for table in tables if table.rows]


def signs_table(hands: Sequence[HandRow]) -> Table:
    """Shown signs, in whole frames and in given boxes: a row a method and group."""
    rows: list[dict[str, Cell]] = []
    for axis in SIGN_AXES:
        groups: dict[str, dict[str, list[HandRow]]] = {}
        for method, own in by_method(row for row in hands if row.shape in TOKENS).items():
            for row in own:
                groups.setdefault(group_of(row, axis), {}).setdefault(method, []).append(row)
        for name in sorted(groups, key=lambda name: _order(axis, name)):
            rows += [
                {"by": axis, "group": name, "method": method, **sign_cells(own)}
                for method, own in groups[name].items()
            ]
    columns = (
        *("by", "group", "method", "signs", "found", "found_share", "read", "read_share", "wrong"),
        *("named", "named_share", "given_read", "given_read_share", "given_wrong", "given_wrong_share"),
    )
    note = (
        f"found: IoU >= {FOUND_IOU} with the label, at most two boxes a frame, single pictures; read: found and the "
        "right token; wrong: found and another\ntoken. In given boxes (sides x 0.92): named, the right one is the "
        "likeliest of the ten tokens; given_read, given_wrong: what the product reads\nat its threshold of "
        f"{ReadingSettings().token_probability}. size: pixels at 640 wide; contrast: of the hand's middle with what "
        "is around it, CIE76."
    )
    return Table("signs", "Shown signs", columns, tuple(rows), note)


def sign_cells(rows: Sequence[HandRow]) -> dict[str, Cell]:
    """Counts and shares of shown signs."""
    count = len(rows)
    found = sum(row.iou > 0 for row in rows)
    read = sum(row.found_token == row.shape for row in rows)
    named = sum(row.named == row.shape for row in rows)
    given = sum(row.given_token == row.shape for row in rows)
    wrong = sum(row.given_token not in ("", row.shape) for row in rows)
    return {
        "signs": count,
        "found": found,
        "found_share": share(found, count),
        "read": read,
        "read_share": share(read, count),
        "wrong": sum(row.found_token not in ("", row.shape) for row in rows),
        "named": named,
        "named_share": share(named, count),
        "given_read": given,
        "given_read_share": share(given, count),
        "given_wrong": wrong,
        "given_wrong_share": share(wrong, count),
    }


def others_table(hands: Sequence[HandRow]) -> Table:
    """Hands that show no sign of the language, by what they do show: none of them may get a token; and those of sets
    that do not say."""
    rows: list[dict[str, Cell]] = []
    for method, own in by_method(hands).items():
        signs = [row for row in own if row.shape in TOKENS]
        others = [row for row in own if row.shape not in TOKENS]
        for axis in OTHER_AXES:
            for name in sorted({group_of(row, axis) for row in others}):
                members = [row for row in others if group_of(row, axis) == name]
                against = [
                    row for row in signs if axis not in ("glove", "place") or group_of(row, axis) == name
                ]
                rows.append({"by": axis, "group": name, "method": method, **_other_cells(members, against)})
    columns = (
        *("by", "group", "method", "hands", "found", "found_share", "token", "given_token"),
        *("given_token_share", "none_auroc"),
    )
    note = (
        "token, given_token: hands that got a token in whole frames and in given boxes; none_auroc: P(none) of these "
        "hands against\nthat of shown signs (by glove and place: of the same)."
    )
    return Table(
        "other_hands",
        "Hands that show no sign, or of which nobody says what they show",
        columns,
        tuple(rows),
        note,
    )


def _other_cells(rows: Sequence[HandRow], signs: Sequence[HandRow]) -> dict[str, Cell]:
    found = sum(row.iou > 0 for row in rows)
    given = sum(bool(row.given_token) for row in rows)
    return {
        "hands": len(rows),
        "found": found,
        "found_share": share(found, len(rows)),
        "token": sum(bool(row.found_token) for row in rows),
        "given_token": given,
        "given_token_share": share(given, len(rows)),
        "none_auroc": auroc(
            [row.p_none for row in rows if row.p_none is not None],
            [row.p_none for row in signs if row.p_none is not None],
        ),
    }


def stray_table(frames: Sequence[FrameRow]) -> Table:
    """Tokens where none is shown, by place."""
    rows: list[dict[str, Cell]] = [
        {"place": name, "method": method, **_stray_cells(own, name)}
        for method, own in by_method(frames).items()
        for name in (ALL, *sorted({row.place for row in own}))
    ]
    rows.sort(key=lambda row: (row["place"] != ALL, str(row["place"])))
    columns = (
        *("place", "method", "frames", "any_hand", "any_token", "two_tokens", "sign_frames", "stray_frames"),
    )
    note = (
        "frames: those in which no sign is shown, and of them those in which a hand was found, a token was read, two "
        "were read;\nsign_frames: those in which one is, and of them those with a token read elsewhere than on it."
    )
    return Table("stray", "Tokens where none is shown", columns, tuple(rows), note)


def _stray_cells(frames: Sequence[FrameRow], place: str) -> dict[str, Cell]:
    own = [row for row in frames if place in (ALL, row.place)]
    idle = [row for row in own if not row.signs]
    signed = [row for row in own if row.signs]
    return {
        "frames": len(idle),
        "any_hand": sum(row.found > 0 for row in idle),
        "any_token": sum(row.stray > 0 for row in idle),
        "two_tokens": sum(row.stray > 1 for row in idle),
        "sign_frames": len(signed),
        "stray_frames": sum(row.stray > 0 for row in signed),
    }
