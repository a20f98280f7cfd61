"""The halves of a pipeline: a front end or a decoder that is given, options of the other, what they tell each other."""

import numpy as np
import pytest

from lightgesture import Pipeline
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import Decoder, Sign, Signs, load_grammar
from lightgesture.models import ModelError


class Recording(FrontEnd):
    """What a recording of signs says, a frame at a time: a front end that looks at no picture."""

    def __init__(self, shown):
        super().__init__()
        self.shown_signs = iter(shown)

    def process(self, image, time_s):
        return next(self.shown_signs)


def decode(shown, **options):
    """All records of a recording of signs, thirty frames a second."""
    pipeline = Pipeline(Recording(shown), frames=False, **options)
    picture = np.zeros((4, 4, 3), np.uint8)
    return [
        (frame, record) for frame in range(len(shown)) for record in pipeline.process(picture, frame / 10)
    ]


def test_hands_in_view_that_are_not_read_drop_the_sentence():
    """The decoder is told of them, so that a sign that nobody could read is not passed over."""
    signed = [Signs.of_tokens("0", "0")] * 4 + [Signs.of_tokens("5", "5")] * 4 + [Signs()] * 20
    records = decode([*signed, *[Signs(right=Sign(None, reason="partial"))] * 8], hold=4)
    ((frame, rejected),) = [item for item in records if item[1].type == "rejected"]
    assert (rejected.reason, rejected.text) == ("unread_sign", "STOP HOVER")
    assert frame >= len(signed)


def test_hold_may_be_given_in_seconds():
    records = decode([Signs.of_tokens("0", "0")] * 5, rule="seconds", hold_seconds=0.2)
    assert [frame for frame, record in records if record.type == "word"] == [2]


@pytest.mark.parametrize(("named", "source"), [({}, "mine"), ({"source": "dive"}, "dive")])
def test_a_decoder_may_be_given(named, source):
    pipeline = Pipeline(
        Recording([Signs.of_tokens("0", "0")] * 3), Decoder(load_grammar(), hold=2, source="mine"), **named
    )
    picture = np.zeros((4, 4, 3), np.uint8)
    records = [record for index in range(3) for record in pipeline.process(picture, index / 30)]
    assert [record.frame for record in records if record.type == "word"] == [1]
    assert {record.source for record in [*records, *pipeline.finish()]} == {source}


def test_signs_that_the_model_cannot_read_are_refused_and_others_are_told_of():
    front = Recording([])
    assert Pipeline(front).check_language() is None
    front.tokens = ("0", "5", "none")
    with pytest.raises(ModelError, match="tokens of the grammar that the model cannot read: 1, 2, "):
        Pipeline(front).check_language()
    front.tokens = (*load_grammar().tokens, "shaka")
    assert "does not know: shaka" in Pipeline(front).check_language()


@pytest.mark.parametrize("option", [{"model": "svm"}, {"mirrored": True}, {"selector": "classical"}])
def test_options_of_hands_beside_another_front_end_are_refused(option):
    with pytest.raises(ValueError, match=next(iter(option))):
        Pipeline(Recording([]), **option)
