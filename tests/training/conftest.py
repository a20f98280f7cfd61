from collections.abc import Iterator

import pytest
from threadpoolctl import threadpool_limits


@pytest.fixture(autouse=True, scope="module")
def _one_thread() -> Iterator[None]:
    """Trainings as small as these are quicker on one thread, and much quicker where others use the cores."""
    with threadpool_limits(1):
        yield
