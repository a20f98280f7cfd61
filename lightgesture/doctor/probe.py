"""A fresh process that decodes the bundled clip and says how it went, started by `lightgesture doctor`.

It prints one JSON object a line: `FIRST` at the first record and, unless it is asked for that alone, the findings at
the end. A library that is broken on this machine ends this process, not the doctor.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any

FIRST = "first record"
ONLY_FIRST = "--only-first"
VIDEO_BACKENDS = ("FFMPEG", "GSTREAMER", "V4L2")
"""What OpenCV reads with: pipelines and cameras of Linux; files and network streams are read by PyAV."""
KIB_PER_MIB = 1024


def main(arguments: list[str]) -> int:
    """Decode the clip, or only its first frame."""
    from lightgesture.console import native_messages_muted

    with native_messages_muted():
        findings = _decode(is_first_only=ONLY_FIRST in arguments)
    if findings:
        _tell(findings)
    return 0


def _decode(is_first_only: bool) -> dict[str, Any]:
    from lightgesture.actions.decode import SAMPLE
    from lightgesture.config.settings import BUILT_IN_MODELS
    from lightgesture.fsm import Instruction
    from lightgesture.pipeline import Pipeline
    from lightgesture.sources import open_source

    pipeline = Pipeline()
    texts = []
    start = time.perf_counter()
    with open_source(SAMPLE) as source:
        for frame in source:
            records = pipeline.process(frame.image, frame.time_s, frame.index)
            if frame.index == 0:
                _tell(FIRST)
                if is_first_only:
                    return {}
            texts += [record.text for record in records if isinstance(record, Instruction)]
    spent = time.perf_counter() - start
    summary = pipeline.finish()[-1].to_dict()
    return {
        "instructions": texts,
        "frames_per_second": round(summary["frames"] / spent, 1),
        "ms_per_frame": summary["ms_per_frame"],
        "peak_mib": peak_mib(),
        "video": _video_backends(),
        "classifiers": {name: _classifier(name) for name in BUILT_IN_MODELS},
        "nets": _nets(),
    }


def peak_mib() -> float | None:
    """Most memory that this process ever held, MiB; None where the system does not say.

    Not `getrusage` where `/proc` is there: Linux counts in what the parent held when it started this process.
    """
    try:
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
        kib = next(int(line.split()[1]) for line in lines if line.startswith("VmHWM:"))
    except (OSError, StopIteration):
        return _peak_by_usage()
    return round(kib / KIB_PER_MIB, 1)


def _peak_by_usage() -> float | None:
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    kib = peak / KIB_PER_MIB if sys.platform == "darwin" else peak
    return round(kib / KIB_PER_MIB, 1)


def _video_backends() -> dict[str, bool]:
    import cv2

    registry = cv2.videoio_registry
    return {name: registry.hasBackend(getattr(cv2, f"CAP_{name}")) for name in VIDEO_BACKENDS}


def _classifier(name: str) -> str | None:
    """Why a classifier cannot be used; None if it can."""
    from lightgesture.models import ModelError, load_classifier

    try:
        load_classifier(name)
    except ModelError as error:
        return str(error)
    return None


def _nets() -> str:
    """What computes the nets: the same choice that they make themselves."""
    try:
        import ai_edge_litert.interpreter  # noqa: F401 - only whether it can be
    except ImportError:
        return "NumPy"
    return "LiteRT"


def _tell(content: object) -> None:
    print(json.dumps(content), flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
