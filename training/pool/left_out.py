"""Which sources a training does not see, so that an evaluation can score a model on these and on no others.

A source is the name in the column `set` of `hands`, `webcam` and `negatives`, and the folder below `frames/`. What was
left out stands in the model's card, which the evaluation reads: nobody has to remember which file goes with which fold.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lightgesture.errors import InputError
from lightgesture.features.files import read_whole
from lightgesture.training.datasets import fold_of

CARD_KEY = "left_out"
LARGEST_CARD = 1 << 20
"""Bytes of a card; ours take some ten thousand."""


@dataclass(frozen=True, slots=True)
class LeftOut:
    """sources: left out by name. fold: number of the fold that is left out besides, 1 to `folds`; None for none."""

    sources: frozenset[str] = frozenset()
    fold: int | None = None
    folds: int = 5

    def covers(self, source: str) -> bool:
        """Whether a source is left out."""
        return source in self.sources or (
            self.fold is not None and fold_of(source, self.folds) == self.fold - 1
        )

    def to_card(self) -> dict[str, Any]:
        """What stands in a model's card under `CARD_KEY`."""
        fold = None if self.fold is None else f"{self.fold}/{self.folds}"
        return {"sources": sorted(self.sources), "fold": fold}


def left_out(sources: Iterable[str] = (), fold: str | None = None) -> LeftOut:
    """From names and from a fold written "2/5". ValueError: it is no fold."""
    if fold is None:
        return LeftOut(frozenset(sources))
    number, slash, folds = fold.partition("/")
    if not (slash and number.isdecimal() and folds.isdecimal() and 1 <= int(number) <= int(folds)):
        raise ValueError(f"{fold!r} is no fold; write one such as 2/5, from 1 to the number of folds")
    return LeftOut(frozenset(sources), int(number), int(folds))


def read_left_out(model: Path) -> LeftOut:
    """What the card beside a model file (its name with the suffix .json) says was left out. Raises InputError."""
    card = model.with_suffix(".json")
    try:
        content = json.loads(read_whole(card, LARGEST_CARD).decode("utf-8"))
        return _from_card(content)
    except OSError as error:
        reason = error.strerror or "not readable"
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        reason = f"no card that says what was left out: {error}"
    raise InputError(f"{card}: {reason}; train with --without or --fold to have it written")


def _from_card(card: Mapping[str, Any]) -> LeftOut:
    content = card[CARD_KEY]
    sources, fold = content["sources"], content["fold"]
    if not isinstance(sources, list) or not isinstance(fold, str | None):
        raise ValueError("sources must be a list, and fold a text such as 2/5 or null")
    return left_out([str(name) for name in sources], fold)
