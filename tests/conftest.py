"""What holds for every test."""

import pytest
from hypothesis import settings

from lightgesture.console import messages_shown

# A fifth of a second an example, as Hypothesis has it, says more of the machine than of the code: a board, an emulated
# one, or a core that others use is many times slower.
settings.register_profile("lightgesture", deadline=None)
settings.load_profile("lightgesture")


@pytest.fixture(autouse=True)
def _messages():
    """Messages stand on standard error, as on the command line."""
    with messages_shown():
        yield
