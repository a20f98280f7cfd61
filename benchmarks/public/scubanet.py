"""SCUBANet (York University): a Pascal VOC file a picture, with boxes of Diver, Head and Hand, and no shapes.

The pictures are looked for by the name that stands in the file, and by the file's own, below the folder. XML comes from
strangers: it is read with a bound on its size, and one that declares a document type, and with it entities, is refused.
"""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from pathlib import Path, PureWindowsPath
from typing import Final
from xml.parsers import expat

from lightgesture.benchmarks.divers.pictures import DiverFrame, DiverHand
from lightgesture.errors import InputError
from lightgesture.features.types import Box
from lightgesture.sources import is_picture_name
from lightgesture.training.datasets import grow_box

LARGEST: Final = 1_000_000
"""Bytes of a file of labels; a picture with a hundred boxes has 30,000."""
KINDS: Final = ("diver", "head", "hand")
CORNERS: Final = ("xmin", "ymin", "xmax", "ymax")
REMEDY: Final = "restore the file or take it away"


@dataclass(slots=True)
class VocLabels:
    """What a Pascal VOC file says. filename: of the picture, "" where it does not say. objects: name and corners."""

    filename: str = ""
    objects: list[tuple[str, tuple[float, float, float, float]]] = field(default_factory=list)


def read_scubanet(folder: Path) -> list[DiverFrame]:
    """A frame for each XML file below the folder, by path; the place is the folder that its picture lies in.

    InputError: there are none, or one is damaged.
    """
    files = sorted(folder.rglob("*.xml"))
    if not files:
        raise InputError(f"{folder}: holds no Pascal VOC files (*.xml); name the folder of SCUBANet")
    pictures: dict[str, list[Path]] = defaultdict(list)
    for path in sorted(folder.rglob("*")):
        if is_picture_name(path):
            pictures[path.name].append(path)
            pictures[path.stem].append(path)
    return [_frame(folder, file, pictures) for file in files]


def _frame(folder: Path, file: Path, pictures: Mapping[str, list[Path]]) -> DiverFrame:
    labels = read_voc(file)
    boxes: dict[str, list[Box]] = defaultdict(list)
    for name, corners in labels.objects:
        boxes[name.lower()].append(grow_box(*corners, 0.0))
    path = _picture(file, labels.filename, pictures)
    place = path.parent.relative_to(folder).as_posix()
    return DiverFrame(
        path=path,
        file=path.relative_to(folder).as_posix(),
        place=place,
        dive=place,
        hands=tuple(DiverHand(box) for box in boxes["hand"]),
        heads=tuple(boxes["head"]),
        bodies=tuple(boxes["diver"]),
    )


def _picture(file: Path, named: str, pictures: Mapping[str, list[Path]]) -> Path:
    """The picture of a file of labels: of several of its name the one that has most folders in common with it."""
    name = PureWindowsPath(named).name
    found = pictures.get(name) or pictures.get(file.stem) or [file.with_name(name or f"{file.stem}.jpg")]
    return max(found, key=lambda path: sum(a == b for a, b in zip(path.parts, file.parts, strict=False)))


def read_voc(file: Path) -> VocLabels:
    """The boxes of a Pascal VOC file. InputError: it is none, is too large, or declares a document type."""
    try:
        if file.stat().st_size > LARGEST:
            raise InputError(
                f"{file}: has more than {LARGEST} bytes, which no picture's labels need; {REMEDY}"
            )
        content = file.read_bytes()
    except OSError as error:
        raise InputError(f"{file}: cannot be read ({error.strerror}); {REMEDY}") from None
    reader = _VocReader(file)
    try:
        reader.parser.Parse(content, True)
        return reader.finish()
    except expat.ExpatError as error:
        raise InputError(f"{file}: is no XML ({error}); {REMEDY}") from None


class _VocReader:
    """Collects the text of the elements that matter, by their place below `annotation`."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._path: list[str] = []
        self._text: list[str] = []
        self._object: dict[str, str] = {}
        self._labels = VocLabels()
        self.parser = expat.ParserCreate()
        self.parser.StartDoctypeDeclHandler = self._refuse
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text.append

    def _refuse(self, *_declared: object) -> None:
        raise InputError(f"{self._file}: declares a document type, which labels have no need of; {REMEDY}")

    def _start(self, name: str, _attributes: object) -> None:
        self._path.append(name)
        self._text.clear()

    def _end(self, name: str) -> None:
        text = "".join(self._text).strip()
        self._text.clear()
        match self._path[1:]:
            case ["filename"]:
                self._labels.filename = text
            case ["object", "name"] | ["object", "bndbox", _]:
                self._object[name] = text
            case ["object"]:
                self._labels.objects.append(self._boxed())
                self._object = {}
            case _:
                pass
        self._path.pop()

    def _boxed(self) -> tuple[str, tuple[float, float, float, float]]:
        try:
            x0, y0, x1, y1 = (float(self._object[corner]) for corner in CORNERS)
            if 0 < x1 - x0 < inf and 0 < y1 - y0 < inf:
                return self._object["name"], (x0, y0, x1, y1)
        except (KeyError, ValueError):
            pass
        raise InputError(f"{self._file}: an object has no name or no box; {REMEDY}")

    def finish(self) -> VocLabels:
        """What was read."""
        return self._labels
