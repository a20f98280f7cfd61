"""What a classifier learns from and answers with: names of classes, and one labelled hand in a picture."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Final

from lightgesture.features.types import Box, Image
from lightgesture.models.errors import ModelError

NONE: Final = "none"
"""Class of everything that is no token: other shapes of a hand, faces, arms, background."""

CLASSES: Final = ("0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok", NONE)
"""Classes of the shipped models and of the data folder: the ten tokens, then `none`. `left` and `right` say where the
thumb points in a left hand's patch. A model trained on other pictures has its own, `Classifier.classes`."""


def in_order(names: Iterable[str]) -> tuple[str, ...]:
    """Each of the names once: those of `CLASSES` as they stand there, then the others by name, `none` last."""
    found = set(names)
    own = sorted(found.difference(CLASSES))
    known = [name for name in CLASSES if name in found and name != NONE]
    return (*known, *own, *({NONE} & found))


def check_classes(classes: Collection[str], tokens: Collection[str]) -> str | None:
    """A line that warns of the classes of a model that a grammar does not know; None where it knows all.

    classes: of the model. tokens: of the grammar. Raises ModelError naming tokens that the model cannot read: whoever
    signs a word of theirs would wait in vain.
    """
    readable = [name for name in classes if name != NONE]
    unreadable = [token for token in tokens if token not in readable]
    if unreadable:
        raise ModelError(
            f"tokens of the grammar that the model cannot read: {', '.join(unreadable)}; "
            "take them out of the grammar or train a model with these classes"
        )
    unknown = [name for name in readable if name not in tokens]
    if not unknown:
        return None
    return (
        f"classes of the model that the grammar does not know: {', '.join(unknown)}; such a sign is never a word, "
        "add it to the grammar's tokens to use it"
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrainingSample:
    """One hand, or one region that is none.

    image: uint8 (height, width, 3), BGR. box: outline, pixels of `image`. side: the diver's own, "left" or "right".
    token: class name. source: the person, room and camera; a held-out fold holds whole sources.
    hand: number of the hand that this is or is a copy of, -1 where it is of none; with few sources a held-out fold
    holds whole hands. original: False for an altered copy; only originals count in scores. weight: how much it counts
    in training beside others of its class and source, 0 or more.
    """

    image: Image
    box: Box
    side: str
    token: str
    source: str
    hand: int = -1
    original: bool = True
    weight: float = 1.0
