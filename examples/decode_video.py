"""A video to instructions, frame by frame: `python examples/decode_video.py dive.mp4`.

Prints each instruction with its time, and each rejection with its reason; without a name it takes the bundled clip.
"""

import sys
from importlib.resources import as_file, files

from lightgesture import Instruction, Pipeline, Rejected
from lightgesture.sources import open_source


def decode(path: str) -> list[Instruction | Rejected]:
    """What the diver in a video signed."""
    found: list[Instruction | Rejected] = []
    with open_source(path) as frames, Pipeline(source=path) as pipeline:
        for frame in frames:
            records = pipeline.process(frame.image, time_s=frame.time_s)
            found += [one for one in records if isinstance(one, Instruction | Rejected)]
        found += [one for one in pipeline.finish() if isinstance(one, Instruction | Rejected)]
    return found


def main() -> None:
    """Decode the video that is named, or the bundled clip."""
    with as_file(files("lightgesture") / "data" / "sample.mp4") as sample:
        path = sys.argv[1] if len(sys.argv) > 1 else str(sample)
        for one in decode(path):
            if isinstance(one, Instruction):
                print(f"{one.start_time_s:.1f} to {one.time_s:.1f} s: {one.text} ({one.confidence:.0%})")
            else:
                print(f"{one.time_s:.1f} s: rejected, {one.detail}")


if __name__ == "__main__":
    main()
