"""Options: defaults, precedence, the configuration file and what is refused."""

import argparse

import pytest

from lightgesture.config.declaring import DECODE, LIVE
from lightgesture.config.options import add_options, load_settings, read_config
from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import ExitStatus, UsageError


def load(*arguments):
    parser = argparse.ArgumentParser(allow_abbrev=False)
    add_options(parser, DECODE)
    return load_settings(parser.parse_args([str(argument) for argument in arguments]))


@pytest.fixture
def config(tmp_path):
    def write(text, encoding="utf-8"):
        path = tmp_path / "my config.toml"
        path.write_text(text, encoding=encoding)
        return path

    return write


def test_defaults():
    settings = load()
    assert settings == DecodeSettings()
    assert (settings.model, settings.hold, settings.fps, settings.as_json) == ("cnn", None, 30.0, False)


def test_command_line_goes_before_the_file(config):
    path = config('hold = 9\nfps = 12\nmirrored = true\njson = true\nmodel = "svm"\n')
    settings = load("--config", path, "--hold", 3, "--no-mirrored")
    assert (settings.hold, settings.fps, settings.mirrored, settings.as_json) == (3, 12.0, False, True)


def test_every_option_may_stand_in_the_file(config):
    path = config(
        'model = "/m.npz"\nselector = "classical"\nprofile = "/p.json"\n'
        'grammar = "/g.toml"\nhold = 9\nmirrored = true\nrotate = 180\n'
        'rule = "sentence"\ncaution = 1.5\nthreshold = 0.6\n'
        "fps = 12.5\njson = true\n"
        'frames = true\nout = "/o"\ndebug-dir = "/d"\nquiet = true\n'
        'annotate = true\nplot = true\njobs = 3\ncluster = "tcp://h:1"\n'
        'size = "640x480"\ntopic = "/camera"\nudp = ["rov:9000"]\n'
        'mavlink = ["udpout:rov:14550"]\nmavlink-map = "/map.toml"\nmavlink-system = 7\n'
        'obey = "/v.toml"\nanswer = ["motion"]\nhook = ["say hello"]\n'
        'web = 8080\nweb-host = "::1"\nweb-token = "under-water"\nweb-blueos = true\n'
        'front-end = "tags"\ntag-detector = "apriltag"\nshapes = "/s.json"\n'
        "insecure = true\ngive-up = 90.0\nrecursive = true\njoin = true\n"
    )
    settings = load("--config", path)
    assert settings.model_dump() == {
        "model": "/m.npz",
        "selector": "classical",
        "profile": "/p.json",
        "grammar": "/g.toml",
        "hold": 9,
        "hold_seconds": None,
        "rule": "sentence",
        "caution": 1.5,
        "threshold": 0.6,
        "front_end": "tags",
        "tag_detector": "apriltag",
        "shapes": "/s.json",
        "mirrored": True,
        "rotate": 180,
        "fps": 12.5,
        "as_json": True,
        "frames": True,
        "out": "/o",
        "web": 8080,
        "web_host": "::1",
        "web_token": "under-water",
        "web_blueos": True,
        "debug_dir": "/d",
        "quiet": True,
        "annotate": "below",
        "plot": True,
        "jobs": 3,
        "cluster": "tcp://h:1",
        "size": "640x480",
        "topic": "/camera",
        "udp": ["rov:9000"],
        "mavlink": ["udpout:rov:14550"],
        "mavlink_map": "/map.toml",
        "mavlink_system": 7,
        "obey": "/v.toml",
        "answer": ["motion"],
        "hook": ["say hello"],
        "insecure": True,
        "give_up": 90.0,
        "recursive": True,
        "join": True,
    }
    assert settings.width_height == (640, 480)


def test_one_hold_takes_the_place_of_the_other(config):
    settings = load("--config", config("hold = 9\n"), "--hold-seconds", 0.4)
    assert (settings.hold, settings.hold_seconds) == (None, 0.4)
    settings = load("--config", config("hold-seconds = 0.4\n"), "--hold", 9)
    assert (settings.hold, settings.hold_seconds) == (9, None)
    with pytest.raises(UsageError, match="--hold and --hold-seconds: exclude each other; give one of them"):
        load("--hold", 9, "--hold-seconds", 0.4)


def test_paths_in_the_file_start_at_its_folder(config, tmp_path):
    settings = load("--config", config('grammar = "g.toml"\nout = "results"\nmodel = "svm"\n'))
    assert settings.grammar == str(tmp_path / "g.toml")
    assert settings.out == str(tmp_path / "results")
    assert settings.model == "svm"


