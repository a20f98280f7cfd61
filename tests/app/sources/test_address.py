"""Logins in addresses: sent, and never shown."""

import pytest

from lightgesture.errors import InputError, UsageError
from lightgesture.sources import SourceOptions, live_source, open_source
from lightgesture.sources.address import hide_login, split_address


@pytest.mark.parametrize(
    ("address", "name", "plain", "login"),
    [
        ("http://cam:8090/?action=stream", "http://cam:8090/?action=stream", None, (None, None)),
        ("http://di%40ver:s%3A%23t@cam/x", "http://cam/x", "http://cam/x", ("di@ver", "s:#t")),
        ("http://u:p@ss@cam/x", "http://cam/x", "http://cam/x", ("u", "p@ss")),
        ("rtsp://u:@[fe80::1]:554/x", "rtsp://[fe80::1]:554/x", "rtsp://[fe80::1]:554/x", ("u", "")),
        ("http://cam/v?user=me&pwd=hush", "http://cam/v?***", "http://cam/v?user=me&pwd=hush", (None, None)),
        ("http://cam/v?loginuse=me&loginpas=hush#x", "http://cam/v?***", None, (None, None)),
        ("http://cam/v?me:hush", "http://cam/v?***", None, (None, None)),
        ("http://cam/v?pwd=hu#sh", "http://cam/v?***", None, (None, None)),
        ("rtsp://cam/user=me_password=hush_channel=1.sdp", "rtsp://cam/***", None, (None, None)),
        ("http://me:12/hush@cam/x", "http://***@cam/x", None, (None, None)),
        ("http://hu#sh@cam/x", "http://***@cam/x", None, (None, None)),
    ],
)
def test_a_login_is_taken_and_hidden(address, name, plain, login):
    found = split_address(address)
    assert (found.name, (found.user, found.password)) == (name, login)
    assert found.plain == (plain or address.partition("#")[0])


@pytest.mark.parametrize("sign", ["#", "/", "?", "[", "]"])
@pytest.mark.parametrize("scheme", ["http", "https", "rtsp", "udp"])
def test_an_address_that_cannot_be_split_says_what_to_do(scheme, sign):
    with pytest.raises(UsageError, match="percent-encode the password: # is %23") as caught:
        live_source(f"{scheme}://diver:hu{sign}sh@cam:80/x", SourceOptions())
    for secret in ("diver", "hu", "sh"):
        assert secret not in str(caught.value).partition(": cannot")[0]


@pytest.mark.parametrize(
    ("name", "error"),
    [
        ("htp://diver:hush@cam/x", UsageError),
        ("http:/diver:hush@cam/x", UsageError),
        ("rtspsrc location=rtsp://diver:hu/sh@cam/x ! appsink", UsageError),
        ('rtspsrc location=rtsp://cam/x user-id=diver user-pw="hu sh" ! appsink', UsageError),
        ("souphttpsrc location=http://cam/x?user=diver&pwd=hush ! appsink", UsageError),
    ],
)
def test_names_that_are_no_streams_here_are_told_without_a_login(name, error):
    with pytest.raises(error) as caught:
        live_source(name, SourceOptions())
    assert not {word for word in ("diver", "hu", "hush") if word in str(caught.value)}


def test_decode_sends_streams_elsewhere_without_their_login():
    with pytest.raises(InputError, match=r"^http://cam/x: is a stream; decode it with `lightgesture live`"):
        open_source("http://diver:hush@cam/x")


@pytest.mark.parametrize("name", ["take:1.mp4", "folder/a@b?c=1", "0", "-", "C:\\dives\\a.mp4"])
def test_other_names_stay(name):
    assert hide_login(name) == name
