"""How many threads the linear algebra may use while a command runs."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """One thread for matrix products inside the block, the old number after it.

    The classifier's products are tiny: a second thread gains nothing, and on a busy machine the waiting for it
    makes a frame ten times as slow. Only libraries that are loaded already are limited, so NumPy must be.
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        yield
