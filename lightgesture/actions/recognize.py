"""What `recognize` does: single pictures, no memory between them, their hands to standard output."""

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from lightgesture.config.opening import make_debug_pictures, open_pipeline
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import Progress, one_line
from lightgesture.errors import ExitStatus, InputError
from lightgesture.records import FrameRecord
from lightgesture.results import describe_hands, output_stems, to_json_line
from lightgesture.sources import read_picture


def recognize(inputs: Sequence[str], settings: DecodeSettings) -> ExitStatus:
    """Print the hands of every picture: one `frame` record each, or readable lines.

    A picture that cannot be read is told on standard error and the others go on. UsageError: the model or
    the folder of debug pictures is wrong.
    """
    stems = output_stems(inputs)
    debug = make_debug_pictures(settings, "")
    pipeline = open_pipeline(settings, None, debug)
    status = ExitStatus.OK
    with Progress("recognize", len(inputs), "picture", settings.quiet) as progress:
        for name, stem in zip(inputs, stems, strict=True):
            try:
                image = read_picture(name)
            except InputError as error:
                progress.fail(str(error))
                status = ExitStatus.SOME_FAILED
                continue
            if debug is not None:
                debug.start(Path(settings.debug_dir or "") / stem)
            record = replace(pipeline.recognize(image), source=name)
            for line in _lines(record, settings.as_json):
                progress.print_line(line)
            progress.advance()
    return status


def _lines(record: FrameRecord, as_json: bool) -> list[str]:
    if as_json:
        return [to_json_line(record, sys.stdout.encoding or "utf-8")]
    return [one_line(record.source or ""), *describe_hands(record)]
