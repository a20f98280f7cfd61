"""Names of output files, one for each input, none used twice."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Final

DIVES: Final = "dives"
"""Of the table over all inputs; no input has it."""


def output_stems(inputs: Sequence[str]) -> list[str]:
    """A stem for the output files of each input, in the same order.

    It is the input's own stem (a folder's whole name). Stems that occur twice, or are the one that is taken
    (`dives`), capitals aside, get folder and suffix: `a/dive.mp4` and `b/dive.mp4` become `a_dive.mp4` and
    `b_dive.mp4`; where that does not tell them apart, more folders, and where nothing does, a number.
    """
    paths = [Path(name).absolute() for name in inputs]
    stems = [_short(path) for path in paths]
    depths = [1] * len(paths)
    while places := [place for place in _repeated(stems) if depths[place] < len(paths[place].parts)]:
        for place in places:
            depths[place] += 1
            stems[place] = _long(paths[place], depths[place])
    return _numbered(stems)


def _short(path: Path) -> str:
    # resolve() only for names such as "." and "..", which name their folder by another one
    name = path.name if path.name not in ("", "..") else path.resolve().name
    return (name if path.is_dir() else Path(name).stem) or "input"


def _long(path: Path, depth: int) -> str:
    parts = (part.strip("/\\:") for part in path.parts[-depth:])
    return "_".join(part for part in parts if part)


def _repeated(stems: Sequence[str]) -> list[int]:
    counts = Counter([DIVES, *(stem.casefold() for stem in stems)])
    return [place for place, stem in enumerate(stems) if counts[stem.casefold()] > 1]


def _numbered(stems: Sequence[str]) -> list[str]:
    used = {DIVES}
    result = []
    for stem in stems:
        name, number = stem, 1
        while name.casefold() in used:
            number += 1
            name = f"{stem}-{number}"
        used.add(name.casefold())
        result.append(name)
    return result
