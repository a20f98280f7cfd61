"""The decoder with a reader of one's own: `python examples/own_reader.py`.

The decoder knows no picture. Whatever reads hands, another network, a glove with sensors, a mouse, gives it a pair of
signs a frame. Here a script shows each pair for a moment, the diver's left hand first.
"""

from collections.abc import Iterator

from lightgesture.fsm import Decoder, Instruction, Sign, Signs, load_grammar

FRAMES_A_SECOND = 30
HELD_S, LOWERED_S = 0.7, 0.3

SHOWN = (("ok", "0"), ("5", "5"), ("ok", "5"), ("pic", "ok"), ("ok", "0"), ("ok", "ok"))
"""STOP, HOVER, 5, AND, 0, GO."""


def frames() -> Iterator[Signs]:
    """What the reader says of one frame after the other."""
    for left, right in SHOWN:
        both = Signs(left=Sign(left, confidence=0.97), right=Sign(right, confidence=0.95))
        yield from [both] * round(HELD_S * FRAMES_A_SECOND)
        yield from [Signs()] * round(LOWERED_S * FRAMES_A_SECOND)


def decode() -> list[str]:
    """The instructions that the frames make."""
    decoder = Decoder(load_grammar(), hold_seconds=0.5)
    said = []
    for number, signs in enumerate(frames()):
        events = decoder.step(signs, time_s=number / FRAMES_A_SECOND)
        said += [event.text for event in events if isinstance(event, Instruction)]
    return said


if __name__ == "__main__":
    for text in decode():
        print(text)
