"""Real divers' hands beside those that a net learns from: `python -m lightgesture.benchmarks.divers.look`.

Both are cut as a classifier sees them and measured; the pool is right when the figures agree. A sheet shows them at
that size, every pixel a block.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.contact_sheet import WHITE, Image, save_picture, write
from lightgesture.benchmarks.divers.looks import MEASURES, Patches, Values, apart, measure, quantiles
from lightgesture.benchmarks.divers.pictures import DiverHand, read_divers, side_of
from lightgesture.benchmarks.studies.data import few_originals, training_of
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.cli import exit_status
from lightgesture.config.parsers import positive, whole
from lightgesture.console import print_line, say
from lightgesture.errors import ExitStatus, InputError
from lightgesture.features.patch import cut_patch
from lightgesture.sources import read_picture
from lightgesture.training.datasets import find_data
from lightgesture.training.pool.originals import PoolSettings
from lightgesture.training.pool.patch_kinds import KEPT, KINDS, MARGIN, RENDERED_SOURCE

RENDERED: Final = "rendered"
RENDERED_SHARE: Final = 0.25
"""Rendered hands over the hands that are copied: they take 40 ms each."""
FAMILIES: Final = {"bare": "bare sign", "glove": "gloved sign"}
"""Real hands that all others are compared with, by their gloves."""

TILE, COLUMNS, ROWS, CAPTION = 96, 12, 3, 16
"""Pixels of a patch on the sheet; patches side by side and below each other; pixels of a heading."""


@dataclass(frozen=True, slots=True, eq=False)
class Group:
    """Patches of one kind, uint8 (n, side, side, 3), with their margin; `is_real` where they show real divers."""

    name: str
    patches: Patches
    is_real: bool


def real_groups(data: Path) -> list[Group]:
    """Hands of `divers/boxes.csv`: bare and gloved signs, hands that show none, those that nobody could name."""
    found: dict[str, list[Image]] = {}
    for frame in (frame for frame in read_divers(data) if frame.hands):
        image = read_picture(frame.path)
        for hand in frame.hands:
            side = side_of(hand, frame, image.shape[1])
            found.setdefault(_family(hand), []).append(cut_patch(image, hand.outline, side, KEPT))
    return [Group(name, np.stack(found[name]), True) for name in sorted(found)]


def _family(hand: DiverHand) -> str:
    glove = FAMILIES.get(hand.glove, "unclear sign").removesuffix(" sign")
    if hand.is_sign:
        return f"{glove} sign"
    return f"{glove} unnamed" if hand.shape == "bad" else f"{glove} other"


def drawn_groups(data: Path, count: int, seed: int) -> Iterator[Group]:
    """A small pool of `count` hands of `hands/train`, a group for each kind that `train cnn` draws."""
    originals = few_originals(training_of(data), count)
    settings = PoolSettings()
    for number, (kind, draw) in enumerate(KINDS.items()):
        last = max(1, round(RENDERED_SHARE * count)) if kind == RENDERED else count
        random = np.random.default_rng((seed, number))
        patches = [
            cut_patch(sample.image, sample.box, sample.side, KEPT)
            for sample in draw(originals, settings, 0, last, random)
        ]
        if patches:
            yield Group(kind, np.stack(patches), False)


def kept_groups(folder: Path, count: int, seed: int) -> Iterator[Group]:
    """At most `count` patches of each kind that can be told apart in a pool that `train cnn` drew: copies of hands,
    rendered hands, and what is no hand. InputError: there is none.
    """
    try:
        patches = np.load(folder / "patches.npy", mmap_mode="r")
        names = json.loads((folder / "patches.json").read_text(encoding="utf-8"))
        sources, hands = np.array(names["sources"]), np.array(names["hands"], np.int64)
    except (OSError, ValueError, KeyError) as error:
        raise InputError(f"{folder}: holds no pool of `train cnn` ({error}); give another --pool") from None
    is_rendered = np.char.startswith(sources, RENDERED_SOURCE)
    random = np.random.default_rng(seed)
    for name, chosen in (
        ("copies", hands >= 0),
        (RENDERED, is_rendered),
        ("others", (hands < 0) & ~is_rendered),
    ):
        rows = np.flatnonzero(chosen)
        if len(rows):
            drawn = np.sort(random.permutation(rows)[:count])
            yield Group(name, np.asarray(patches[drawn], np.uint8), False)


def look_tables(groups: Sequence[Group]) -> list[Table]:
    """Quantiles of every measure in every group, and how far each is from the real signs."""
    measured = {group.name: measure(group.patches) for group in groups}
    signs = [name for name in FAMILIES.values() if name in measured]
    rows: list[dict[str, Cell]] = []
    for name in MEASURES:
        for group in groups:
            cells = dict(
                zip(("p5", "p25", "median", "p75", "p95"), quantiles(measured[group.name], name), strict=True)
            )
            rows.append(
                {
                    "measure": name,
                    "group": group.name,
                    "patches": len(group.patches),
                    **cells,
                    **_apart_cells(measured, group.name, name, signs),
                }
            )
    keys = tuple(f"apart_{glove}" for glove, name in FAMILIES.items() if name in signs)
    columns = ("measure", "group", "patches", "p5", "p25", "median", "p75", "p95", *keys)
    told = "\n".join(f"{name}: {text}" for name, text in MEASURES.items())
    note = f"apart: from real signs, the statistic of Kolmogorov and Smirnov, 0 the same, 1 disjoint.\n{told}"
    return [
        Table("look", "How hands look at the net's size", columns, tuple(rows), note),
        _means(groups, rows, keys),
    ]


def _apart_cells(
    measured: Mapping[str, Mapping[str, Values]], group: str, name: str, signs: Sequence[str]
) -> dict[str, Cell]:
    return {
        f"apart_{glove}": apart(measured[group][name], measured[sign][name])
        for glove, sign in FAMILIES.items()
        if sign in signs
    }


def _means(groups: Sequence[Group], rows: Sequence[Mapping[str, Cell]], keys: Sequence[str]) -> Table:
    """The mean of `apart` over all measures."""
    means: list[dict[str, Cell]] = []
    for group in groups:
        own = [row for row in rows if row["group"] == group.name]
        cells: dict[str, Cell] = {
            key: float(np.mean([float(row[key] or 0.0) for row in own])) for key in keys
        }
        means.append({"group": group.name, "real": "yes" if group.is_real else "no", **cells})
    title = "How far groups are from real signs, mean over the measures"
    return Table("look_apart", title, ("group", "real", *keys), tuple(means))


def sheet(groups: Sequence[Group], seed: int) -> Image:
    """Real hands to the left, the pool's to the right, uint8 (h, w, 3): some of each group at the net's size."""
    random = np.random.default_rng(seed)
    halves = [
        [_band(group, random) for group in groups if group.is_real is is_real] for is_real in (True, False)
    ]
    height = max(1, *(len(bands) for bands in halves)) * _band_height()
    columns = [_padded(np.vstack(bands), height) for bands in halves if bands]
    return np.hstack(
        [part for column in columns for part in (column, np.full((height, 8, 3), 255, np.uint8))][:-1]
    )


def _band_height() -> int:
    return CAPTION + ROWS * TILE


def _band(group: Group, random: np.random.Generator) -> Image:
    """Some patches of a group below its name."""
    band = np.zeros((_band_height(), COLUMNS * TILE, 3), np.uint8)
    inner = slice(MARGIN, group.patches.shape[1] - MARGIN)
    chosen = random.permutation(len(group.patches))[: ROWS * COLUMNS]
    for place, row in enumerate(chosen.tolist()):
        top, left = CAPTION + place // COLUMNS * TILE, place % COLUMNS * TILE
        shown = group.patches[row][inner, inner]
        size = (TILE - 2, TILE - 2)
        band[top : top + size[0], left : left + size[1]] = cv2.resize(
            shown, size, interpolation=cv2.INTER_NEAREST
        )
    write(band, group.name, (4, CAPTION - 4), WHITE)
    return band


def _padded(picture: NDArray[np.uint8], height: int) -> Image:
    lacking = height - len(picture)
    return np.vstack([picture, np.zeros((lacking, *picture.shape[1:]), np.uint8)]) if lacking else picture


def run(args: argparse.Namespace) -> int:
    """Measure, print, draw; 0 when all was done."""
    data = find_data(args.data)
    pool = (
        kept_groups(Path(args.pool), args.count, args.seed)
        if args.pool
        else drawn_groups(data, args.count, args.seed)
    )
    groups = [*real_groups(data), *pool]
    tables = look_tables(groups)
    if args.json:
        for row in (row for table in tables for row in table.to_dicts()):
            print_line(json.dumps(row, ensure_ascii=False))
    else:
        print_line(to_text(tables))
    if args.out:
        path = Path(args.out) / "look.png"
        save_picture(path, sheet(groups, args.seed))
        say(f"wrote {path}")
    return ExitStatus.OK


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.divers.look",
        description="How real divers' hands look beside those that a net learns from.",
    )
    parser.add_argument("--data", metavar="DIR", help="folder of labelled pictures (default: ../shared/data)")
    parser.add_argument(
        "--pool",
        metavar="DIR",
        help="pool that train cnn drew, its .parts folder (default: a small one of each kind is drawn here)",
    )
    parser.add_argument(
        "--count", type=positive, default=1000, metavar="N", help="hands, or patches of a kind (default 1000)"
    )
    parser.add_argument("--seed", type=whole, default=0, metavar="N", help="of all that is drawn (default 0)")
    parser.add_argument("--json", action="store_true", help="one JSON object per table row on stdout")
    parser.add_argument("--out", metavar="DIR", help="write a sheet of both here")
    args = parser.parse_args(argv)
    return exit_status(lambda: run(args), "nothing was printed")


if __name__ == "__main__":
    sys.exit(main())
