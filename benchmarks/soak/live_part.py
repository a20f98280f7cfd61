"""`live` with everything on, watched from outside."""

import json
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final

from lightgesture.benchmarks.soak.peers import HOST, Browser, Receiver, SimulatedVehicle, free_port
from lightgesture.benchmarks.soak.pieces import Verdict, of_pieces, of_records, unlike
from lightgesture.benchmarks.soak.sampling import Pace, Sample, look, parts, save, table, wrong
from lightgesture.benchmarks.tables import Table
from lightgesture.console import say
from lightgesture.errors import ExitStatus

HOOK: Final = "cat"
"""What is run for each instruction: it takes the record and ends."""

TELL_EVERY: Final = 60
"""Looks from one line of progress to the next."""

TOLD: Final = ("instruction", "rejected", "vehicle", "summary")
"""Records that are kept; of heartbeats the newest."""


class _Records:
    """What the measured process prints."""

    def __init__(self) -> None:
        self.kept: list[dict[str, Any]] = []
        self.frames = 0

    def read(self, process: "subprocess.Popen[str]") -> None:
        """Take line after line until the end."""
        assert process.stdout is not None
        for line in process.stdout:
            record = json.loads(line)
            if record["type"] == "heartbeat":
                self.frames = record["frames"]
            elif record["type"] in TOLD:
                self.kept.append(record)


def soak_live(
    clip: Path, pictures: Sequence[bytes], count: int, pace: Pace, samples_to: Path | None = None
) -> tuple[Table, list[str]]:
    """Decode `count` pictures of a clip that goes round; the table of what it took, and what is wrong.

    samples_to: folder for the samples, None: they are not kept.
    """
    with ExitStack() as stack:
        datagrams, station = stack.enter_context(Receiver()), stack.enter_context(Receiver())
        vehicle, port = stack.enter_context(SimulatedVehicle()), free_port()
        options = {
            "web": port,
            "udp": [f"{HOST}:{datagrams.port}"],
            "mavlink": [f"udpout:{HOST}:{vehicle.port}", f"udpout:{HOST}:{station.port}"],
            "obey": "ardusub",
            "hook": [HOOK],
        }
        browsers = [Browser(port, path) for path in ("/stream.mjpg", "/events")]
        for browser in browsers:
            stack.enter_context(browser)
        command = [sys.executable, "-m", "lightgesture.benchmarks.soak", "--clip", str(clip)]
        command += ["--live", str(count), "--options", json.dumps(options)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        stack.callback(process.wait)
        stack.callback(process.kill)
        records = _Records()
        samples = _watch(process, records, pace)
        peers = {"datagrams": datagrams, "station": station, "vehicle": vehicle}
        counts = {name: peer.count for name, peer in peers.items()}
        counts |= {f"bytes of {one.path}": one.count for one in browsers}
    save(samples, "live", samples_to)
    # Fewer than asked for where the time was up before.
    decoded = sum(one["frames"] for one in records.kept if one["type"] == "summary")
    table, found = _judged(records, samples, counts, of_pieces(pictures, decoded))
    if process.returncode != ExitStatus.OK or (decoded != count and samples[-1].wall_s < pace.most_s):
        found.append(f"live: ended after {decoded} of {count} frames with status {process.returncode}")
    return table, found


def _watch(process: "subprocess.Popen[str]", records: _Records, pace: Pace) -> list[Sample]:
    reader = threading.Thread(target=records.read, args=(process,), daemon=True)
    reader.start()
    start_s, samples, is_asked = time.monotonic(), [], False
    while process.poll() is None:
        time.sleep(pace.every_s)
        if not is_asked and time.monotonic() - start_s > pace.most_s:
            is_asked = True
            process.terminate()
        sample = look(process.pid, time.monotonic() - start_s, records.frames)
        # Not while it starts, nor when it has let go of everything.
        if sample is not None and records.frames > 0 and process.poll() is None:
            samples.append(sample)
            if len(samples) % TELL_EVERY == 0:
                say(f"live: {sample.frames} frames, {sample.memory_mib:.1f} MiB")
    reader.join()
    return samples


def _judged(
    records: _Records, samples: Sequence[Sample], counts: dict[str, int], expected: Sequence[Verdict]
) -> tuple[Table, list[str]]:
    rows = parts(samples)
    found = wrong("live", rows)
    found += unlike("live", of_records(records.kept), expected)
    found += [f"live: nothing came to: {name}" for name, number in counts.items() if not number]
    done = [one["state"] for one in records.kept if one["type"] == "vehicle"]
    if "executing" not in done:
        found.append(f"live: the vehicle executed nothing: {set(done)}")
    made = table("live", rows)
    told = [f"verdicts {len(expected)}", *(f"{name} {number}" for name, number in counts.items())]
    told += [f"vehicle {state} {done.count(state)}" for state in dict.fromkeys(done)]
    return Table(made.name, made.title, made.columns, made.rows, "; ".join(told)), found
