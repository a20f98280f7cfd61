"""Practice: sentences to sign before a camera, what was read of them, and how long each sign took."""
