"""Hands read in given boxes."""
