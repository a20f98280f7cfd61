"""What is compared: the pipeline and the paper's chain behind one small interface."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture import models
from lightgesture.benchmarks.paper.bank import HandBank
from lightgesture.benchmarks.paper.chain import PaperChain, PaperHand
from lightgesture.benchmarks.scorer import Reading
from lightgesture.features.colour import ColourStage
from lightgesture.features.find.selector import SELECTORS, SelectorName, load_selector
from lightgesture.features.profile import ColourProfile
from lightgesture.features.types import Box
from lightgesture.fsm import Decoder, Event, Instruction, Rejected, Signs, Word, load_grammar
from lightgesture.fsm.language.settings import Rule
from lightgesture.hands import HandReader, ReadingStage
from lightgesture.pipeline import Pipeline
from lightgesture.records import FrameRecord

Image = NDArray[np.uint8]


class Classifier(Protocol):
    """What reads hands in given boxes."""

    @property
    def classes(self) -> Sequence[str]:
        """Names of the columns of `probabilities`."""
        ...

    def probabilities(
        self, image_bgr: Image, boxes: Sequence[Box], sides: Sequence[str]
    ) -> NDArray[np.float32]:
        """float32 (number of boxes, number of classes), rows that sum to one."""
        ...


@dataclass(frozen=True, slots=True)
class Decoded:
    """What a sequence was decoded to: accepted words, texts of instructions, number of rejected sentences.

    word_times: seconds at which each word was accepted; they take no part in comparisons.
    """

    words: tuple[str, ...]
    instructions: tuple[str, ...]
    rejected: int
    word_times: tuple[float, ...] = field(default=(), compare=False)


class Stream(Protocol):
    """A method over the frames of one sequence, with its memory."""

    def process(self, image: Image, time_s: float) -> list[Reading]:
        """The hands of the next frame."""
        ...

    def finish(self) -> Decoded:
        """What all frames were decoded to."""
        ...


RULE: Final[Rule] = "frames"
"""When a sign counts, for every row: the paper's rule. `decoder.sentences` has what the product does by default."""


class Method(Protocol):
    """A way from pictures to hands."""

    @property
    def name(self) -> str:
        """Name in the tables."""
        ...

    def read(self, image: Image) -> list[Reading]:
        """The hands of a single picture, without memory."""
        ...

    def stream(self, hold: int | None) -> Stream:
        """A fresh memory for a sequence; hold None is the default dwell."""
        ...


class PipelineMethod:
    """The product, or a variant of it: a name, and what opens its pipeline with a hold (None: the default dwell)."""

    def __init__(self, name: str, open_pipeline: Callable[[int | None], Pipeline]) -> None:
        self._name = name
        self._open = open_pipeline
        self._single = open_pipeline(None)

    @property
    def name(self) -> str:
        return self._name

    def read(self, image: Image) -> list[Reading]:
        return _readings(self._single.recognize(image))

    def stream(self, hold: int | None) -> Stream:
        return _PipelineStream(self._open(hold))


def product(model: str, selector: SelectorName = SELECTORS[0]) -> PipelineMethod:
    """The product with the named model; under the name of its selector too, where it is not the default one."""
    name = "lightgesture" if selector == SELECTORS[0] else f"lightgesture, {selector}"
    return PipelineMethod(name, lambda hold: Pipeline(model=model, selector=selector, rule=RULE, hold=hold))


def reading_method(
    name: str,
    classifier: models.Classifier,
    selector: str = SELECTORS[0],
    profile: ColourProfile | None = None,
) -> PipelineMethod:
    """The product with a classifier that is open, and a selector by name or by its file, whose learned choice is taken.

    profile: the colours of the hands. Raises lightgesture.features.find.selector_file.SelectorError.
    """
    if selector in SELECTORS:
        find = load_selector("classical" if selector == "classical" else "learned")
    else:
        find = load_selector(SELECTORS[0], selector)
    front = HandReader(ReadingStage(classifier), find=find, colour=ColourStage(profile=profile))
    return PipelineMethod(name, lambda hold: Pipeline(front.for_stream(), rule=RULE, hold=hold))


class _PipelineStream:
    def __init__(self, pipeline: Pipeline) -> None:
        self._pipeline = pipeline
        self._events: list[Event] = []
        self._index = 0

    def process(self, image: Image, time_s: float) -> list[Reading]:
        readings: list[Reading] = []
        for record in self._pipeline.process(image, time_s, self._index):
            if isinstance(record, FrameRecord):
                readings = _readings(record)
            elif isinstance(record, Event):
                self._events.append(record)
        self._index += 1
        return readings

    def finish(self) -> Decoded:
        for record in self._pipeline.finish():
            if isinstance(record, Event):
                self._events.append(record)
        return decoded(self._events)


class PaperMethod:
    """The paper's region selection; tokens from the nearest bank contour, or from a classifier if given."""

    def __init__(self, bank: HandBank, classifier: Classifier | None = None) -> None:
        self._bank = bank
        self._classifier = classifier

    @property
    def name(self) -> str:
        return "paper, bank" if self._classifier is None else "paper, classifier"

    def read(self, image: Image) -> list[Reading]:
        return self.name_hands(image, PaperChain(self._bank).process(image))

    def stream(self, hold: int | None) -> Stream:
        return _PaperStream(self, PaperChain(self._bank), hold)

    def name_hands(self, image: Image, hands: Sequence[PaperHand]) -> list[Reading]:
        """Readings of the chosen regions of a frame."""
        if self._classifier is None or not hands:
            return [Reading(hand.box, hand.side, hand.token) for hand in hands]
        classifier = self._classifier
        probabilities = classifier.probabilities(
            image, [hand.box for hand in hands], [hand.side for hand in hands]
        )
        names = [classifier.classes[int(index)] for index in probabilities.argmax(axis=1)]
        return [
            Reading(hand.box, hand.side, None if name == "none" else name)
            for hand, name in zip(hands, names, strict=True)
        ]


class _PaperStream:
    def __init__(self, method: PaperMethod, chain: PaperChain, hold: int | None) -> None:
        self._method = method
        self._chain = chain
        self._decoder = Decoder(load_grammar(), rule=RULE, hold=hold)
        self._events: list[Event] = []

    def process(self, image: Image, time_s: float) -> list[Reading]:
        readings = self._method.name_hands(image, self._chain.process(image))
        tokens = {reading.side: reading.token for reading in readings}
        self._events.extend(
            self._decoder.step(Signs.of_tokens(tokens.get("left"), tokens.get("right")), time_s)
        )
        return readings

    def finish(self) -> Decoded:
        self._events.extend(self._decoder.finish())
        return decoded(self._events)


def decoded(events: Sequence[Event]) -> Decoded:
    """Words, instructions and rejections of a sequence's events."""
    return Decoded(
        words=tuple(event.word for event in events if isinstance(event, Word)),
        instructions=tuple(event.text for event in events if isinstance(event, Instruction)),
        rejected=sum(isinstance(event, Rejected) for event in events),
        word_times=tuple(event.time_s for event in events if isinstance(event, Word)),
    )


def _readings(record: FrameRecord) -> list[Reading]:
    return [Reading(hand.box, hand.side, hand.token, hand.track) for hand in record.hands]
