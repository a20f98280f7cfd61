"""What the page is told: the log, the state, events."""

import json

from lightgesture.fsm import Rejected, State
from lightgesture.fsm.events import Growth
from lightgesture.records import SummaryRecord, VehicleRecord
from lightgesture.web import WebListener
from tests.makers import hover
from tests.web.browser import AT, FRAME, connect, get, picture, read_until

STATE = State(
    state="collecting", sentence="STOP", dwell=Growth(pair=("5", "5"), word="HOVER", progress=0.4), **AT
)


def instruction(text="STOP HOVER GO"):
    return hover(
        text=text, duration_s=None, words=("STOP", "HOVER", "GO"), start_time_s=0.0, start_frame=0, **AT
    )


def rejected(text="STOP EXEC 5 GO", detail="no program 5"):
    return Rejected(reason="unknown_program", text=text, detail=detail, **AT)


def test_the_log_has_what_is_listed(serve):
    page = serve()
    assert get(page, "/log.jsonl")[2] == b""
    page.show(picture(), [FRAME, STATE, instruction(), rejected()])
    page.show(None, [instruction("CONTD SNAP GO")])
    lines = [json.loads(line) for line in get(page, "/log.jsonl")[2].splitlines()]
    assert [(line["type"], line["text"]) for line in lines] == [
        ("instruction", "STOP HOVER GO"),
        ("rejected", "STOP EXEC 5 GO"),
        ("instruction", "CONTD SNAP GO"),
    ]


def events_of(content):
    """The server-sent events of a stream's bytes: (name, id, data)."""
    found = []
    for block in content.decode().partition("\r\n\r\n")[2].split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.splitlines() if not line.startswith(":"))
        if "data" in fields:
            found.append((fields["event"], fields.get("id"), json.loads(fields["data"])))
    return found


HOSTILE = '</script><img src=x onerror=alert(1)>\n\ndata: {"no": 1}\n\nevent: state\r\n\u2028'


def test_state_and_entries(serve):
    listener = serve()
    listener.show(picture(), [FRAME, STATE, instruction(), rejected()])
    state = json.loads(get(listener, "/state.json")[2])
    assert (state["state"], state["sentence"]) == ("collecting", "STOP")
    assert state["dwell"] == {"pair": ["5", "5"], "word": "HOVER", "progress": 0.4}
    assert state["hands"][0]["token"] == "5"
    assert state["picture_age_s"] < 5
    assert [(entry["type"], entry["number"]) for entry in state["entries"]] == [
        ("instruction", 1),
        ("rejected", 2),
    ]


def test_what_the_diver_is_told(serve):
    page = WebListener(0, obeys=True)
    page.start()
    page.show(None, [instruction(), vehicle("sent"), vehicle("accepted")])
    state = json.loads(get(page, "/state.json")[2])
    assert state["tasks"] == ["STOP HOVER GO"]
    assert state["answer"]["answer"] == "accepted"
    assert 0 <= state["answer"]["age_s"] < state["answer"]["shown_s"] == 1.5
    page.show(None, [vehicle("refused")])
    state = json.loads(get(page, "/state.json")[2])
    assert (state["tasks"], state["answer"]["answer"]) == ([], "refused")
    assert [entry.get("detail") for entry in state["entries"]] == [None, "why", "why", "why"]
    page.stop()


def vehicle(state):
    return VehicleRecord(time_s=1.0, state=state, instruction="STOP HOVER GO", detail="why")


def test_heartbeats_and_the_end_come_without_a_picture(serve):
    listener = serve()

    class Heartbeat:
        def to_dict(self):
            return {
                "type": "heartbeat",
                "source": "0",
                "time_s": 2.0,
                "frames": 60,
                "dropped": 4,
                "ms_per_frame": 8.5,
                "state": "idle",
            }

    listener.show(None, [Heartbeat()])
    state = json.loads(get(listener, "/state.json")[2])
    assert (state["frames"], state["dropped"], state["picture_age_s"], state["ended"]) == (60, 4, None, None)
    summary = SummaryRecord(
        source="0",
        frames=60,
        seconds=2.0,
        instructions=0,
        rejected=0,
        status="ok",
        ms_per_frame={},
        stages_ms={},
    )
    listener.show(None, [summary])
    assert json.loads(get(listener, "/state.json")[2])["ended"] == "ok"


def test_events_tell_what_was_and_what_comes(serve):
    listener = serve(updates_per_s=50)
    listener.show(picture(), [FRAME, STATE, instruction("FIRST")])
    link = connect(listener, "/events")
    content = read_until(link, b"FIRST")
    listener.show(picture(), [FRAME, instruction("SECOND")])
    content += read_until(link, b"SECOND")
    events = events_of(content)
    assert [data["text"] for name, _, data in events if name == "entry"] == ["FIRST", "SECOND"]
    assert [data["sentence"] for name, _, data in events if name == "state"][:2] == ["STOP", "STOP"]
    assert events[0][0] == "state"
    last = next(number for name, number, data in events if name == "entry" and data["text"] == "FIRST")
    link.close()
    again = connect(listener, "/events", f"Last-Event-ID: {last}\r\n")
    texts = [data["text"] for name, _, data in events_of(read_until(again, b"SECOND")) if name == "entry"]
    assert texts == ["SECOND"]
    other = connect(listener, "/events", "Last-Event-ID: anotherrun-9\r\n")
    assert b"FIRST" in read_until(other, b"SECOND")


def test_hostile_text_stays_text(serve):
    listener = serve()
    listener.show(picture(), [FRAME, rejected(HOSTILE, HOSTILE), STATE])
    link = connect(listener, "/events")
    content = read_until(link, b"event: entry") + read_until(link, b": still here")
    events = events_of(content)
    assert [name for name, _, _ in events].count("entry") == 1
    assert next(data["text"] for name, _, data in events if name == "entry") == HOSTILE
    assert not any("no" in data for _, _, data in events)
