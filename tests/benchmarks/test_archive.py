"""Archives that are broken off in the middle, with the real pipeline."""

import pytest

from lightgesture.benchmarks import archive


@pytest.mark.slow
def test_forty_clips_of_which_three_are_broken(capsys):
    assert archive.main([]) == 0, capsys.readouterr().out
