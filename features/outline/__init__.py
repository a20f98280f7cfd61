"""Outlines of hands and their numbers."""
