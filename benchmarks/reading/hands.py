"""Reading hands in given boxes: accuracy per token and per source, and how well `none` is told apart.

Accuracy is the argmax over the ten tokens with nothing refused, on hands of the ten tokens; the hands
labelled `none` enter the AUROC of P(none) and the share that the argmax over all classes refuses. Beside it stands
what the product would read, by its own rule and threshold.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.methods import Classifier
from lightgesture.benchmarks.scorer import (
    Tally,
    accuracy_by,
    auroc,
    confusion,
    is_token,
    macro_average,
    share,
    wilson_interval,
    worst,
)
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.hands.reading import ReadingSettings, read_token
from lightgesture.models import NONE
from lightgesture.sources import read_picture
from lightgesture.training.datasets import Label, Sample

UNSIDED = "left"
"""Side that a hand of unknown side is read as: it is not mirrored, as crops are not."""


@dataclass(frozen=True, slots=True, eq=False)
class HandAnswer:
    """One labelled hand and the classifier's answer. probabilities: float32 (classes,), columns named by `classes`."""

    sample: Sample
    label: Label
    classes: tuple[str, ...]
    probabilities: NDArray[np.float32]

    @property
    def token(self) -> str:
        """The likeliest of the ten."""
        return self.likeliest_tokens()[0][0]

    @property
    def best(self) -> str:
        """The likeliest of all classes."""
        return self.classes[int(self.probabilities.argmax())]

    @property
    def none(self) -> float | None:
        """P(none), None for a model that has no such class."""
        return float(self.probabilities[self.classes.index(NONE)]) if NONE in self.classes else None

    @property
    def read(self) -> str | None:
        """What the product reads at its default threshold, None where it refuses."""
        return read_token(self.probabilities, self.classes, False, False, ReadingSettings())[0]

    def likeliest_tokens(self, count: int = 1) -> list[tuple[str, float]]:
        """The likeliest of the ten tokens and their probabilities, the first of equals first."""
        order = np.argsort(-self.probabilities, kind="stable")
        named = [(self.classes[place], float(self.probabilities[place])) for place in order]
        return [(name, value) for name, value in named if name != NONE][:count]

    @property
    def truth(self) -> str:
        return self.label.token or ""

    @property
    def failed(self) -> bool:
        """A hand of the ten tokens that was read as another of them."""
        return is_token(self.label.token) and self.token != self.label.token


def classify(classifier: Classifier, samples: Iterable[Sample]) -> list[HandAnswer]:
    """The classifier's answer to every labelled hand whose token is known."""
    answers: list[HandAnswer] = []
    for sample in samples:
        labels = [label for label in sample.labels if label.token is not None]
        if labels:
            probabilities = classifier.probabilities(
                read_picture(sample.path),
                [label.box for label in labels],
                [label.side or UNSIDED for label in labels],
            )
            classes = tuple(classifier.classes)
            answers.extend(
                HandAnswer(sample, label, classes, row)
                for label, row in zip(labels, probabilities, strict=True)
            )
    return answers


def summary_table(parts: Sequence[tuple[str, Sequence[HandAnswer]]], model: str) -> Table:
    """Accuracy of each named part, with its 95 % interval, the macro averages and the worst token."""
    columns = (
        *("model", "part", "hands", "right", "accuracy", "low_95", "high_95", "macro_token", "macro_source"),
        *("worst_token", "worst_accuracy", "none_hands", "none_auroc", "none_refused", "tokens_refused"),
        *("read", "read_wrong", "none_read"),
    )
    rows = tuple({"model": model, **summary_cells(part, answers)} for part, answers in parts if answers)
    note = (
        "accuracy: argmax over the ten tokens, nothing refused; none_auroc: P(none) of `none` hands against "
        "tokens;\nnone_refused, tokens_refused: shares whose argmax over all classes is `none`; read, read_wrong: "
        "shares of the\ntokens that the product reads rightly and wrongly at its threshold of "
        f"{ReadingSettings().token_probability}; none_read: of the `none` hands\nthat get a token there."
    )
    return Table("hands", "Hands in given boxes", columns, rows, note)


