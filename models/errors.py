"""What goes wrong with a model."""


class ModelError(ValueError):
    """A model cannot be used or trained: one line that names the input, the reason and the remedy."""
