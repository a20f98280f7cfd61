"""The pages of signs and of practice: what they are given, and how they look in a browser."""

import http.client
import json
import shutil
import time

import numpy as np
import pytest

from lightgesture.fsm import State, load_grammar
from lightgesture.practice.session import Session
from lightgesture.practice.summary import view
from lightgesture.practice.tasks import named_tasks
from lightgesture.records import FrameRecord, Hand
from lightgesture.web import WebListener

GRAMMAR = load_grammar()
AT = {"source": "camera", "frame": 3, "time_s": 0.1}
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def get(page, path):
    connection = http.client.HTTPConnection(
        "127.0.0.1", int(page.address.rstrip("/").rpartition(":")[2]), timeout=10
    )
    connection.request("GET", path)
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, answer.headers["Content-Type"], body


@pytest.fixture
def served():
    with WebListener(0, grammar=GRAMMAR) as page:
        yield page


def test_the_language_and_its_drawings(served):
    status, kind, body = get(served, "/signs.json")
    assert (status, kind) == (200, "application/json")
    language = json.loads(body)
    assert language["words"][0] == {"word": "STOP", "pairs": [["ok", "0"], ["0", "0"]]}
    assert language["drawn"] == list(GRAMMAR.tokens)
    for token in GRAMMAR.tokens:
        for hand in ("bare", "gloved"):
            status, kind, body = get(served, f"/hands/{token}-{hand}.svg")
            assert (status, kind) == (200, "image/svg+xml")
            assert body.startswith(b"<svg")


@pytest.mark.parametrize("path", ["/hands/claw-bare.svg", "/hands/../page.js", "/hands/", "/signs.html"])
def test_there_is_nothing_else(served, path):
    assert get(served, path)[0] == 404


@pytest.mark.parametrize("path", ["/signs", "/practice"])
def test_the_pages_have_no_code_of_their_own(served, path):
    status, kind, body = get(served, path)
    assert (status, kind) == (200, "text/html; charset=utf-8")
    assert b"<style" not in body
    assert b"http" not in body.replace(b"http-equiv", b"")
    for script in ("/hands.js", f"{path}.js"):
        assert b'<script src="' + script.encode() + b'" defer></script>' in body
        code = get(served, script)[2].decode()
        assert not any(
            word in code for word in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write")
        )


def test_what_may_follow_goes_with_the_sentence(served):
    def expected():
        return json.loads(get(served, "/state.json")[2])["expected"]

    assert expected() == ["CONTD", "STOP"]
    served.show(None, [State(state="collecting", sentence="CONTD PARAM 3", dwell=None, **AT)])
    assert expected() == ["DECREASE", "DEFAULT", "INCREASE"]
    served.show(None, [State(state="idle", sentence="", dwell=None, **AT)])
    assert expected() == ["CONTD", "STOP"]


def test_without_a_grammar_no_sign_is_shown():
    with WebListener(0) as page:
        assert get(page, "/signs.json")[0] == 404
        assert json.loads(get(page, "/state.json")[2])["expected"] == []


def wait_for(page, condition, most_s=20.0):
    end = time.monotonic() + most_s
    while not page.evaluate(condition):
        assert time.monotonic() < end, condition
        time.sleep(0.05)


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
@pytest.mark.parametrize("width", [320, 1280])
def test_both_pages_in_a_browser(served, width):
    playwright = pytest.importorskip("playwright.sync_api")
    session = Session(named_tasks(GRAMMAR, ["STOP HOVER 50 GO"]), GRAMMAR, 60.0, is_revised=False)
    hand = Hand(side="left", token="5", confidence=0.9, box=(80, 80, 200, 200), track=1, reason=None)
    served.show(
        np.full((480, 640, 3), 90, np.uint8),
        [FrameRecord(hands=(hand,), **AT), State(state="collecting", sentence="STOP", dwell=None, **AT)],
    )
    served.tell("practice", view(session))
    with playwright.sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        complaints = []
        for path, ready in (
            ("signs", "document.querySelectorAll('#now li').length === 7"),
            ("practice", "document.querySelectorAll('#steps li img').length === 12"),
        ):
            page = chromium.new_page(viewport={"width": width, "height": 800})
            page.on("console", lambda message: complaints.append(message.text))
            page.on("pageerror", lambda error: complaints.append(str(error)))
            page.goto(served.address + path, wait_until="commit")
            wait_for(page, ready)
            assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
            if path == "practice":
                assert page.text_content("#left") == "5"
                assert page.text_content("#left-asked") == "asked: ok"
                assert page.text_content("#right") == "not in view"
            page.close()
        chromium.close()
    assert complaints == []
