"""The drawings that are shipped are those that the renderer makes."""

import cv2
import numpy as np
import pytest

from lightgesture.signs.drawings import drawing_file
from lightgesture.signs.png import draw_page
from lightgesture.signs.sheet import HandPicture, Page
from lightgesture.synth.drawings import INKS, draw_sign, main
from lightgesture.synth.poses import TOKENS


def silhouette(token, kind):
    page = Page(40.0, 40.0, (HandPicture(0.0, 0.0, 40.0, token, "left", kind),))
    return draw_page(page, 10.0).min(axis=2) < 250


def test_every_sign_has_its_files():
    files = [drawing_file(token, kind) for token in TOKENS for kind in INKS]
    assert all(file.is_file() for file in files)
    assert sum(file.stat().st_size for file in files) < 300_000


@pytest.mark.parametrize(("token", "kind"), [("ok", "bare"), ("right", "gloved")])
def test_a_shipped_drawing_is_made_again(tmp_path, monkeypatch, token, kind):
    shipped = silhouette(token, kind)
    text = draw_sign(token, kind)
    (tmp_path / f"{token}-{kind}.svg").write_text(text, encoding="utf-8")
    from lightgesture.signs import drawings

    monkeypatch.setattr(drawings, "FOLDER", tmp_path)
    drawings.load_drawing.cache_clear()
    again = silhouette(token, kind)
    drawings.load_drawing.cache_clear()
    assert (shipped & again).sum() / (shipped | again).sum() > 0.98


def test_a_thumb_of_a_left_hand_points_inward_for_left_and_outward_for_right():
    """In a mirror a left hand is on the left, and inward is to the right."""
    for token, inward in (("left", True), ("right", False)):
        shape = silhouette(token, "bare").astype(np.uint8)
        columns = np.flatnonzero(cv2.reduce(shape, 0, cv2.REDUCE_MAX)[0])
        heavy = np.average(np.arange(shape.shape[1]), weights=shape.sum(axis=0))
        middle = (columns[0] + columns[-1]) / 2
        assert (heavy < middle) == inward


def test_the_folder_is_named():
    with pytest.raises(SystemExit, match="folder"):
        main([])
