"""Results out: record files, annotated videos, timelines, lines for people, pictures of the stages."""

from lightgesture.results.annotated import AnnotatedVideo, open_annotated_video
from lightgesture.results.debug import DebugPictures
from lightgesture.results.stems import output_stems
from lightgesture.results.text import TextPrinter, describe, describe_hands
from lightgesture.results.timeline import open_plot
from lightgesture.results.writers import WRITERS, JsonPrinter, Writer, open_writer, to_json_line

__all__ = [
    "WRITERS",
    "AnnotatedVideo",
    "DebugPictures",
    "JsonPrinter",
    "TextPrinter",
    "Writer",
    "describe",
    "describe_hands",
    "open_annotated_video",
    "open_plot",
    "open_writer",
    "output_stems",
    "to_json_line",
]
