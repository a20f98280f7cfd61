"""The page in headless Chromium, wide and narrow; needs `pip install playwright` and a Chromium of the system."""

import shutil
import time

import numpy as np
import pytest

from lightgesture.fsm import Rejected, State
from lightgesture.fsm.events import Growth
from lightgesture.records import FrameRecord, Hand
from lightgesture.web import WebListener

playwright = pytest.importorskip("playwright.sync_api")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")]

AT = {"source": "<script>document.title='bad'</script>", "frame": 3, "time_s": 0.1}
HOSTILE = "STOP <img src=x onerror=document.title='bad'> " + "W" * 90
HAND = Hand(side="right", token="5", confidence=0.98, box=(80, 80, 200, 200), track=1, reason=None)
RECORDS = [
    FrameRecord(hands=(HAND,), **AT),
    State(
        state="collecting",
        sentence="STOP HOVER",
        dwell=Growth(pair=("ok", "5"), word="5", progress=0.4),
        **AT,
    ),
    Rejected(reason="unknown_program", text=HOSTILE, detail=HOSTILE, **AT),
]


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as driver:
        # Chromium refuses its sandbox to the superuser, as whom containers run tests.
        chromium = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield chromium
        chromium.close()


@pytest.fixture
def page(browser, request):
    """The open page at the width that the test names, and what the browser complained of."""
    with WebListener(0) as listener:
        image = np.full((480, 640, 3), 90, np.uint8)
        listener.show(image, RECORDS)
        opened = browser.new_page(viewport={"width": request.param, "height": 800})
        complaints = []
        opened.on("console", lambda message: complaints.append(message.text))
        opened.on("pageerror", lambda error: complaints.append(str(error)))
        opened.goto(listener.address, wait_until="commit")
        opened.wait_for_selector("li.rejected")
        wait_for(opened, "document.getElementById('picture').naturalWidth > 0")
        yield listener, image, opened
        opened.close()
        assert complaints == []


def wait_for(page, condition, most_s=20.0):
    """`wait_for_function` is not allowed by the page's own policy."""
    end = time.monotonic() + most_s
    while not page.evaluate(condition):
        assert time.monotonic() < end, condition
        time.sleep(0.05)


@pytest.mark.parametrize("page", [320, 1280], indirect=True)
def test_everything_is_shown_as_text_and_fits(page):
    _, _, page = page
    assert page.title() == "lightgesture"
    assert page.text_content("#source") == AT["source"]
    assert page.text_content("#sentence") == "STOP HOVER"
    assert page.text_content("li.rejected strong") == HOSTILE
    assert page.evaluate("document.querySelectorAll('img').length") == 1
    assert page.evaluate("document.getElementById('dwell').value") == pytest.approx(0.4)
    assert page.text_content("#dwell-label") == "ok and 5: 5"
    assert page.text_content("#hands") == "right hand: 5"
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


@pytest.mark.parametrize("page", [1280], indirect=True)
def test_a_keyboard_pauses_the_picture_and_goes_on(page):
    listener, image, page = page
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "pause"
    page.keyboard.press("Space")
    assert page.get_attribute("#pause", "aria-pressed") == "true"
    assert not page.is_visible("#picture")
    assert page.is_visible("#still")
    page.keyboard.press("Space")
    listener.show(image, RECORDS[:1])
    wait_for(page, "document.getElementById('picture').naturalWidth > 0")
    assert page.query_selector("#still") is None


@pytest.mark.parametrize("page", [1280], indirect=True)
def test_a_new_instruction_comes_first_and_the_sentence_goes(page):
    listener, image, page = page
    idle = State(state="idle", sentence="", dwell=None, **AT)
    listener.show(image, [RECORDS[0], Rejected(reason="timeout", text="CONTD", detail="late", **AT), idle])
    wait_for(page, "document.querySelectorAll('li').length === 2")
    assert page.text_content("li:first-child strong") == "CONTD"
    wait_for(page, "document.getElementById('sentence').textContent === 'none'")
    assert page.text_content("#link") == "idle"


@pytest.mark.parametrize("page", [128], indirect=True)
def test_the_display_for_the_diver(page):
    listener, _, opened = page
    opened.set_viewport_size({"width": 128, "height": 64})
    opened.goto(listener.address + "display", wait_until="commit")
    wait_for(opened, "document.body.dataset.mood !== 'lost'")
    listener.show(None, RECORDS[-1:])
    wait_for(opened, "document.body.dataset.mood === 'refused'")
    assert opened.inner_text("#word") == "NO"
    assert (
        opened.evaluate("document.documentElement.scrollWidth <= 128 && document.title")
        == "lightgesture display"
    )
    wait_for(opened, "document.body.dataset.mood === 'busy'")  # the answer is over
    listener.show(None, [State(state="collecting", sentence="STOP HOVER 5", dwell=None, **AT)])
    wait_for(opened, "document.getElementById('word').textContent === 'STOP HOVER 5'")
    box = opened.locator("#word").bounding_box()
    assert 0 <= box["y"] < box["y"] + box["height"] <= 64
