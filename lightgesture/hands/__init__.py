"""The hand reader: find, track, read."""
