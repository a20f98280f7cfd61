"""What `recognize` does: single pictures, no memory between them, their hands to standard output and to files."""

import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from lightgesture.config.opening import make_debug_pictures, make_folder, open_pipeline
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import Progress, one_line
from lightgesture.errors import ExitStatus, InputError, UsageError
from lightgesture.features.types import Image
from lightgesture.fsm import Grammar
from lightgesture.records import FrameRecord
from lightgesture.results import describe_hands, open_writer, output_stems, to_json_line
from lightgesture.results.annotated_picture import annotate_picture, meaning, pair_of, to_png
from lightgesture.results.atomic import replacing
from lightgesture.results.ownership import is_ours
from lightgesture.sources import read_picture

RECORDS: Final = ".jsonl"
ANNOTATED: Final = "_annotated.png"


def recognize(inputs: Sequence[str], settings: DecodeSettings) -> ExitStatus:
    """Print the hands of every picture: one `frame` record each, or readable lines; with `out` also to files.

    A picture that cannot be read is told on standard error and the others go on. UsageError: the model, the grammar or
    a folder is wrong, or a file would replace one that is none of ours.
    """
    stems = output_stems(inputs)
    _check(inputs, stems, settings)
    debug = make_debug_pictures(settings, "")
    pipeline = open_pipeline(settings, None, debug)
    grammar = pipeline.decoder.grammar
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
            for line in _lines(record, settings.as_json, grammar):
                progress.print_line(line)
            if settings.out:
                _write(Path(settings.out) / stem, image, record, settings, grammar)
            progress.advance()
    return status


def _lines(record: FrameRecord, as_json: bool, grammar: Grammar) -> list[str]:
    if as_json:
        return [to_json_line(record, sys.stdout.encoding or "utf-8")]
    pair = pair_of(record.hands)
    word = [] if pair is None else [f"  {','.join(pair)}: {meaning(pair, grammar)}"]
    return [one_line(record.source or ""), *describe_hands(record), *word]


def _write(base: Path, image: Image, record: FrameRecord, settings: DecodeSettings, grammar: Grammar) -> None:
    """The files of one picture, each there whole or not at all; base: their path without what is put to it."""
    if settings.annotate != "no":
        drawn = annotate_picture(image, record, grammar, settings.annotate, settings.rotate)
        with replacing(Path(f"{base}{ANNOTATED}")) as temporary:
            temporary.write_bytes(to_png(drawn))
    with open_writer(f"{base}{RECORDS}", record.source or "") as writer:
        writer.write(record)


def _check(inputs: Sequence[str], stems: Sequence[str], settings: DecodeSettings) -> None:
    """UsageError: no folder for files, or one that holds what would be replaced."""
    if not settings.out:
        if settings.is_annotated:
            raise UsageError("--annotate: its files need a folder; name one with --out DIR")
        return
    make_folder(settings.out)
    suffixes = [RECORDS, *([ANNOTATED] if settings.is_annotated else [])]
    for path in (Path(settings.out) / f"{stem}{suffix}" for stem in stems for suffix in suffixes):
        is_input = path.exists() and any(
            os.path.exists(one) and os.path.samefile(path, one) for one in inputs
        )
        if is_input or (path.exists() and not is_ours(path)):
            raise UsageError(
                f"{path}: would be replaced and {'is an input' if is_input else 'is none of this program'}; name "
                "another folder with --out, or move the file"
            )
