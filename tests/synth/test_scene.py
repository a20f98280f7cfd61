from itertools import pairwise

import numpy as np
import pytest

from lightgesture.fsm import Instruction, Word, load_grammar
from lightgesture.synth.body import Camera
from lightgesture.synth.diver import draw_arm_hand
from lightgesture.synth.motion import Performance, Style
from lightgesture.synth.output import with_truth
from lightgesture.synth.poses import TOKENS
from lightgesture.synth.scene import Scene, diver_look
from lightgesture.synth.script import (
    ACTIVITIES,
    Hold,
    Timing,
    make_timeline,
    moment_at,
    sentence_words,
    tokens_at,
    word_pairs,
)
from lightgesture.synth.shading import Light
from lightgesture.synth.spec import DiverSpec, MotionSpec, SceneSpec, WaterSpec, load_scene_spec
from lightgesture.synth.variety import draw_sentence, draw_spec, stream

GRAMMAR = load_grammar()


def middle_of(scene, word):
    hold = next(hold for hold in scene.timeline if hold.word == word)
    return (hold.start + hold.end) // 2


def test_the_same_spec_gives_the_same_pixels_in_any_order(scene):
    again = Scene(scene.spec)
    late, early = scene.frame(40), scene.frame(12)
    assert np.array_equal(again.frame(12).image, early.image)
    assert np.array_equal(again.frame(40).image, late.image)
    assert again.frame(12).record == early.record


def test_another_seed_gives_other_pixels_and_the_same_script(scene):
    other = Scene(scene.spec.model_copy(update={"seed": 12}))
    assert [hold.word for hold in other.timeline] == [hold.word for hold in scene.timeline]
    assert not np.array_equal(other.frame(12).image, scene.frame(12).image)


def test_water_changes_the_light_and_not_the_diver(scene):
    index = middle_of(scene, "LEFT")
    murky = Scene(scene.spec.model_copy(update={"water": WaterSpec(kind="7C", turbidity=1.0)}))
    assert murky.frame(index).record == scene.frame(index).record
    assert murky.frame(index).image.std() < scene.frame(index).image.std()


def test_records_name_the_signs_and_sides(scene):
    frame = scene.frame(middle_of(scene, "LEFT"))
    assert frame.image.shape == (144, 192, 3)
    hands = {hand.side: hand for hand in frame.record.hands}
    assert (hands["left"].token, hands["right"].token) == ("0", "left")
    assert hands["right"].box[0] < 96 < hands["left"].box[0]
    for hand in hands.values():
        x, y, width, height = hand.box
        assert x >= 0
        assert y >= 0
        assert x + width <= 192
        assert y + height <= 144


@pytest.mark.parametrize(("token", "inward"), [("left", True), ("right", False)])
@pytest.mark.parametrize("side", ["left", "right"])
def test_the_thumbs_of_a_diver_point_inward_for_left_and_outward_for_right(side, token, inward):
    pair = (token, "5") if side == "left" else ("5", token)
    timeline = [Hold(0, 20, pair, None)]
    performance = Performance(timeline, Style(), np.random.default_rng(6), 1.0)
    state, _ = performance.state(5, 0.2)
    look = diver_look(DiverSpec(), np.random.default_rng(0))
    hand, distance_m = draw_arm_hand(state, look, side, Camera(250.0, (160.0, 120.0)), Light())
    assert 0.8 < distance_m < 1.4
    towards = hand.landmarks[4, 0] - hand.landmarks[[5, 9, 13, 17], 0].mean()
    middle = 160.0 - hand.landmarks[0, 0]
    assert (towards * middle > 0.0) == inward


def test_truth_reads_the_sentence(scene):
    small = Scene(scene.spec.model_copy(update={"size": (96, 72)}))
    records = [
        record
        for _, frame_records in with_truth(small.frames(), GRAMMAR, 15, "x.mp4")
        for record in frame_records
    ]
    assert [record.word for record in records if isinstance(record, Word)] == ["STOP", "LEFT", "5", "GO"]
    (instruction,) = [record for record in records if isinstance(record, Instruction)]
    assert (instruction.text, instruction.duration_s) == ("STOP LEFT 5 GO", 5)
    assert sum(record.type == "frame" for record in records) == small.frame_count
    assert {record.source for record in records} == {"x.mp4"}


def test_hands_out_of_view_are_partial_or_absent():
    spec = SceneSpec(size=(160, 120), sentences=(), diver=DiverSpec(distance_mm=900.0))
    hands = Scene(spec).frame(0).record.hands
    assert all(hand.token is None and hand.reason == "partial" for hand in hands)


def test_a_dry_room_and_an_approach():
    spec = SceneSpec(
        size=(160, 120),
        sentences=("STOP UP GO",),
        water=WaterSpec(kind="none"),
        motion=MotionSpec(drift=0.0, approach_mm=400.0),
    )
    scene = Scene(spec)
    first, last = (scene.frame(middle_of(scene, word)).record.hands[0].box for word in ("STOP", "GO"))
    assert last[3] > first[3]


