"""The page as an extension of BlueOS: listed, called and shown by it, and by nobody else."""

import http.client
import json

import pytest

from lightgesture.web import WebListener


@pytest.fixture
def get():
    """Asks the page of an extension, or of none, for a path under a name: status, policy and body."""
    pages = {is_extension: WebListener(0, is_extension=is_extension) for is_extension in (False, True)}
    for page in pages.values():
        page.start()

    def ask(path, host, is_extension=True):
        port = int(pages[is_extension].address.rstrip("/").rpartition(":")[2])
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
        connection.request("GET", path, headers={"Host": host})
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, answer.headers["Content-Security-Policy"], body

    yield ask
    for page in pages.values():
        page.stop()


def test_blueos_learns_what_it_is(get):
    status, _, body = get("/register_service", "127.0.0.1:9090")
    assert status == 200
    assert {"name", "description", "icon", "company", "version", "webpage", "api"} == set(json.loads(body))
    assert get("/register_service", "127.0.0.1", is_extension=False)[0] == 404


@pytest.mark.parametrize(
    ("host", "frames"),
    [
        ("blueos.local:41000", "frame-ancestors http://blueos.local:*"),
        ("192.168.2.2:41000", "frame-ancestors http://192.168.2.2:*"),
        ("[fe80::1]:41000", "frame-ancestors 'none'"),
    ],
)
def test_pages_of_the_same_machine_may_show_it(get, host, frames):
    status, policy, _ = get("/", host)
    assert status == 200
    assert frames in policy


@pytest.mark.parametrize(
    "host", ["evil.example", "blueos.local.evil.example", "a.b.local", "x;script-src.local", ""]
)
def test_other_names_are_refused(get, host):
    status, policy, _ = get("/", host)
    assert status == 421
    assert "frame-ancestors 'none'" in policy


def test_without_the_option_nothing_is_changed(get):
    assert get("/", "blueos.local", is_extension=False)[0] == 421
    status, policy, _ = get("/", "127.0.0.1", is_extension=False)
    assert status == 200
    assert "frame-ancestors 'none'" in policy
