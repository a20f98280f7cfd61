"""Larger nets that learn at a time: none of them goes on for long when one of them, or the caller, gives up."""

import threading
import time

import numpy as np
import pytest

from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.pool.patch_pool import PatchPool

pytest.importorskip("torch")

STEPS = 100000
"""More than anybody would wait for."""


class BreakingSamples(HandSamples):
    """Samples that fail when they are drawn for the fourth time, as if interrupted there."""

    def __init__(self):
        random = np.random.default_rng(0)
        patches = random.integers(0, 256, (8, 20, 20, 3), np.uint8)
        tokens, sources = np.array(["1", "5"] * 4), np.array(["somebody"] * 8)
        pool = PatchPool(patches, np.zeros((8, 4), np.float16), tokens, sources, np.arange(8))
        super().__init__(pool, np.ones(8, bool), ("1", "5"), 2)
        self.drawn = 0

    def draw(self, random, count):
        self.drawn += 1
        if self.drawn == 4:
            raise KeyboardInterrupt
        return super().draw(random, count)


def test_an_interruption_ends_all_of_them_at_once(tmp_path):
    from lightgesture.training.nets.hand_net import NetSettings
    from lightgesture.training.nets.teachers import teach

    samples, ended = BreakingSamples(), threading.Event()

    def learn():
        with pytest.raises(KeyboardInterrupt):
            teach(samples, 2, NetSettings(STEPS), 0, 2, tmp_path, [].append)
        ended.set()

    threading.Thread(target=learn, daemon=True).start()
    assert ended.wait(60.0)
    drawn = samples.drawn
    time.sleep(0.2)
    assert samples.drawn == drawn < 1000
    assert not (tmp_path / "answers.npy").exists()
