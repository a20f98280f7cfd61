"""Names of output files, one for each input, none used twice."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path


def output_stems(inputs: Sequence[str]) -> list[str]:
    """A stem for the output files of each input, in the same order.

    It is the input's own stem (a folder's whole name). Stems that occur twice, capitals aside, get folder
    and suffix: `a/dive.mp4` and `b/dive.mp4` become `a_dive.mp4` and `b_dive.mp4`; where that does not
    tell them apart, more folders, and where nothing does, a number.
    """
    paths = [Path(name).absolute() for name in inputs]
    stems = [_short(path) for path in paths]
    depth = max((len(path.parts) for path in paths), default=0)
    for parts in range(2, depth + 1):
        twice = _repeated(stems)
        if not twice:
            break
        stems = [
            _long(path, parts) if stem.casefold() in twice else stem
            for path, stem in zip(paths, stems, strict=True)
        ]
    return _numbered(stems)


def _short(path: Path) -> str:
    # resolve() only for names such as "." and "..", which name their folder by another one
    name = path.name if path.name not in ("", "..") else path.resolve().name
    return (name if path.is_dir() else Path(name).stem) or "input"


def _long(path: Path, parts: int) -> str:
    return "_".join(part.strip("/\\:") for part in path.parts[-parts:])


def _repeated(stems: Sequence[str]) -> set[str]:
    counts = Counter(stem.casefold() for stem in stems)
    return {stem for stem, count in counts.items() if count > 1}


def _numbered(stems: Sequence[str]) -> list[str]:
    used: set[str] = set()
    result = []
    for stem in stems:
        name, number = stem, 1
        while name.casefold() in used:
            number += 1
            name = f"{stem}-{number}"
        used.add(name.casefold())
        result.append(name)
    return result
