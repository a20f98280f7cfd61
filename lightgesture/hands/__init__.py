"""The hand reader: find, track, read."""

from lightgesture.hands.front import Finder, HandReader
from lightgesture.hands.reading import ReadingSettings, ReadingStage

__all__ = ["Finder", "HandReader", "ReadingSettings", "ReadingStage"]
