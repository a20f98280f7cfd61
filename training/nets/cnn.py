"""From a manifest to a hand net and its card: the training of the CNN from end to end."""

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lightgesture._version import __version__
from lightgesture.features.outline.contours import contour_length
from lightgesture.models import CLASSES
from lightgesture.models.calibration import fit_temperature, softmax
from lightgesture.models.cnn import CnnClassifier, CnnModel
from lightgesture.training.card import LIMITS, data_section, held_out_section, operating_points
from lightgesture.training.model_files import write_cnn_model, write_json
from lightgesture.training.nets.checkpoints import checkpoint_folder, need_torch, peak_memory_mib
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.pool.kept_sources import held_out_hands, keeps_whole_sources, kept_out
from lightgesture.training.pool.originals import read_originals
from lightgesture.training.pool.patch_kinds import Originals, PoolSettings
from lightgesture.training.pool.patch_pool import PatchPool, make_pool, rows_without
from lightgesture.training.pool.samples import HandRow, read_rows
from lightgesture.training.svm.machine import HeldOut
from lightgesture.training.time_left import tenths

if TYPE_CHECKING:
    from lightgesture.training.nets.hand_net import LearntNet, NetSettings
    from lightgesture.training.nets.net_training import Precision

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class CnnTraining:
    """What is trained from what.

    data: manifest, or folder with a folder a class. backgrounds: folders of pictures without hands. scenes: table of
    whole pictures with boxes of hands and faces, or None. without: sources of `data` that are left out. seed: of
    everything drawn. jobs: processes that draw patches.
    size: of the net, "small", "medium" or "large". contours: whether it looks at the outline's numbers, too.
    steps: of the optimiser. teachers: number of larger nets that it learns from, too, 0 for none. teacher_steps: of
    each of these. precision: in which nets are reckoned while they learn, see `net_training.PRECISIONS`.
    one_in: of so many hands, one is kept from the net, for the temperature and the scores of the card; see
    `kept_sources.kept_out`.
    smallest_hand: longer side of the smallest box that is read, pixels. pool: what is drawn.
    """

    data: Path
    backgrounds: tuple[Path, ...] = ()
    scenes: Path | None = None
    without: tuple[str, ...] = ()
    seed: int = 0
    jobs: int = 1
    size: str = "medium"
    contours: bool = False
    steps: int = 60000
    teachers: int = 2
    teacher_steps: int = 4000
    precision: "Precision" = "float32"
    one_in: int = 12
    smallest_hand: int = 12
    pool: PoolSettings = field(default_factory=PoolSettings)


def train_cnn_to_file(training: CnnTraining, out: Path, progress: Progress) -> dict[str, Any]:
    """Train, write `out` and the card beside it (suffix .json), and return the card.

    What is done already lies in a folder beside `out` and is used when the same command runs again; it may be removed
    when the files are written. Raises InputError for unreadable data, UsageError without torch.
    """
    need_torch()
    started = time.monotonic()
    rows = [row for row in read_rows(training.data) if row.source not in training.without]
    request = {"training": repr(replace(training, jobs=1)), "rows": len(rows), "version": __version__}
    folder = checkpoint_folder(out, request)
    progress(f"reading {len(rows)} hands")
    originals = read_originals(training, rows)
    pool = make_pool(originals, training.pool, training.seed, training.jobs, folder, tenths(progress))
    kept = kept_out(originals.hands, training.one_in)
    present = {row.token for row in rows}
    classes = tuple(name for name in CLASSES if name in present)
    sources = np.array([hand.source for hand in originals.hands])
    learnt = learn(pool, rows_without(pool, sources, kept), classes, training, folder, progress)
    model = in_integers(learnt, training)
    hands = held_out_hands(model, originals, pool, kept)
    held_out = hands.answered(CnnClassifier(model).scores(hands.patches))
    model = replace(model, temperature=fit_temperature(held_out.probabilities, held_out.truth))
    calibrated = replace(held_out, probabilities=softmax(held_out.probabilities, model.temperature))
    card = make_card(training, rows, originals, kept, model, calibrated)
    in_floats = hands.answered(learnt.scores(hands.patches, training.pool.contour))
    card["model"]["held_out_accuracy_in_floating_point"] = held_out_section(in_floats, classes)["accuracy"]
    card["training"]["seconds"] = round(time.monotonic() - started)
    card["training"]["peak_memory_mib"] = peak_memory_mib()
    write_cnn_model(model, out)
    write_json(card, out.with_suffix(".json"))
    return card


