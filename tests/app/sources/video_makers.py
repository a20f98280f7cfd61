"""What the tests of videos share."""

from lightgesture.sources import SourceOptions, open_source

from .conftest import RATE


def read(path, **options):
    with open_source(path, SourceOptions(**options)) as source:
        return list(source)


def times(frames):
    return [round(frame.time_s * RATE, 1) for frame in frames]
