"""What `export` does: nets, trees, machine, language and constants as flat files with test vectors."""

from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.actions.decode import SAMPLE
from lightgesture.errors import UsageError
from lightgesture.export.constants import constants
from lightgesture.export.files import FlatFiles, check_folder, write_folder
from lightgesture.export.language import export_language
from lightgesture.export.learned import cnn_constants, export_bank, export_svm, export_trees, second_constants
from lightgesture.export.nets import export_net
from lightgesture.features.find import cells
from lightgesture.features.find.candidates import PAIR_COLUMNS, PLACE_COLUMNS
from lightgesture.features.find.selector import find_hands
from lightgesture.features.find.selector_file import BANK_NUMBERS, SelectorError, load_classical, load_learned
from lightgesture.features.patch import PatchSettings, cut_patches
from lightgesture.fsm import GrammarError, load_grammar
from lightgesture.models import ModelError, load_classifier
from lightgesture.models.cnn import CnnClassifier
from lightgesture.models.cnn_file import larger_name
from lightgesture.models.svm import SvmClassifier
from lightgesture.sources import open_source

README: Final = Path(__file__).resolve().parents[1] / "data" / "export.md"
"""What is written into the folder as README.md."""
HANDS: Final = 8
"""Patches of the bundled clip that serve as test inputs of the classifiers."""
APART: Final = 10
"""Frames from one that is searched for them to the next."""


def export(folder: Path, model: str | None, grammar: str | None) -> int:
    """Write everything into `folder` and return the number of files.

    model: path of a model file, which stands in for the shipped one of its kind. grammar: path of a grammar file, None
    for the bundled one. UsageError: one of them is wrong, or the folder cannot be written or holds other files.
    """
    check_folder(folder)
    files = FlatFiles()
    try:
        _export_classifiers(files, model)
        _export_selector(files)
        export_language(files, load_grammar(grammar))
    except (ModelError, SelectorError, GrammarError) as error:
        raise UsageError(str(error)) from error
    files.add_json("constants.json", constants())
    files.add_file("README.md", README.read_bytes())
    every = files.all_files()
    write_folder(folder, every)
    return len(every)


def _export_classifiers(files: FlatFiles, model: str | None) -> None:
    classifiers: dict[type, Any] = {type(one): one for one in map(load_classifier, ("cnn", "svm"))}
    if model is not None:
        own = load_classifier(model)
        classifiers[type(own)] = own
    cnn, svm = classifiers[CnnClassifier], classifiers[SvmClassifier]
    hands = _find_sample_hands()
    patches = _cut(hands, cnn.model.patch)
    export_net(files, "cnn", cnn.model.network, cnn_constants(files, cnn.model, patches))
    if (second := cnn.model.second) is not None:
        for number, net in enumerate(second.nets):
            export_net(files, larger_name(number), net.network, second_constants(second, number))
    export_svm(files, svm, _cut(hands, svm.model.features.patch))


def _export_selector(files: FlatFiles) -> None:
    learned, classical = load_learned(), load_classical()
    export_net(files, "locator", learned.locator, {})
    export_net(files, "refiner", learned.refiner, {})
    if learned.verifier is not None:
        export_net(files, "verifier", learned.verifier, {})
    export_trees(
        files,
        {
            "places": (learned.places, PLACE_COLUMNS),
            "place_pairs": (learned.pairs, PAIR_COLUMNS),
            "glance": (classical.glance, cells.COLUMNS),
            "extents": (classical.regions, cells.COLUMNS + BANK_NUMBERS),
            "extent_pairs": (classical.pairs, PAIR_COLUMNS),
        },
    )
    export_bank(files, classical.bank)


def _find_sample_hands() -> list[tuple[NDArray[np.uint8], Any]]:
    """Pictures of the bundled clip and a hand of each."""
    found: list[tuple[NDArray[np.uint8], Any]] = []
    with open_source(str(SAMPLE)) as source:
        for number, frame in enumerate(source):
            if number % APART == 0:
                found += [(frame.image, hand) for hand in find_hands(frame.image)]
            if len(found) >= HANDS:
                break
    return found[:HANDS]


def _cut(hands: list[tuple[NDArray[np.uint8], Any]], settings: PatchSettings) -> NDArray[np.uint8]:
    """Patches of hands, uint8 (n, size, size, 3)."""
    return np.concatenate([cut_patches(image, [hand.box], [hand.side], settings) for image, hand in hands])
