"""From a manifest to a hand net and its card: the training of the CNN from end to end."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lightgesture._version import __version__
from lightgesture.console import warn
from lightgesture.features.outline.contours import contour_length
from lightgesture.models.cnn import CnnClassifier, CnnModel
from lightgesture.training.card import held_out_section, make_card
from lightgesture.training.model_files import write_cnn_model, write_json
from lightgesture.training.nets.checkpoints import checkpoint_folder, need_torch, peak_memory_mib
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.nets.spent_time import SpentTime
from lightgesture.training.pool.kept_hands import kept_out
from lightgesture.training.pool.kept_sources import (
    LEAST_FITTED,
    held_out_hands,
)
from lightgesture.training.pool.originals import Originals, PoolSettings, read_originals
from lightgesture.training.pool.patch_kinds import CONTOUR, MARGIN, PATCH, SMALLEST_HAND
from lightgesture.training.pool.patch_pool import PatchPool, make_pool, rows_without
from lightgesture.training.pool.samples import HandRow, read_rows, rows_digest
from lightgesture.training.samples import in_order
from lightgesture.training.temperature import fit_temperature
from lightgesture.training.time_left import tenths

if TYPE_CHECKING:
    from lightgesture.training.nets.hand_net import LearntNet, NetSettings
    from lightgesture.training.nets.net_training import Precision

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class CnnTraining:
    """What is trained from what."""

    data: Path
    """Manifest, or folder with a folder a class."""
    backgrounds: tuple[Path, ...] = ()
    """Folders of pictures without hands."""
    scenes: Path | None = None
    """Table of whole pictures with boxes of hands and faces."""
    divers: Path | None = None
    """Table of pictures of real divers with their hands, see `pool.divers`."""
    without: tuple[str, ...] = ()
    """Sources of `data` and dives of `divers` that are left out."""
    seed: int = 0
    """Of everything drawn."""
    jobs: int = 1
    """Processes that draw patches, and larger nets that learn at a time."""
    size: str = "medium"
    """Of the net, "small", "medium" or "large"; a larger one reads better and takes longer."""
    contours: bool = False
    """Whether it looks at the outline's numbers, too."""
    steps: int = 60000
    """Of the optimiser."""
    teachers: int = 2
    """Larger nets that it learns from, 0 to learn from the labels."""
    teacher_steps: int = 4000
    """Of each of these."""
    precision: "Precision" = "float32"
    """In which nets are reckoned while they learn, see `net_training.PRECISIONS`."""
    landmarks: float = 0.0
    """Weight of a hand's landmarks, which all nets learn besides where they are known, 0 to 10; 0: they learn none.
    At 0.3 they read hands from the side better, and are surer of what they read wrongly (docs/models.md)."""
    pool: PoolSettings = field(default_factory=PoolSettings)
    """What is drawn."""


def train_cnn_to_file(training: CnnTraining, out: Path, progress: Progress) -> dict[str, Any]:
    """Train, write `out` and the card beside it (suffix .json), and return the card.

    What is done already lies in a folder beside `out` and is used when the same command runs again; it may be removed
    when the files are written. Raises InputError for unreadable data, UsageError without torch and for classes that
    will not do.
    """
    need_torch()
    import torch

    from lightgesture.training.nets.architectures import multiply_adds
    from lightgesture.training.nets.second_look import (
        answers_of_both,
        first_teacher,
        second_section,
        with_second_look,
    )

    drawn = draw(training, out, progress)
    progress = drawn.spent.kept_by(progress)
    rows, originals, pool, kept, classes = drawn.rows, drawn.originals, drawn.pool, drawn.kept, drawn.classes
    learnt = learn(pool, drawn.learnt_from, classes, training, drawn.folder, progress)
    model = in_integers(learnt, training)
    hands = held_out_hands(model, originals, pool, kept)
    answers = hands.answered(CnnClassifier(model).scores(hands.patches))
    if len(answers.truth) >= LEAST_FITTED:
        model = replace(model, temperature=fit_temperature(answers.probabilities, answers.truth))
    if training.teachers:
        how = replace(net_settings(training), steps=training.teacher_steps)
        second = first_teacher(learnt.samples, how, training.seed, drawn.folder, progress)
        model = with_second_look(model, second, hands)
    held_out = answers_of_both(model, hands)
    in_floats = hands.answered(learnt.scores(hands.patches, CONTOUR))
    card = {
        "name": "cnn",
        "what": "hand patch to token: a net of eight convolutions and one dense layer, 8-bit integers",
        **make_card(rows, originals, pool, training.without, held_out, classes),
        "training": {
            "seed": training.seed,
            "steps": {"net": training.steps, "each_teacher": training.teacher_steps},
            "teachers": training.teachers,
            "settings": {"pool": asdict(training.pool), "net": asdict(net_settings(training))},
            "torch": str(torch.__version__),
            "seconds": drawn.spent.whole_seconds,
            "peak_memory_mib": peak_memory_mib(),
        },
        "model": {
            "weights": int(sum(own.weights.size + own.biases.size for own in model.network.weights.values())),
            "multiply_adds": multiply_adds(model.network.inputs, model.network.nodes),
            "looks_at_the_outline": model.contour is not None,
            "temperature": model.temperature,
            "second_look": second_section(model),
            "held_out_accuracy_in_floating_point": held_out_section(rows, in_floats, classes)["accuracy"],
        },
    }
    write_cnn_model(model, out)
    write_json(card, out.with_suffix(".json"))
    return card


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """What a training learns from. folder: of its parts. kept: bool (n,), hands that are kept from the nets.
    spent: its time so far."""

    rows: Sequence[HandRow]
    originals: Originals
    pool: PatchPool
    kept: NDArray[np.bool_]
    folder: Path
    spent: SpentTime

    @property
    def classes(self) -> tuple[str, ...]:
        """Of the hands, in their usual order."""
        return in_order(row.token for row in self.rows)

    @property
    def learnt_from(self) -> NDArray[np.bool_]:
        """Rows of the pool that nets see, bool."""
        sources = np.array([hand.source for hand in self.originals.hands])
        return rows_without(self.pool, sources, self.kept)