def test_words_of_a_sentence():
    assert sentence_words("STOP HOVER 50 GO") == ["STOP", "HOVER", "5", "AND", "0", "GO"]
    assert sentence_words("CONTD PARAM 3 DECREASE GO") == ["CONTD", "PARAM 3", "DECREASE", "GO"]
    assert sentence_words("STOP EXEC 105 GO")[2:7] == ["1", "AND", "0", "AND", "5"]


def test_pairs_of_words():
    assert word_pairs(GRAMMAR, ["STOP", "0"]) == [(("ok", "0"), "STOP"), (("ok", "0"), "0")]
    with pytest.raises(ValueError, match="no sign for the word 'DANCE'"):
        word_pairs(GRAMMAR, ["STOP", "DANCE"])


def test_the_timeline_holds_every_word_and_releases_equal_pairs():
    timeline = make_timeline(GRAMMAR, ["STOP 0 GO", "CONTD SNAP GO"], Timing(), np.random.default_rng(0))
    assert [hold.word for hold in timeline if hold.word] == ["STOP", "0", "GO", "CONTD", "SNAP", "GO"]
    for before, after in pairwise(timeline):
        assert before.end < after.start
        assert before.pair is None or before.pair != after.pair
    assert timeline[0].pair is None
    assert timeline[-1].pair is None


def test_tokens_are_named_only_where_the_shape_is_there():
    timeline = make_timeline(GRAMMAR, ["STOP HOVER 5 GO"], Timing(passage=(9, 9)), np.random.default_rng(0))
    seen = [tokens_at(timeline, moment_at(timeline, frame)) for frame in range(timeline[-1].end)]
    hover, five = timeline[2], timeline[3]
    assert seen[hover.start : hover.end] == [("5", "5")] * (hover.end - hover.start)
    between = seen[hover.end + 2 : five.start - 2]
    assert between
    assert all(pair == (None, "5") for pair in between)


def test_drawn_specs_differ_by_seed_and_purpose_and_can_be_drawn_again():
    assert draw_spec(3) == draw_spec(3)
    assert draw_spec(3) != draw_spec(4)
    assert draw_spec(3, "train") != draw_spec(3, "suite")
    assert draw_spec(5, place="room").water.kind == "none"
    assert draw_spec(5, place="water").water.kind != "none"


def test_drawn_sentences_are_all_in_the_language():
    rng = stream(0, "demo")
    for _ in range(60):
        pairs = word_pairs(GRAMMAR, sentence_words(draw_sentence(rng)))
        assert all(token in TOKENS for pair, _ in pairs for token in pair)


def test_scene_files(tmp_path):
    path = tmp_path / "dive.toml"
    path.write_text('seed = 5\nsentences = ["STOP UP GO"]\n[water]\nkind = "3C"\n')
    spec = load_scene_spec(path)
    assert (spec.seed, spec.sentences, spec.water.kind) == (5, ("STOP UP GO",), "3C")
    for text, complaint in (
        ("sead = 1", "sead"),
        ("[water]\nkind = 'rum'", "water.kind"),
        ("=", "TOML syntax"),
    ):
        path.write_text(text)
        with pytest.raises(ValueError, match=complaint):
            load_scene_spec(path)


@pytest.mark.parametrize("name", ACTIVITIES)
def test_busy_hands_sign_nothing(name):
    spec = SceneSpec(size=(96, 72), sentences=(f"~{name}",), water=WaterSpec(kind="none"))
    scene = Scene(spec)
    hold = scene.timeline[1]
    assert hold.activity == name
    frames = [scene.frame(index) for index in range(0, scene.frame_count, 16)]
    pairs = [{hand.side: hand.token for hand in frame.record.hands} for frame in frames]
    assert not any(pair.get("left") and pair.get("right") for pair in pairs)


def test_an_unknown_activity_is_refused():
    with pytest.raises(ValueError, match="no activity '~dance'; choose one of ~rest, ~wave"):
        make_timeline(GRAMMAR, ["~dance"], Timing(), np.random.default_rng(0))


def test_waving_moves_the_open_hand_to_and_fro():
    timeline = make_timeline(GRAMMAR, ["~wave"], Timing(), np.random.default_rng(0))
    performance = Performance(timeline, Style(tremor_mm=0.0), np.random.default_rng(1), 3.0)
    wave = timeline[1]
    across = [performance.state(f, f / 30.0)[0].right.wrist[0] for f in range(wave.start, wave.end)]
    assert np.ptp(across) > 100.0
    assert tokens_at(timeline, moment_at(timeline, wave.start)) == (None, "5")


def test_a_wrong_water_names_the_waters_as_they_are_written(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('[water]\nkind = "XX"\n', encoding="utf-8")
    with pytest.raises(ValueError, match=r"scene\.toml: water\.kind: input should be 'I', 'IA'"):
        load_scene_spec(path)
