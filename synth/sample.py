"""Writes the clip that comes with the package: one diver, one sentence, one seed.

Run `python -m lightgesture.synth.sample OUT.mp4` to make it again; the default output is the bundled file.
"""

from __future__ import annotations

import sys
from pathlib import Path

from lightgesture.synth.output import video_writer
from lightgesture.synth.scene import Scene
from lightgesture.synth.spec import BackdropSpec, CameraSpec, DiverSpec, MotionSpec, SceneSpec, WaterSpec

SAMPLE_SPEC = SceneSpec(
    seed=4,
    sentences=("STOP HOVER 50 GO",),
    hold=(32, 35),
    passage=(9, 10),
    water=WaterSpec(kind="III", depth_m=4.0, turbidity=0.16),
    backdrop=BackdropSpec(floor="sand", floor_m=1.7, caustic=0.25),
    diver=DiverSpec(monk=3.6, blood=1.1, distance_mm=1150.0, looseness=0.15, sleeve_mm=25.0),
    motion=MotionSpec(drift=0.6, tremor_mm=1.5),
    camera=CameraSpec(noise=0.3, balance=0.35, drift=0.008),
)
DEFAULT_OUTPUT = Path(__file__).resolve().parent.parent / "data" / "sample.mp4"


def write_sample(path: Path) -> None:
    """Render the sample to `path`."""
    scene = Scene(SAMPLE_SPEC)
    with video_writer(path, scene.spec.fps, scene.spec.size) as put:
        for frame in scene.frames():
            put(frame.image)


if __name__ == "__main__":
    write_sample(Path(sys.argv[1]) if len(sys.argv) > 1 else DEFAULT_OUTPUT)
