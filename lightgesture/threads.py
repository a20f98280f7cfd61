"""How many threads the linear algebra behind NumPy may use while a frame is processed."""

from contextlib import AbstractContextManager


class OneBlasThread:
    """Makes blocks in which matrix products run in one thread; after a block the old number holds again.

    The classifier's products are tiny: a second thread gains nothing, and where other work keeps the cores busy, the
    waiting for it makes a frame ten times as slow. A block costs about 20 microseconds. Only libraries that are
    loaded when the object is made are limited, so NumPy must be.
    """

    def __init__(self) -> None:
        from threadpoolctl import ThreadpoolController

        self._libraries = ThreadpoolController().select(user_api="blas")

    def block(self) -> AbstractContextManager[object]:
        """A context with one thread."""
        limited: AbstractContextManager[object] = self._libraries.limit(limits=1)
        return limited
