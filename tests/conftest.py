"""What holds for every test."""

from hypothesis import settings

# A fifth of a second an example, as Hypothesis has it, says more of the machine than of the code: a board, an emulated
# one, or a core that others use is many times slower.
settings.register_profile("lightgesture", deadline=None)
settings.load_profile("lightgesture")
