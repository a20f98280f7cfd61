"""Hands followed through the frames."""