def draw(training: CnnTraining, out: Path, progress: Progress, **more: str) -> Drawn:
    """Read the hands and draw the pool, or take what lies in the folder beside `out`.

    more: what else tells this training from others. Raises InputError, UsageError.
    """
    rows = read_rows(training.data, training.without)
    request = {
        "training": repr(replace(training, jobs=1)),
        "rows": rows_digest(rows),
        "version": __version__,
        **more,
    }
    folder = checkpoint_folder(out, request)
    spent = SpentTime(folder)
    progress = spent.kept_by(progress)
    progress(f"reading {len(rows)} hands")
    originals = read_originals(rows, training.backgrounds, training.scenes, training.divers, training.without)
    pool = make_pool(originals, training.pool, training.seed, training.jobs, folder, tenths(progress))
    if training.landmarks and pool.landmarks is None:
        warn(
            f"{folder}: its patches were drawn without landmarks, and the nets learn without them; "
            "draw them anew with another --out"
        )
    return Drawn(rows, originals, pool, kept_out(originals.hands), folder, spent)


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
    from lightgesture.training.nets.hand_net import (
        LearntNet,
        OutlineScale,
        make_net,
        tells_landmarks,
        train_hand_net,
    )
    from lightgesture.training.nets.teachers import teach

    settings, seed = net_settings(training), training.seed
    samples = HandSamples(pool, chosen, classes, MARGIN)
    if training.teachers:
        how = replace(settings, steps=training.teacher_steps)
        answers = teach(samples, training.teachers, how, seed, training.jobs, folder, progress)
        samples = samples.with_answers(answers)
    length = contour_length(CONTOUR) if training.contours else 0
    outlines = pool.contours[chosen, :length].astype(np.float32)
    scale = OutlineScale(outlines.mean(axis=0), outlines.std(axis=0) + np.float32(1e-3))
    nodes, tells = hand_nodes(len(classes), length, training.size), tells_landmarks(samples, settings)
    net = make_net(nodes, PATCH.size, length, seed, landmarks=tells)
    net = train_hand_net(net, samples, scale, settings, seed, folder / "hand.pt", progress)
    return LearntNet(net, samples, scale)


def in_integers(learnt: "LearntNet", training: CnnTraining) -> CnnModel:
    """The same net in integers, its temperature not yet fitted."""
    from lightgesture.training.nets.hand_net import to_integers

    network = to_integers(learnt.net, learnt.samples, learnt.scale, net_settings(training), training.seed)
    return CnnModel(
        classes=learnt.samples.classes,
        patch=PATCH,
        network=network,
        temperature=1.0,
        smallest_hand=SMALLEST_HAND,
        contour=CONTOUR if training.contours else None,
        contour_mean=learnt.scale.mean,
        contour_deviation=learnt.scale.deviation,
    )


def net_settings(training: CnnTraining) -> "NetSettings":
    """Those of the optimiser."""
    from lightgesture.training.nets.hand_net import NetSettings

    return NetSettings(training.steps, training.precision, training.landmarks)
