"""The readers build the rules of the data folder in."""

import pytest

from lightgesture.benchmarks.scorer import iou
from lightgesture.errors import InputError
from lightgesture.training.datasets import (
    Label,
    find_data,
    group_samples,
    is_sequence,
    read_frames,
    read_hands,
    read_negatives,
    read_webcam,
)


def test_landmark_boxes_are_grown_to_the_outline_and_read_as_left_hands(data):
    first, second, third = read_hands(data)
    assert first.labels == (Label((11, 9, 79, 96), "left", "5"),)
    assert (first.source, first.doubtful, second.doubtful) == ("anna", False, True)
    assert third.labels[0].token == "none"
    assert first.path.is_file()


def test_frames_come_in_order_with_the_divers_own_sides(data):
    groups = group_samples(read_frames(data))
    assert [sample.order for sample in groups["hover"]] == [2, 10]
    assert [label.side for label in groups["hover"][1].labels] == ["right", "left"]
    assert is_sequence(groups["hover"])
    assert not is_sequence(groups["tank"])


def test_shapes_outside_the_language_have_no_token(data):
    assert [label.token for label in group_samples(read_frames(data))["hover"][0].labels] == ["ok", None]


def test_only_frames_with_two_labels_are_complete(data):
    assert {sample.group: sample.complete for sample in read_frames(data)} == {"hover": True, "tank": False}


def test_negatives_have_no_label_and_are_complete(data):
    samples = read_negatives(data)
    assert [(sample.group, sample.order, sample.labels, sample.complete) for sample in samples] == [
        ("reef_1", 0, (), True),
        ("reef_1", 1, (), True),
    ]


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (lambda path: path.unlink(), "cannot be read"),
        (lambda path: path.write_text("path,token\n"), "holds no rows"),
        (lambda path: path.write_text("path,token,set,note,hx0,hy0,hx1,hy1\na,5,s,,1,2,3,x\n"), "column hy1"),
        (lambda path: path.write_bytes(b"\xff\xfe\x00"), "cannot be read"),
    ],
)
def test_a_broken_table_is_named_in_one_line(data, damage, reason):
    damage(data / "hands" / "val.csv")
    with pytest.raises(InputError, match=reason) as error:
        read_hands(data)
    assert "\n" not in str(error.value)


def test_a_missing_data_folder_is_named(tmp_path, data):
    assert find_data(data) == data
    with pytest.raises(InputError, match="no such folder"):
        find_data(tmp_path / "nowhere")


def test_real_folder_has_the_documented_contents(real_data):
    assert len(read_hands(real_data)) == 1054
    assert len(read_webcam(real_data)) == 32
    groups = {group: len(members) for group, members in group_samples(read_frames(real_data)).items()}
    assert groups == {
        "underwater": 2,
        "hover": 14,
        "subhi": 110,
        "subhi_26": 51,
        "subhi_46": 42,
        "drone": 118,
    }
    assert len(read_negatives(real_data)) == 341


def test_a_real_landmark_box_lies_inside_its_grown_label(real_data):
    sample = read_hands(real_data)[0]
    assert iou(sample.labels[0].box, (15, 12, 36, 42)) == pytest.approx(1 / 1.18**2, abs=0.03)
