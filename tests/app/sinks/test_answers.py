"""What the diver is answered, by lamp and by the vehicle's motion."""

import pytest
from gpiozero import Device
from gpiozero.pins.mock import MockFactory

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.fsm import Notice, Rejected, State
from lightgesture.records import VehicleRecord
from lightgesture.sinks import SinkError, make_answers
from lightgesture.sinks.answers import Answer, Lights, Mood, advance, answer_of, lights
from lightgesture.sinks.lamp import LampSink, parse_pins
from lightgesture.sinks.nod import MotionSink

AT = {"source": "cam", "frame": 3, "time_s": 0.1}
IDLE, BUSY = Lights(green=True), Lights(orange=True)


def vehicle(state, instruction="STOP HOVER 50 GO"):
    return VehicleRecord(time_s=1.0, state=state, instruction=instruction, detail="why")


def state(name):
    return State(state=name, sentence="", dwell=None, **AT)


def rejected():
    return Rejected(reason="limit", text="STOP GO", detail="why", **AT)


def notice(reason):
    return Notice(reason=reason, detail="why", **AT)


def test_what_each_record_answers(instruction):
    assert answer_of(instruction(), obeys=False) is Answer.ACCEPTED
    assert answer_of(instruction(), obeys=True) is None  # the vehicle decides
    assert answer_of(rejected(), obeys=True) is Answer.REFUSED
    assert answer_of(notice("repeat"), obeys=True) is Answer.REPEAT
    assert answer_of(notice("gap"), obeys=True) is None
    assert [
        answer_of(vehicle(name), obeys=True) for name in ("sent", "accepted", "refused", "aborted", "done")
    ] == [
        None,
        Answer.ACCEPTED,
        Answer.REFUSED,
        Answer.REFUSED,
        Answer.DONE,
    ]


def mood_after(*records):
    mood = Mood()
    for record in records:
        mood = advance(mood, record, 100.0, obeys=True)
    return mood


@pytest.mark.parametrize(
    ("records", "at_once", "later"),
    [
        ([], IDLE, IDLE),
        ([state("collecting")], BUSY, BUSY),
        ([state("collecting"), state("idle")], IDLE, IDLE),
        ([vehicle("sent")], BUSY, BUSY),
        ([vehicle("sent"), vehicle("accepted")], Lights(green=True), BUSY),
        ([vehicle("sent"), vehicle("done")], Lights(green=True), IDLE),
        ([vehicle("sent"), vehicle("refused")], Lights(red=True), IDLE),
        ([vehicle("sent"), vehicle("sent", "CONTD SNAP GO"), vehicle("done")], Lights(green=True), BUSY),
        ([state("collecting"), rejected(), state("idle")], Lights(red=True), IDLE),
        ([state("collecting"), notice("repeat")], Lights(orange=True), BUSY),
    ],
)
def test_lights(records, at_once, later):
    mood = mood_after(*records)
    assert lights(mood, 100.0) == at_once
    assert lights(mood, 110.0) == later


def test_what_blinks_and_what_does_not():
    for record, blinks in ((vehicle("done"), True), (notice("repeat"), True), (rejected(), False)):
        shown = [lights(mood_after(record), 100.0 + 0.1 * step) for step in range(15)]
        assert (Lights() in shown) == blinks


@pytest.fixture
def pins():
    Device.pin_factory = MockFactory()
    yield Device.pin_factory
    Device.pin_factory.reset()
    Device.pin_factory = None


def levels(pins):
    return [bool(pins.pin(number).state) for number in (17, 27, 22)]


def test_the_lamp_switches_its_pins(pins):
    now = [100.0]
    lamp = LampSink((17, 27, 22), obeys=True, clock=lambda: now[0])
    lamp.open()
    assert levels(pins) == [True, False, False]
    lamp.send(state("collecting"))
    assert levels(pins) == [False, True, False]
    lamp.send(rejected())
    assert levels(pins) == [False, False, True]
    now[0] += 4
    lamp.send(state("idle"))
    lamp.poll()
    assert levels(pins) == [True, False, False]
    lamp.send(vehicle("done"))
    now[0] += 0.3
    lamp.poll()
    assert levels(pins) == [False, False, False]
    lamp.close()
    lamp.close()
    lamp.open()  # and anew
    lamp.close()
    assert not any(levels(pins))


def test_pins_that_another_has(pins):
    first, second = (LampSink((17, 27, 22), obeys=False) for _ in range(2))
    first.open()
    with pytest.raises(SinkError, match=r"^lamp 17,27,22: the pins cannot be had \("):
        second.open()
    second.close()
    first.close()


@pytest.mark.parametrize("text", ["", "1,2", "1,2,3,4", "1,2,2", "1,2,x", "1,2,54", "1,2,-3", "1,2,²"])
def test_pins_that_are_none(text):
    with pytest.raises(UsageError, match="should be three pins"):
        parse_pins(text)


class Mover:
    def __init__(self):
        self.words = []

    def answer(self, word):
        self.words.append(word)


def test_the_vehicle_nods_and_shakes():
    mover = Mover()
    sink = MotionSink(mover)
    for record in (vehicle("accepted"), vehicle("done"), vehicle("refused"), rejected(), notice("repeat")):
        if sink.wants(record):
            sink.send(record)
    assert mover.words == ["nod", "shake", "shake"]


def test_the_option(pins):
    made = make_answers(DecodeSettings(answer=["lamp:17,27,22", "motion"]), Mover())
    assert [sink.name for sink in made] == ["lamp 17,27,22", "motion"]
    with pytest.raises(UsageError, match="--answer motion: moves nothing without --obey"):
        make_answers(DecodeSettings(answer=["motion"]), None)
    with pytest.raises(UsageError, match="--answer smoke: should be lamp:GREEN,ORANGE,RED or motion"):
        make_answers(DecodeSettings(answer=["smoke"]), Mover())


def test_without_the_extra(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "gpiozero", None)
    with pytest.raises(UsageError, match=r"install lightgesture\[lamp\]"):
        LampSink((17, 27, 22), obeys=False)
