"""The two halves of a pipeline from their options: what reads signs, and the decoder of what they say."""

import os
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import TYPE_CHECKING, Final

from lightgesture.features.colour import ColourStage
from lightgesture.features.find.selector import SelectorName, load_selector
from lightgesture.features.profile import load_profile
from lightgesture.front_end import FrontEnd
from lightgesture.fsm import Decoder, Grammar, load_grammar
from lightgesture.fsm.language.settings import SENTENCE, Rule
from lightgesture.hands import HandReader, ReadingSettings, ReadingStage
from lightgesture.hands.memory import ReadingMemory, memory_for_hold, memory_for_sentences
from lightgesture.models import load_classifier
from lightgesture.models.loading import DEFAULT

if TYPE_CHECKING:
    from lightgesture.cards import FrontEndName
    from lightgesture.features.tags.detector import DetectorName

HANDS: Final = "hands"
"""The front end that reads bare hands, the default."""


@dataclass(frozen=True, slots=True)
class HandOptions:
    """Of the front end that reads hands; see `lightgesture.pipeline.Pipeline`."""

    model: str | os.PathLike[str] = DEFAULT
    selector: SelectorName = "learned"
    profile: str | os.PathLike[str] | None = None
    threshold: float | None = None
    rotate: int = 0


@dataclass(frozen=True, slots=True)
class CardOptions:
    """Of the front ends that read cards; see `lightgesture.pipeline.Pipeline`."""

    tag_detector: "DetectorName" = "aruco"
    shapes: str | os.PathLike[str] | None = None


@dataclass(frozen=True, slots=True)
class FrontOptions:
    """Of any front end: which one, and how its pictures lie."""

    front_end: "FrontEndName" = HANDS
    mirrored: bool = False


@dataclass(frozen=True, slots=True)
class DecoderOptions:
    """Of the decoder; see `lightgesture.pipeline.Pipeline`."""

    rule: Rule | None = None
    hold: int | None = None
    hold_seconds: float | None = None
    caution: float | None = None
    grammar: str | os.PathLike[str] | None = None


def make_front(
    front: FrontEnd | None, options: FrontOptions, hands: HandOptions, cards: CardOptions, decoder: Decoder
) -> FrontEnd:
    """`front` itself, or the front end of the options, for the rule of a decoder.

    Raises ValueError for options that the front end does not have, and what `Pipeline` says.
    """
    if front is not None:
        _refuse("another front end", options, hands, cards)
        return front
    if options.front_end == HANDS:
        _refuse(f"the front end {HANDS}", cards)
        return _hand_reader(hands, options.mirrored, decoder)
    _refuse(f"the front end {options.front_end}", hands)
    from lightgesture.cards import make_card_reader

    return make_card_reader(
        decoder.grammar,
        options.front_end,
        detector=cards.tag_detector,
        shapes=cards.shapes,
        mirrored=options.mirrored,
    )


def make_decoder(
    decoder: Decoder | None, options: DecoderOptions, front_end: "FrontEndName", source: str | None
) -> Decoder:
    """`decoder` itself, for the source if one is named, or that of the options. Raises ValueError, GrammarError."""
    if decoder is not None:
        _refuse("another decoder", options)
        return decoder if source is None else decoder.for_stream(source)
    return Decoder(
        _language(options.grammar, front_end),
        rule=options.rule,
        hold=options.hold,
        hold_seconds=options.hold_seconds,
        caution=options.caution,
        source=source,
    )


def _hand_reader(options: HandOptions, mirrored: bool, decoder: Decoder) -> HandReader:
    return HandReader(
        ReadingStage(load_classifier(options.model), _reading(options.threshold, decoder.rule)),
        find=load_selector(options.selector),
        colour=ColourStage(profile=None if options.profile is None else load_profile(options.profile)),
        memory=partial(_memory, decoder.rule, decoder.hold_frames, decoder.hold_seconds),
        mirrored=mirrored,
        rotate=options.rotate,
    )


def _language(file: str | os.PathLike[str] | None, front_end: "FrontEndName") -> Grammar:
    """The grammar of a file, None for the bundled one, as the front end needs it."""
    language = load_grammar(file)
    if front_end == HANDS:
        return language
    # Who reads hands need not wait for what reads cards.
    from lightgesture.cards import language_of_cards

    return language_of_cards(language, front_end)


def _memory(rule: Rule, hold_frames: int | None, hold_seconds: float | None) -> ReadingMemory:
    """What remembers the readings of a hand, for a rule and its hold."""
    if rule == SENTENCE and hold_seconds is not None:
        return memory_for_sentences(hold_seconds)
    return memory_for_hold(hold_frames, hold_seconds)


def _reading(threshold: float | None, rule: Rule) -> ReadingSettings:
    """How hands are read for a rule: "sentence" wants to know where the extents of a hand differ."""
    settings = ReadingSettings(extents="mean" if rule == SENTENCE else "clearest")
    return settings if threshold is None else replace(settings, token_probability=threshold)


def _refuse(half: str, *options: FrontOptions | HandOptions | CardOptions | DecoderOptions) -> None:
    """ValueError for options that were given and that this half of the pipeline does not have."""
    names = [
        one.name for given in options for one in fields(given) if getattr(given, one.name) != one.default
    ]
    if names:
        raise ValueError(f"{', '.join(names)}: of no effect beside {half}; leave out either")