def summary_cells(part: str, answers: Sequence[HandAnswer]) -> dict[str, Cell]:
    """Figures of one part; see the note of the table."""
    tokens = token_answers(answers)
    others = [answer for answer in answers if not is_token(answer.label.token)]
    right = sum(not answer.failed for answer in tokens)
    by_token = _tallies(tokens, [answer.truth for answer in tokens])
    by_source = _tallies(tokens, [answer.sample.source for answer in tokens])
    low, high = wilson_interval(right, len(tokens))
    weakest = worst(by_token)
    return {
        "part": part,
        "hands": len(tokens),
        "right": right,
        "accuracy": share(right, len(tokens)),
        "low_95": low,
        "high_95": high,
        "macro_token": macro_average(by_token),
        "macro_source": macro_average(by_source),
        "worst_token": weakest[0] if weakest else None,
        "worst_accuracy": weakest[1].accuracy if weakest else None,
        "none_hands": len(others),
        "none_auroc": auroc(_none_scores(others), _none_scores(tokens)),
        "none_refused": _refused(others),
        "tokens_refused": _refused(tokens),
        "read": share(sum(answer.read == answer.truth for answer in tokens), len(tokens)),
        "read_wrong": share(sum(answer.read not in (None, answer.truth) for answer in tokens), len(tokens)),
        "none_read": share(sum(answer.read is not None for answer in others), len(others)),
    }


def by_token_table(answers: Sequence[HandAnswer], model: str) -> Table:
    """Accuracy per token, and what each is most often mistaken for."""
    tokens = token_answers(answers)
    pairs = confusion([answer.truth for answer in tokens], [answer.token for answer in tokens])
    rows = []
    for token, tally in sorted(_tallies(tokens, [answer.truth for answer in tokens]).items()):
        wrong = [(count, read) for (truth, read), count in pairs.items() if truth == token != read]
        mistakes = sorted(wrong, reverse=True)
        named = ", ".join(f"{read} ({count})" for count, read in mistakes[:3])
        rows.append({"model": model, "token": token, **_tally_cells(tally), "mistaken_for": named})
    columns = ("model", "token", "hands", "right", "accuracy", "mistaken_for")
    return Table("hands_by_token", "Hands in given boxes, per token", columns, tuple(rows))


def by_source_table(answers: Sequence[HandAnswer], model: str) -> Table:
    """Accuracy per source, the worst first."""
    tokens = token_answers(answers)
    tallies = _tallies(tokens, [answer.sample.source for answer in tokens])
    ordered = sorted(tallies.items(), key=lambda item: (item[1].accuracy or 0.0, -item[1].count))
    rows = tuple({"model": model, "source": source, **_tally_cells(tally)} for source, tally in ordered)
    columns = ("model", "source", "hands", "right", "accuracy")
    return Table("hands_by_source", "Hands in given boxes, per source", columns, rows)


def confusion_table(answers: Sequence[HandAnswer], model: str) -> Table:
    """Counts of each (truth, answer), truth down and answers across."""
    tokens = token_answers(answers)
    pairs = confusion([answer.truth for answer in tokens], [answer.token for answer in tokens])
    names = sorted({name for pair in pairs for name in pair})
    rows: list[dict[str, Cell]] = []
    for truth in names:
        counts: dict[str, Cell] = {read: pairs[truth, read] for read in names}
        rows.append({"model": model, "truth": truth, **counts})
    title = "Confusion of tokens (row: truth, column: read as)"
    return Table("hands_confusion", title, ("model", "truth", *names), tuple(rows))


def token_answers(answers: Sequence[HandAnswer]) -> list[HandAnswer]:
    """The hands of the ten tokens."""
    return [answer for answer in answers if is_token(answer.label.token)]


def _tallies(answers: Sequence[HandAnswer], keys: Sequence[str]) -> dict[str, Tally]:
    return accuracy_by(keys, [answer.truth for answer in answers], [answer.token for answer in answers])


def _tally_cells(tally: Tally) -> dict[str, Cell]:
    return {"hands": tally.count, "right": tally.right, "accuracy": tally.accuracy}


def _none_scores(answers: Sequence[HandAnswer]) -> list[float]:
    return [answer.none for answer in answers if answer.none is not None]


def _refused(answers: Sequence[HandAnswer]) -> float | None:
    return share(sum(answer.best == "none" for answer in answers), len(answers))
