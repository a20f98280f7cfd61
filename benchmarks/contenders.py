"""What is timed side by side: each takes the same few frames in turn, so that a busy machine slows all of them alike.

Times are processor time of all threads: while another program has the core, no time goes by.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from time import process_time
from typing import Final, get_args

import cv2
import numpy as np

from lightgesture.benchmarks.timing import WARM_UP, Image
from lightgesture.features.find.selector import SelectorName
from lightgesture.front_end import StageClock
from lightgesture.fsm import Decoder, Signs, load_grammar
from lightgesture.fsm.language.settings import Rule
from lightgesture.hands import HandReader
from lightgesture.pipeline import Pipeline
from lightgesture.sources import DEFAULT_FPS

RULES: Final[tuple[Rule, ...]] = get_args(Rule)
BLOCK: Final = 10
"""Frames in a row: the first finds cold caches, where another way had the core, as no video's others do."""
COPY: Final = "copy of the frame"
TEXTBOOK: Final = "textbook: blur, HSV, mask, morphology, contours"
SKIN: Final = ((0, 48, 80), (20, 255, 255))
"""Lower and upper hue, saturation and value of the textbook's skin."""


@dataclass(frozen=True, slots=True)
class Contender:
    """call: takes a frame and its seconds; what it gives, if it is a text, tells the kind of the frame."""

    name: str
    call: Callable[[Image, float], object]


class Product:
    """The pipeline with some options; `call` tells whether it searched the frame or followed the hands."""

    def __init__(self, model: str, selector: SelectorName = "learned") -> None:
        self._pipeline = Pipeline(model=model, selector=selector)
        self._seen = 0

    def call(self, image: Image, time_s: float) -> str:
        """Process a frame."""
        if self._seen == WARM_UP:
            self._pipeline.front.clock = StageClock()
        self._seen += 1
        self._pipeline.process(image, time_s)
        front = self._pipeline.front
        return "searched" if isinstance(front, HandReader) and front.is_searched else "followed"

    def stages(self) -> dict[str, tuple[float, ...]]:
        """Milliseconds of each stage, after the warm-up."""
        return self._pipeline.front.clock.stages_ms


def textbook(image: Image, time_s: float) -> object:
    """What a tutorial does to find skin, without reading anything."""
    del time_s
    colours = cv2.cvtColor(cv2.GaussianBlur(image, (5, 5), 0), cv2.COLOR_BGR2HSV)
    mask = cv2.inRange(colours, np.array(SKIN[0]), np.array(SKIN[1]))
    kernel = np.ones((5, 5), np.uint8)
    mask = cv2.morphologyEx(cv2.morphologyEx(mask, cv2.MORPH_OPEN, kernel), cv2.MORPH_CLOSE, kernel)
    return len(cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)[0])


def _copy(image: Image, time_s: float) -> object:
    del time_s
    return image.copy().size


def yardsticks() -> list[Contender]:
    """What every machine can be measured by."""
    return [Contender(COPY, _copy), Contender(TEXTBOOK, textbook)]


def products() -> tuple[list[Contender], Product]:
    """The pipelines, and the default one for its stages."""
    default = Product("cnn")
    made = {
        "learned, CNN": default,
        "learned, SVM": Product("svm"),
        "classical, CNN": Product("cnn", "classical"),
        "classical, SVM": Product("svm", "classical"),
    }
    cards = Pipeline(front_end="tags")
    contenders = [Contender(name, product.call) for name, product in made.items()]
    contenders.append(Contender("cards, none in view", lambda image, time_s: _done(cards, image, time_s)))
    return contenders, default


def _done(pipeline: Pipeline, image: Image, time_s: float) -> None:
    pipeline.process(image, time_s)


def decoders(frames: Iterable[Image]) -> list[Contender]:
    """The decoder by each rule, which is shown what the product reads of these frames, again and again."""
    front = Pipeline().front
    signs = [front.process(image, index / DEFAULT_FPS) for index, image in enumerate(frames)]
    return [Contender(f"decoder, rule {rule}", _stepper(rule, signs)) for rule in RULES]


def _stepper(rule: Rule, signs: Sequence[Signs]) -> Callable[[Image, float], object]:
    decoder = Decoder(load_grammar(), rule=rule)

    def step(image: Image, time_s: float) -> None:
        del image
        decoder.step(signs[round(time_s * DEFAULT_FPS) % len(signs)], time_s)

    return step


def interleave(
    contenders: Sequence[Contender], frames: Sequence[Image], rounds: int
) -> dict[str, list[float]]:
    """Milliseconds of processor time by contender and kind of frame: all take BLOCK frames, then all take the next.

    The first WARM_UP frames do not count, and are shown besides.
    """
    times: dict[str, list[float]] = {}
    shown = [frames[index % len(frames)] for index in range(WARM_UP)] + [*frames] * rounds
    for first in range(0, len(shown), BLOCK):
        for contender in contenders:
            for index in range(first, min(first + BLOCK, len(shown))):
                start = process_time()
                kind = contender.call(shown[index], index / DEFAULT_FPS)
                spent_ms = (process_time() - start) * 1e3
                if index >= WARM_UP:
                    own = f"{contender.name}, {kind}" if isinstance(kind, str) else None
                    for name in filter(None, (contender.name, own)):
                        times.setdefault(name, []).append(spent_ms)
    return dict(sorted(times.items(), key=lambda item: _place(item[0], contenders)))


def _place(name: str, contenders: Sequence[Contender]) -> int:
    """Of a row: that of its contender."""
    return max(index for index, one in enumerate(contenders) if name.startswith(one.name))
