"""Names of the classes that a classifier answers with, and what a grammar may ask of them."""

from collections.abc import Collection
from typing import Final

from lightgesture.models.errors import ModelError

NONE: Final = "none"
"""Class of everything that is no token: other shapes of a hand, faces, arms, background."""

CLASSES: Final = ("0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok", NONE)
"""Classes of the shipped models and of the data folder: the ten tokens, then `none`. `left` and `right` say where the
thumb points in a left hand's patch. A model trained on other pictures has its own, `Classifier.classes`."""


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
