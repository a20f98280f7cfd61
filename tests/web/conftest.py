"""Pages on the loopback address for tests, stopped after each."""

import pytest

from lightgesture.web import WebListener, answers, board, head, listener, server


@pytest.fixture
def serve(monkeypatch):
    """Starts pages, and stops them after the test; limits: constants of the page's modules, in small letters."""
    started = []

    def start(host="127.0.0.1", draw=None, token=None, **limits):
        for name, value in {"beat_s": 0.2, **limits}.items():
            place = next(
                module for module in (server, answers, listener, board, head) if hasattr(module, name.upper())
            )
            monkeypatch.setattr(place, name.upper(), value)
        page = WebListener(0, host, draw, token=token)
        page.start()
        started.append(page)
        return page

    yield start
    for page in started:
        page.stop()
