"""Results out: record files, lines for people, pictures of the stages.

Annotated videos (`annotated`) and timelines (`timeline`) are imported by who writes them, so that others start sooner.
"""

from lightgesture.results.debug import DebugPictures
from lightgesture.results.stems import output_stems
from lightgesture.results.text import TextPrinter, describe, describe_hands
from lightgesture.results.writers import WRITERS, JsonPrinter, Writer, open_writer, to_json_line

__all__ = [
    "WRITERS",
    "DebugPictures",
    "JsonPrinter",
    "TextPrinter",
    "Writer",
    "describe",
    "describe_hands",
    "open_writer",
    "output_stems",
    "to_json_line",
]
