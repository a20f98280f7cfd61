"""MediaPipe Hands as a process that times a frame whenever it is asked; run by `peers` in an environment of its own.

Arguments: a file of frames (NumPy, uint8 (n, height, width, 3), BGR) and the complexities of the nets, 0 lite, 1 full.
Each line of standard input is the number of a frame; the answer is a JSON list of milliseconds of
processor time, one a net. This file
imports nothing of the package, which need not be installed there.
"""

import importlib
import json
import sys
import time
from typing import Any


def main(path: str, complexities: list[int]) -> None:
    """Answer until the input ends."""
    import cv2
    import numpy as np

    frames = np.load(path, mmap_mode="r")
    solutions: Any = importlib.import_module("mediapipe").solutions
    nets = [
        solutions.hands.Hands(static_image_mode=False, max_num_hands=2, model_complexity=complexity)
        for complexity in complexities
    ]
    print("ready", flush=True)
    for line in sys.stdin:
        spent = []
        for net in nets:
            image = np.array(frames[int(line)])
            start = time.process_time()
            net.process(cv2.cvtColor(image, cv2.COLOR_BGR2RGB))
            spent.append((time.process_time() - start) * 1e3)
        print(json.dumps(spent), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], [int(text) for text in sys.argv[2:]])
