"""Tracks of moved tags to the names of the shapes that they draw."""
