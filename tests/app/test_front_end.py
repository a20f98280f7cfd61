"""The seam: cards speak to the decoder through forty lines, and nothing else of the product changes."""

import cv2
import numpy as np
import pytest

from lightgesture import Pipeline
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import UNSEEN, Sign, Signs

WORDS = {0: "STOP", 2: "GO", 3: "AND", 4: "HOVER", 20: "0", 25: "5"}
FAMILY = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)


class Cards(FrontEnd):
    """One card is one word, shown by either hand."""

    def __init__(self):
        super().__init__()
        self._detector = cv2.aruco.ArucoDetector(FAMILY)

    def process(self, image, time_s):
        corners, ids, _ = self._detector.detectMarkers(image)
        self.clock.lap("tags")
        middle = image.shape[1] / 2
        signs = {"left": UNSEEN, "right": UNSEEN}
        for number, outline in zip([] if ids is None else ids.ravel(), corners, strict=True):
            side = "right" if outline.reshape(4, 2)[:, 0].mean() < middle else "left"
            signs[side] = Sign(WORDS.get(int(number)), 1.0, is_word=True)
        return Signs(**signs)


def picture(*words, size=(240, 320)):
    """Cards beside each other on grey, the first at image left."""
    image = np.full((*size, 3), 128, np.uint8)
    numbers = {word: number for number, word in WORDS.items()}
    for place, word in enumerate(words):
        card = cv2.copyMakeBorder(
            cv2.aruco.generateImageMarker(FAMILY, numbers[word], 80),
            15,
            15,
            15,
            15,
            cv2.BORDER_CONSTANT,
            value=255,
        )
        left = 30 + 150 * place
        image[60 : 60 + card.shape[0], left : left + card.shape[1]] = card[..., None]
    return image


def play(shown):
    """Records of pictures that are each shown for ten frames at thirty a second."""
    pipeline = Pipeline(Cards(), hold=5, frames=False)
    frames = [image for image in shown for _ in range(10)]
    records = [record for index, image in enumerate(frames) for record in pipeline.process(image, index / 30)]
    return [*records, *pipeline.finish()]


@pytest.mark.parametrize("place", [0, 1])
def test_cards_sign_a_sentence_with_either_hand(place):
    pause = picture()
    cards = [image for word in ("STOP", "HOVER", "5", "AND", "0", "GO") for image in (picture(word), pause)]
    if place == 1:
        cards = [np.ascontiguousarray(np.roll(image, 150, axis=1)) for image in cards]
    records = play(cards)
    (instruction,) = [record for record in records if record.type == "instruction"]
    assert (instruction.text, instruction.duration_s) == ("STOP HOVER 50 GO", 50)
    assert list(records[-1].stages_ms) == ["tags", "decode"]
    words = [record for record in records if record.type == "word"]
    assert words[0].to_dict()["pair"] == ["STOP"]


def test_two_cards_at_once_say_nothing():
    assert [record.type for record in play([picture("STOP", "HOVER"), picture()])] == ["summary"]


def test_a_card_that_the_grammar_does_not_know_is_told():
    class Unknown(Cards):
        def process(self, image, time_s):
            return Signs(left=Sign("DANCE", is_word=True))

    pipeline = Pipeline(Unknown(), hold=2, frames=False)
    records = [record for index in range(4) for record in pipeline.process(picture(), index / 30)]
    (notice,) = [record for record in records if record.type == "notice"]
    assert (notice.reason, notice.detail) == ("unknown_pair", "DANCE is no word; repeat it")
