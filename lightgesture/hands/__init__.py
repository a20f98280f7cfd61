"""The hand reader: find, track, read."""

from lightgesture.hands.front import Finder, Follower, HandReader, Reader
from lightgesture.hands.reading import ReadingSettings, ReadingStage

__all__ = ["Finder", "Follower", "HandReader", "Reader", "ReadingSettings", "ReadingStage"]