def test_a_byte_order_mark_does_no_harm(config):
    assert load("--config", config("hold = 4\n", encoding="utf-8-sig")).hold == 4


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("hodl = 3", "hodl: unknown key; did you mean 'hold'?"),
        ("xyzzy = 3", "xyzzy: unknown key; use model, selector, profile, grammar, hold"),
        ("hold_seconds = 0", "hold_seconds: should be greater than or equal to 0.05, not 0"),
        ("hold = 3\nhold-seconds = 1", "hold and hold_seconds: exclude each other; give one of them"),
        ("[decode]\nhold = 3", "decode: unknown key"),
        ('hold = "3"', "hold: should be a valid integer, not '3'"),
        ("hold = 0", "hold: should be greater than or equal to 1, not 0"),
        ("fps = nan", "fps: should be a finite number, not nan"),
        ("mirrored = 1", "mirrored: should be a valid boolean, not 1"),
        ("hold = ", "TOML syntax: "),
        ("hold = 1\nhold = 2", "TOML syntax: "),
    ],
)
def test_wrong_file(config, text, message):
    path = config(text)
    with pytest.raises(UsageError) as caught:
        load("--config", path)
    assert str(caught.value).startswith(f"{path}: {message}")


def test_a_file_in_which_much_is_wrong_tells_the_first_and_how_much_more(config):
    """Found by fuzzing: each unknown key told all known ones."""
    path = config("".join(f"{letter * 90} = 1\n" for letter in "vwxyz"))
    with pytest.raises(UsageError) as caught:
        load("--config", path)
    message = str(caught.value)
    assert f"{'x' * 60}: unknown key; use model" in message
    assert "y" * 60 not in message
    assert message.endswith("; and 2 more")
    assert len(message) < 2000


def test_file_that_cannot_be_read(config, tmp_path):
    with pytest.raises(UsageError, match="no such file; name an existing configuration"):
        load("--config", tmp_path / "none.toml")
    with pytest.raises(UsageError, match="is a folder"):
        load("--config", tmp_path)
    with pytest.raises(UsageError, match="byte 7: is not UTF-8"):
        load("--config", config('out = "é"', encoding="latin-1"))
    with pytest.raises(UsageError, match="is larger than 1048576 bytes"):
        load("--config", config("#" * (1 << 20) + "#"))
    with pytest.raises(
        UsageError, match=r"too deeply nested; keep to the layout of deploy/lightgesture\.toml"
    ):
        load("--config", config("a = " + "[" * 5000))


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("--hold", "0", "--hold: should be greater than or equal to 1, not '0'"),
        ("--hold", "x", "--hold: should be a valid integer, unable to parse string as an integer, not 'x'"),
        ("--fps", "0", "--fps: should be greater than 0, not '0'"),
        ("--fps", "inf", "--fps: should be"),
        ("--out", "", "--out: String should have at least 1 character, not ''"),
    ],
)
def test_wrong_option(option, value, message):
    with pytest.raises(UsageError) as caught:
        load(option, value)
    assert str(caught.value).startswith(message)


@pytest.mark.usefixtures("fake")
def test_wrong_key_through_the_command_line(run, config, make_video):
    path = config("hodl = 3")
    result = run("decode", make_video(), "--config", path)
    assert result.status == ExitStatus.USAGE
    assert result.err == [f"lightgesture: {path}: hodl: unknown key; did you mean 'hold'?"]
    assert result.out == []


def test_options_that_may_be_given_more_than_once():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    add_options(parser, LIVE)
    settings = load_settings(parser.parse_args(["--udp", "a:1", "--udp", "b:2", "--size", "8x6"]))
    assert settings.udp == ["a:1", "b:2"]
    assert (settings.width_height, DecodeSettings().width_height) == ((8, 6), None)
    assert "(default: [])" not in parser.format_help()


def test_the_page_is_for_live_streams_on_loopback_unless_told_otherwise(tmp_path):
    config = tmp_path / "live.toml"
    config.write_text("web = 8080\n")
    assert read_config(str(config)) == {"web": 8080}
    assert DecodeSettings().web is None
    assert DecodeSettings().web_host == "127.0.0.1"
    for wrong in ("0", "65536", '"8080"', "true"):
        config.write_text(f"web = {wrong}\n")
        with pytest.raises(UsageError, match="web"):
            read_config(str(config))
