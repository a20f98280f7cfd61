"""The suite's second part: its sentences signed by real hands before real underwater pictures.

As the paper completed its recordings by combining gestures, pictures of one person's hand are held, cross-faded and
moved at the wrists of the synthetic diver, through water that tints them as the picture behind is tinted. The hands
are those of `hands/val`, the pictures those of `negatives` without a person and of sets that no selector is trained
on. Nothing of it is ever part of the package: clips stay in the user's cache.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import cv2
import numpy as np

import lightgesture.synth
from lightgesture.benchmarks.suite import cast as suite_cast
from lightgesture.benchmarks.suite.cache import Take, source_digest
from lightgesture.benchmarks.suite.cast import (
    Row,
    cast,
    group_people,
    load_backdrop,
    load_hands,
)
from lightgesture.benchmarks.suite.scenarios import REAL, Scenario, scenarios, scene_spec
from lightgesture.fsm import load_grammar
from lightgesture.records import FrameRecord, Hand
from lightgesture.synth.body import Camera
from lightgesture.synth.camera import CameraLook, Sensor
from lightgesture.synth.diver import SIDES
from lightgesture.synth.motion import Drift, Performance, Style
from lightgesture.synth.raster import Float32
from lightgesture.synth.scene import MIN_VISIBLE, SceneFrame
from lightgesture.synth.script import (
    Hold,
    Moment,
    Timing,
    make_timeline,
    sentence_words,
    tokens_at,
    word_pairs,
)
from lightgesture.synth.spec import SceneSpec
from lightgesture.synth.variety import stream
from lightgesture.training.datasets import read_table
from lightgesture.training.pictures import cutouts, diver_composites, real_hands, surroundings
from lightgesture.training.pictures.cutouts import Cutout
from lightgesture.training.pictures.diver_composites import body_look
from lightgesture.training.pictures.real_hands import PastedHand, Shown, draw_diver
from lightgesture.training.pictures.surroundings import light_under_water, water_of_picture

SCENERY: Final = ("gatedet", "subbots", "waternet")
"""Sets of `negatives` that are seen behind."""

CHANGE_FRAMES: Final = 9
"""How long each picture of a hand is seen."""

FADE_FRAMES: Final = 4
"""Of that, how long the next one comes up."""

SWAY_PX: Final = 8.0
"""Standard deviation of the movement of the picture behind, pixels."""

BARE_ARMS: Final = 0.4
"""Share of the divers without sleeves."""


@dataclass(frozen=True, slots=True, eq=False)
class RealTake:
    """A scenario with the rows of `hands/val` for each token, and the picture behind."""

    scenario: Scenario
    fps: float
    size: tuple[int, int]
    recipe: str
    data: Path
    hands: dict[str, tuple[Row, ...]]
    backdrop: Path

    def frames(self) -> Iterator[SceneFrame]:
        """Pictures with their truth."""
        yield from _RealScene(self).frames()


def real_takes(data: Path) -> list[Take]:
    """The clips of real hands; none where the folder lacks hands or pictures to put behind them."""
    if not ((data / "hands" / "val.csv").is_file() and (data / "negatives" / "negatives.csv").is_file()):
        return []
    people = group_people(read_table(data, "hands/val.csv"))
    pictures = [
        row
        for row in read_table(data, "negatives/negatives.csv")
        if row["set"] in SCENERY and row["person"] == "0"
    ]
    if not pictures:
        return []
    digest = _digest(data)
    takes: list[Take] = []
    for scenario in scenarios(REAL):
        rng = stream(scenario.seed, "suite")
        picture = pictures[int(rng.integers(len(pictures)))]
        hands = cast(people, _tokens(scenario), rng)
        spec = scene_spec(scenario)
        named = replace(scenario, difficulty=f"before {picture['set']}")
        paths = [row["path"] for token in sorted(hands) for row in hands[token]]
        recipe = f"{digest} {spec.model_dump_json()} {picture['file']} {paths}"
        takes.append(RealTake(named, spec.fps, spec.size, recipe, data, hands, data / picture["file"]))
    return takes


def _digest(data: Path) -> str:
    package = Path(lightgesture.synth.__file__).parent
    parts = [Path(str(part.__file__)) for part in (cutouts, diver_composites, real_hands, surroundings)]
    tables = [data / "hands" / "val.csv", data / "negatives" / "negatives.csv"]
    return source_digest([*package.rglob("*.py"), *parts, Path(__file__), Path(suite_cast.__file__), *tables])


def _tokens(scenario: Scenario) -> list[str]:
    """The tokens that a scenario shows, in order of first appearance."""
    grammar = load_grammar()
    pairs = [word_pairs(grammar, sentence_words(sentence)) for sentence in scenario.sentences]
    return list(dict.fromkeys(token for part in pairs for pair, _ in part for token in pair))


class _RealScene:
    """Renders one take."""

    def __init__(self, take: RealTake) -> None:
        self._take = take
        spec = scene_spec(take.scenario)
        rng = stream(take.scenario.seed, "suite")
        timing = Timing(spec.hold, spec.passage, spec.pause)
        self._timeline = make_timeline(load_grammar(), spec.sentences, timing, rng)
        self.frame_count = self._timeline[-1].end
        self._performance = Performance(self._timeline, _style(spec), rng, self.frame_count / take.fps)
        self._camera = Camera(spec.camera.focal * spec.size[0], (0.5 * spec.size[0], 0.5 * spec.size[1]))
        self._hands = load_hands(take.data, take.hands)
        self._behind = load_backdrop(take.backdrop, take.size)
        self._sway = Drift(rng, 2, 0.15)
        typical = self._backdrop(0.0)
        self._water = water_of_picture(typical, spec.diver.distance_mm / 1000.0, rng)
        self._light = light_under_water(self._water, rng)
        first = next(iter(self._hands["left"].values()))[0]
        self._look = body_look(first, True, BARE_ARMS, rng)
        camera = CameraLook(target=float(typical.mean()), balance=0.0, shot=0.0006 * spec.camera.noise,
                            read=0.004 * spec.camera.noise, blur_px=spec.camera.blur_px)  # fmt: skip
        self._sensor = Sensor(camera, spec.size, rng)
        self._sensor.meter(typical)

    def frames(self) -> Iterator[SceneFrame]:
        """All frames in order."""
        for index in range(self.frame_count):
            time_s = index / self._take.fps
            state, moment = self._performance.state(index, time_s)
            picture = self._backdrop(time_s)
            shown = {side: self._shown(side, moment, index) for side in SIDES}
            pasted, _ = draw_diver(picture, state, self._look, shown, self._camera, self._light, self._water)
            tokens = tokens_at(self._timeline, moment)
            hands = tuple(
                _truth(hand, tokens[SIDES.index(hand.side)]) for hand in pasted if hand.visible > 0.0
            )
            record = FrameRecord(source=None, frame=index, time_s=time_s, hands=hands)
            yield SceneFrame(self._sensor.expose(picture, index, time_s), record)

    def _backdrop(self, time_s: float) -> Float32:
        """The window of the picture behind that is seen at a time, linear."""
        width, height = self._take.size
        room = np.array([self._behind.shape[1] - width, self._behind.shape[0] - height]) / 2.0
        corner = np.clip(room + SWAY_PX * self._sway.at(time_s), 0.0, 2.0 * room)
        move = np.array([[1.0, 0.0, -corner[0]], [0.0, 1.0, -corner[1]]], np.float32)
        return np.asarray(cv2.warpAffine(self._behind, move, (width, height)), np.float32)

    def _shown(self, side: str, moment: Moment, index: int) -> Shown:
        """The pictures of a hand in a frame: they take turns in a hold, and fade from sign to sign."""
        pictures: list[Cutout] = []
        weights: list[float] = []
        for number, share in ((moment.before, 1.0 - moment.part), (moment.after, moment.part)):
            if share > 0.0:
                token = _token_near(self._timeline, number, side)
                for cutout, weight in _taking_turns(self._hands[side][token], index):
                    pictures.append(cutout)
                    weights.append(weight * share)
        return Shown(pictures, weights)


def _taking_turns(pictures: Sequence[Cutout], index: int) -> list[tuple[Cutout, float]]:
    """What is seen in frame `index` of pictures that take turns, with weights that sum to one."""
    turn, frame = divmod(index, CHANGE_FRAMES)
    fading = max(frame - CHANGE_FRAMES + FADE_FRAMES + 1, 0) / (FADE_FRAMES + 1)
    now, later = pictures[turn % len(pictures)], pictures[(turn + 1) % len(pictures)]
    return [(now, 1.0)] if fading == 0.0 or now is later else [(now, 1.0 - fading), (later, fading)]


def _token_near(timeline: Sequence[Hold], number: int, side: str) -> str:
    """What a hand shows in hold `number`; a lowered hand keeps the shape of the next or else the last sign."""
    for hold in [*timeline[number:], *reversed(timeline[:number])]:
        if hold.pair is not None:
            return hold.pair[SIDES.index(side)]
    raise ValueError("a script without a sign")


def _style(spec: SceneSpec) -> Style:
    return Style(
        wrist=spec.diver.wrist_mm,
        distance_mm=spec.diver.distance_mm,
        height_mm=spec.diver.height_mm,
        tremor_mm=spec.motion.tremor_mm,
        approach_mm=spec.motion.approach_mm,
    )


def _truth(pasted: PastedHand, token: str | None) -> Hand:
    reason = None if token is not None else "unknown_shape"
    if pasted.visible < MIN_VISIBLE:
        token, reason = None, "partial"
    return Hand(side=pasted.side, token=token, confidence=1.0, box=pasted.box, track=None, reason=reason)
