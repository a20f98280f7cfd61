"""Samples and pools of them, by source."""
