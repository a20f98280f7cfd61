"""Hours of generated video at full speed: `python -m lightgesture.benchmarks.soak`.

A clip goes round and round, first through `live` with the page open, UDP, MAVLink, a hook and the executor on, then, in
long videos, through `decode --jobs 2`. The processes are looked at from outside, by /proc, so it runs on Linux. What is
told: memory, handles, threads and frames a second of the clock and of the processor, over ten parts of the time, and
whether the last part is as the second; and whether what was issued is just what comes of the clip decoded in pieces.
"""

import argparse
import json
import math
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.mjpeg_server import read_jpegs
from lightgesture.benchmarks.soak.sampling import Pace
from lightgesture.benchmarks.soak.stream import FPS, decode_round
from lightgesture.benchmarks.tables import Table, to_text
from lightgesture.console import messages_shown, print_line, say
from lightgesture.errors import ExitStatus, InputError

HOURS: Final = 2.0
EVERY_S: Final = 2.0
PARTS: Final = ("live", "decode")


def soak(
    clip: Path, count: int, pace: Pace, only: Sequence[str], samples_to: Path | None
) -> Iterator[tuple[Table, list[str]]]:
    """The parts, of about `count` frames each: a table, and what is wrong. InputError: the clip cannot be read."""
    pictures = read_jpegs(str(clip))
    if "live" in only:
        from lightgesture.benchmarks.soak.live_part import soak_live

        yield soak_live(clip, pictures, count, pace, samples_to)
    if "decode" in only:
        from lightgesture.benchmarks.soak.decode_part import soak_decode

        with tempfile.TemporaryDirectory() as place:
            yield soak_decode(clip, len(pictures), count, Path(place), pace, samples_to)


@messages_shown()
def main(argv: Sequence[str] | None = None) -> int:
    """The command line; 0 where all is flat and right."""
    parser = argparse.ArgumentParser(prog="python -m lightgesture.benchmarks.soak", description=__doc__)
    parser.add_argument(
        "--hours", type=float, default=HOURS, metavar="H", help=f"of video (default {HOURS:g})"
    )
    parser.add_argument("--clip", type=Path, default=SAMPLE, metavar="CLIP", help="default: the bundled one")
    parser.add_argument("--every", type=float, default=EVERY_S, metavar="S", help="seconds between two looks")
    parser.add_argument(
        "--most", type=float, default=math.inf, metavar="S", help="seconds after which `live` is asked to end"
    )
    parser.add_argument("--only", choices=PARTS, help="one part alone")
    parser.add_argument("--samples", type=Path, metavar="DIR", help="keep every look there, a table a part")
    parser.add_argument(
        "--live", type=int, metavar="N", help="only decode N pictures, as the measured process does"
    )
    parser.add_argument("--options", default="{}", metavar="JSON", help="options of that process")
    args = parser.parse_args(argv)
    try:
        if args.live is not None:
            return decode_round(read_jpegs(str(args.clip)), args.live, json.loads(args.options))
        if not os.path.isdir("/proc/self/fd"):
            say("the soak looks at processes by /proc, which this system lacks; run it on Linux")
            return ExitStatus.USAGE
        parts = PARTS if args.only is None else (args.only,)
        count, found = round(args.hours * 3600 * FPS), []
        for table, wrong in soak(args.clip, count, Pace(args.every, args.most), parts, args.samples):
            print_line(to_text([table]) + "\n")
            found += wrong
    except InputError as error:
        say(str(error))
        return ExitStatus.SOME_FAILED
    print_line("\n".join(found) or "flat, and the results are those of the clip in pieces")
    return ExitStatus.SOME_FAILED if found else ExitStatus.OK


if __name__ == "__main__":
    sys.exit(main())
