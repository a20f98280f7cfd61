"""Motions of two tags: where they begin and end, and which shape they are."""

import json

import numpy as np
import pytest

from lightgesture.features.motion.matching import MatchSettings, ShapeBase, resampled
from lightgesture.features.motion.segments import Segmenter
from lightgesture.features.motion.shapes import MOST_SHAPES, SHAPES, ShapesError, load_shapes, save_shape
from lightgesture.features.tags.tag import Tag

FPS = 20
SIDE = 30.0
BASE = ShapeBase(SHAPES)


def turned(points, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return points @ np.array([[c, -s], [s, c]]).T


def tag(number, place, angle=0.0, side=SIDE):
    """An upright tag whose centre is there, turned in the picture."""
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * side / 2
    return Tag(number, (turned(corners, angle) + place).astype(np.float32), 100.0, 1.0)


def drawn(curve, seconds=1.2, size=70.0):
    """Offsets in the picture, frame by frame, of a hand that draws a curve given with the diver's eyes."""
    if curve is None:
        return np.zeros((round(seconds * FPS), 2))
    points = resampled(np.asarray(curve, float), round(seconds * FPS))
    points = points / np.ptp(points, axis=0).max() * size
    return (points - points[0]) * (-1, -1)


REST = np.zeros((FPS, 2))
LEFT, RIGHT = np.array([420.0, 240.0]), np.array([220.0, 240.0])


def play(*parts, angle=0.0, middle=(320, 240), apart=100, scale=1.0, speed=1.0):
    """What the segmenter tells of each frame. parts: pairs of offsets (left, right), (n, 2) each."""
    segments, moments = Segmenter(), []
    offsets = [np.vstack([part[hand] for part in parts]) for hand in (0, 1)]
    for index, (left, right) in enumerate(zip(*offsets, strict=True)):
        places = [
            turned((offset + np.array([sign * apart, 0])) * scale, angle) + middle
            for sign, offset in ((1, left), (-1, right))
        ]
        tags = [tag(50 + hand, place, angle, SIDE * scale) for hand, place in enumerate(places)]
        moments.append(segments.process(*tags, index / FPS / speed))
    return moments


def motions(moments):
    found = []
    for moment in moments:
        if moment.motion is not None and (not found or moment.motion is not found[-1]):
            found.append(moment.motion)
    return found


def reasons(moments):
    return [moment.reason for moment in moments if moment.reason is not None]


def names(motion):
    return tuple(None if curve is None else BASE.match(curve).name for curve in (motion.left, motion.right))


class TestShapes:
    @pytest.mark.parametrize("name", SHAPES)
    def test_every_shape_ends_where_it_begins_and_is_its_own_nearest(self, name):
        for curve in SHAPES[name]:
            assert np.allclose(curve[0], curve[-1])
            match = BASE.match(curve)
            assert match.name == name
            assert match.distance < 0.01

    @pytest.mark.parametrize("name", SHAPES)
    def test_place_size_speed_and_a_small_turn_do_not_matter(self, name):
        rng = np.random.default_rng(3)
        for curve in SHAPES[name]:
            points = resampled(curve, 60)[np.sort(rng.choice(60, 40, replace=False))]
            other = turned(points, 12) * 140 + (500, -200)
            match = BASE.match(other)
            assert match.name == name
            # A circle and a square are near to each other: no grammar should need both.
            assert match.is_sure(BASE.settings) or name in ("square", "clockwise", "anticlockwise")

    def test_what_is_turned_too_far_is_another(self):
        (up,) = SHAPES["up"]
        assert BASE.match(turned(up, 90)).name in ("left", "right")
        slanted = BASE.match(turned(up, 45))
        assert not slanted.is_sure(BASE.settings)

    def test_the_way_round_matters(self):
        circle = SHAPES["clockwise"][2]
        assert BASE.match(circle).name == "clockwise"
        assert BASE.match(circle[::-1]).name == "anticlockwise"

    def test_a_scribble_is_none(self):
        rng = np.random.default_rng(0)
        walks = [np.cumsum(rng.normal(size=(50, 2)), axis=0) for _ in range(40)]
        sure = [
            BASE.match(walk - np.linspace(0, 1, 50)[:, None] * walk[-1]).is_sure(BASE.settings)
            for walk in walks
        ]
        assert sum(sure) < 8

    def test_a_shape_between_two_is_neither(self):
        base = ShapeBase({name: SHAPES[name] for name in ("up", "right")})
        assert not base.match(np.array([(0, 0), (1, 1), (0, 0)], float)).is_sure(MatchSettings())


class TestOwnShapes:
    HOOK = np.array([(0, 0), (0, 1), (0.5, 1), (0, 1), (0, 0)], float)

    def write(self, path, name="hook"):
        temporary = path.with_suffix(".part")
        count = save_shape(path, name, self.HOOK, temporary)
        temporary.replace(path)
        return count

    def test_what_is_saved_is_loaded_and_added_to(self, tmp_path):
        path = tmp_path / "shapes.json"
        assert (self.write(path), self.write(path), self.write(path, "up")) == (1, 2, 3)
        shapes = load_shapes(path)
        assert [len(shapes[name]) for name in ("hook", "up", "down")] == [2, 1, 1]
        assert np.allclose(shapes["hook"][0], self.HOOK)
        assert np.allclose(shapes["up"][0], self.HOOK)  # one's own takes the place of the package's

    def test_a_full_file(self, tmp_path):
        path = tmp_path / "shapes.json"
        path.write_text(json.dumps({"shapes": [{"name": "a", "points": self.HOOK.tolist()}] * MOST_SHAPES}))
        with pytest.raises(ShapesError, match="has 64 shapes, which is the most"):
            self.write(path)

    @pytest.mark.parametrize(
        ("content", "message"),
        [
            ("nothing", "is no file of shapes; make one with"),
            ("[1]", "is no file of shapes"),
            ('{"shapes": 3}', "'shapes' is no list"),
            ('{"shapes": [{"name": "a"}]}', r"shapes\[0\]: has not exactly 'name' and 'points'"),
            ('{"shapes": [{"name": "A b", "points": []}]}', r"shapes\[0\]: its name is not of small letters"),
            ('{"shapes": [{"name": "a", "points": [[1, 2], [3]]}]}', "its points are no pairs of numbers"),
            ('{"shapes": [{"name": "a", "points": [[1, 2], [3, 4]]}]}', "its points are not 3 to 1000 pairs"),
            ('{"shapes": [{"name": "a", "points": [[1, 2], [1, 2], [1, 2]]}]}', "its points do not move"),
            ('{"shapes": [{"name": "a", "points": [[1, 2], [1, NaN], [1, 2]]}]}', "no finite numbers"),
        ],
    )
    def test_a_file_that_is_none(self, tmp_path, content, message):
        path = tmp_path / "odd.json"
        path.write_text(content)
        with pytest.raises(ShapesError, match=message):
            load_shapes(path)

    def test_a_file_that_is_not_there(self, tmp_path):
        with pytest.raises(ShapesError, match=r"none.json: cannot be read"):
            load_shapes(tmp_path / "none.json")


class TestSegments:
    @pytest.mark.parametrize(
        ("left", "right"),
        [("up", "down"), (None, "clockwise"), ("triangle", None), ("wave", "wave"), ("left", "right")],
    )
    def test_a_motion_from_rest_to_rest(self, left, right):
        curves = [None if name is None else SHAPES[name][0] for name in (left, right)]
        moments = play((REST, REST), [drawn(curve) for curve in curves], (REST, REST))
        (motion,) = motions(moments)
        assert names(motion) == (left, right)
        assert reasons(moments) == []
        assert moments[-1].phase == "resting"

    @pytest.mark.parametrize(
        "options", [{"angle": 25.0}, {"scale": 0.4}, {"middle": (90, 400)}, {"speed": 0.7}]
    )
    def test_camera_distance_and_speed_do_not_matter(self, options):
        moments = play(
            (REST, REST), (drawn(SHAPES["up"][0]), drawn(SHAPES["zigzag"][1])), (REST, REST), **options
        )
        (motion,) = motions(moments)
        assert names(motion) == ("up", "zigzag")

    def test_several_motions(self):
        parts = [(REST, REST)]
        for name in ("up", "right", "clockwise"):
            parts += [(drawn(SHAPES[name][0]), drawn(None)), (REST, REST)]
        assert [names(motion) for motion in motions(play(*parts))] == [
            ("up", None),
            ("right", None),
            ("clockwise", None),
        ]

    def test_no_motion_without_rest_before(self):
        moments = play((drawn(SHAPES["up"][0]), drawn(None)), (REST, REST))
        assert motions(moments) == []

    def test_drift_is_no_motion(self):
        time_s = np.arange(8 * FPS)[:, None] / FPS
        drift = 18 * np.sin(2 * np.pi * 0.25 * time_s + np.array([[0.0, 1.0]]))
        moments = play((drift, drift))
        assert motions(moments) == []
        assert reasons(moments) == []

    def test_what_ends_elsewhere_is_none(self):
        away = drawn(np.array([(0, 0), (0, 1)], float))
        moments = play((REST, REST), (away, drawn(None)), (REST + away[-1], REST))
        assert motions(moments) == []
        assert reasons(moments) == ["elsewhere"]

    def test_what_both_hands_carry_elsewhere_is_none(self):
        away = drawn(np.array([(0, 0), (0, 1)], float))
        moments = play((REST, REST), (away, away), (REST + away[-1], REST + away[-1]))
        assert motions(moments) == []
        assert reasons(moments) == ["elsewhere"]

    @pytest.mark.parametrize("pair", [("up", "down"), ("clockwise", "anticlockwise"), ("wave", None)])
    def test_a_diver_who_drifts_while_moving(self, pair):
        curves = [drawn(None if name is None else SHAPES[name][0]) for name in pair]
        away = np.linspace(0.0, SIDE, len(curves[0]))[:, None] * np.array([[0.8, 0.6]])
        moments = play((REST, REST), [curve + away for curve in curves], (REST + away[-1], REST + away[-1]))
        (motion,) = motions(moments)
        assert names(motion) == pair
        assert reasons(moments) == []
        for curve in (motion.left, motion.right):
            assert curve is None or np.abs(curve[-1] - curve[0]).max() < 0.2

    def test_a_motion_that_never_ends(self):
        circle = drawn(SHAPES["clockwise"][0])
        moments = play((REST, REST), *[(circle, circle)] * 8)
        assert motions(moments) == []
        assert reasons(moments) == ["endless"]

    def test_a_tag_that_leaves_in_mid_motion(self):
        segments = Segmenter()
        moments = []
        for index, offset in enumerate(np.vstack([REST, drawn(SHAPES["up"][0])[:14]])):
            moments.append(segments.process(tag(50, LEFT + offset), tag(51, RIGHT), index / FPS))
        moments += [segments.process(None, tag(51, RIGHT), 2.2 + index / FPS) for index in range(30)]
        assert motions(moments) == []
        assert reasons(moments) == ["lost"]
        assert moments[-1].phase == "absent"

    def test_a_tag_that_is_missed_for_a_moment(self):
        segments = Segmenter()
        moments = []
        offsets = np.vstack([REST, drawn(SHAPES["up"][0]), REST])
        for index, offset in enumerate(offsets):
            left = None if index % 5 in (3, 4) else tag(50, LEFT + offset)
            moments.append(segments.process(left, tag(51, RIGHT), index / FPS))
        (motion,) = motions(moments)
        assert names(motion) == ("up", None)

    def test_a_tag_that_is_missed_does_not_rest(self):
        segments, moments = Segmenter(), []
        circle = drawn(SHAPES["clockwise"][0], 2.0, 90.0)
        end = FPS + len(circle)
        for index, offset in enumerate(np.vstack([REST, circle, REST])):
            right = tag(51, RIGHT + offset) if index < FPS + 4 or index >= end or index % 5 == 0 else None
            moments.append(segments.process(tag(50, LEFT), right, index / FPS))
        assert {moment.phase for moment in moments[FPS + 4 : end]} == {"moving"}
        (motion,) = motions(moments)
        assert names(motion) == (None, "clockwise")

    @pytest.mark.parametrize(
        ("options", "reason"), [({"angle": 180.0}, "turned"), ({"apart": -100}, "swapped")]
    )
    def test_cards_that_are_held_wrongly(self, options, reason):
        moments = play((REST, REST), (drawn(SHAPES["up"][0]), drawn(None)), (REST, REST), **options)
        assert motions(moments) == []
        assert reasons(moments) == [reason]

    def test_a_clock_that_is_set_back_begins_anew(self):
        segments = Segmenter()
        places = [tag(50, LEFT), tag(51, RIGHT)]
        for index in range(FPS):
            moment = segments.process(*places, 100 + index / FPS)
        assert moment.phase == "resting"
        assert segments.process(*places, 1.0).phase == "unsettled"