def learn(
    pool: PatchPool,
    chosen: NDArray[np.bool_],
    classes: tuple[str, ...],
    training: CnnTraining,
    folder: Path,
    progress: Progress,
) -> "LearntNet":
    """A net trained on the chosen rows of the pool, in floating point."""
    from lightgesture.training.nets.architectures import hand_nodes
    from lightgesture.training.nets.hand_net import LearntNet, OutlineScale, make_net, train_hand_net
    from lightgesture.training.nets.teachers import teach

    settings, seed = net_settings(training), training.seed
    samples = HandSamples(pool, chosen, classes, training.pool.margin)
    if training.teachers:
        how = replace(settings, steps=training.teacher_steps)
        answers = teach(samples, training.teachers, how, seed, training.jobs, folder, progress)
        samples = samples.with_answers(answers)
    length = contour_length(training.pool.contour) if training.contours else 0
    outlines = pool.contours[chosen, :length].astype(np.float32)
    scale = OutlineScale(outlines.mean(axis=0), outlines.std(axis=0) + np.float32(1e-3))
    net = make_net(hand_nodes(len(classes), length, training.size), training.pool.patch.size, length, seed)
    net = train_hand_net(net, samples, scale, settings, seed, folder / "hand.pt", progress)
    return LearntNet(net, samples, scale)


def in_integers(learnt: "LearntNet", training: CnnTraining) -> CnnModel:
    """The same net in integers, its temperature not yet fitted."""
    from lightgesture.training.nets.hand_net import to_integers

    network = to_integers(learnt.net, learnt.samples, learnt.scale, net_settings(training), training.seed)
    return CnnModel(
        classes=learnt.samples.classes,
        patch=training.pool.patch,
        network=network,
        temperature=1.0,
        smallest_hand=training.smallest_hand,
        contour=training.pool.contour if training.contours else None,
        contour_mean=learnt.scale.mean,
        contour_deviation=learnt.scale.deviation,
    )


def net_settings(training: CnnTraining) -> "NetSettings":
    """Those of the optimiser."""
    from lightgesture.training.nets.hand_net import NetSettings

    return NetSettings(training.steps, training.precision)


def make_card(
    training: CnnTraining,
    rows: Sequence[HandRow],
    originals: Originals,
    kept: NDArray[np.bool_],
    model: CnnModel,
    held_out: HeldOut,
) -> dict[str, Any]:
    """The card of a trained net, ready for JSON. kept: hands that were kept from it, bool (n,)."""
    import torch

    from lightgesture.training.nets.architectures import multiply_adds

    whole = "whole sources" if keeps_whole_sources(originals.hands, kept) else "of every source some"
    return {
        "name": "cnn",
        "version": __version__,
        "what": "hand patch to token: a net of eight convolutions and one dense layer, 8-bit integers",
        "classes": list(model.classes),
        "use": "bare hands of a diver facing the camera, in boxes of lightgesture's selector",
        "limits": list(LIMITS),
        "data": data_section(rows, originals, training.without, training.pool.rendered),
        "training": {
            "seed": training.seed,
            "steps": {"net": training.steps, "each_teacher": training.teacher_steps},
            "teachers": training.teachers,
            "settings": {"pool": asdict(training.pool), "net": asdict(net_settings(training))},
            "kept_from_the_net": f"one hand in {training.one_in}, {whole}, for the temperature and the scores below",
            "torch": str(torch.__version__),
        },
        "model": {
            "weights": int(sum(own.weights.size + own.biases.size for own in model.network.weights.values())),
            "multiply_adds": multiply_adds(model.network.inputs, model.network.nodes),
            "looks_at_the_outline": model.contour is not None,
            "temperature": model.temperature,
        },
        "held_out_sources": held_out_section(held_out, model.classes),
        "operating_points": operating_points(held_out, model.classes),
    }
