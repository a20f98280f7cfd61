"""The training of a second look alone: a model keeps its small net, and the larger one is learnt anew.

So a model that reads dry hands well learns to read those of a dive where it was in doubt, and nothing else of it
changes.
"""

import json
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Final

from lightgesture.errors import InputError, UsageError
from lightgesture.models import load_classifier
from lightgesture.models.cnn import CnnClassifier
from lightgesture.models.cnn_file import MOST_LARGER
from lightgesture.training.card import make_card
from lightgesture.training.model_files import write_cnn_model, write_json
from lightgesture.training.nets.checkpoints import need_torch, peak_memory_mib, sha256_of
from lightgesture.training.nets.cnn import CnnTraining, draw, net_settings
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.pool.kept_sources import held_out_hands
from lightgesture.training.pool.patch_kinds import MARGIN
from lightgesture.training.pool.samples import read_rows
from lightgesture.training.samples import in_order

EARLIER: Final = "trainings_of_the_other_larger_nets"
"""Key of a card."""


def train_look_to_file(
    training: CnnTraining,
    first: Path,
    out: Path,
    progress: Callable[[str], None],
    *,
    beside: bool = False,
) -> dict[str, Any]:
    """Train, write `out` and the card beside it (suffix .json), and return the card.

    training: its teachers' steps are those of the larger net. first: model file of a net. beside: the larger nets of
    that file stay, and the new one is asked with them. What is done lies in a folder beside `out`, as in
    `train_cnn_to_file`. Raises InputError, ModelError, UsageError.
    """
    need_torch()
    from lightgesture.training.nets.second_look import (
        answers_of_both,
        first_teacher,
        second_section,
        with_second_look,
    )

    known = load_classifier(first)
    # Before the pool is drawn, which takes minutes.
    classes = in_order(row.token for row in read_rows(training.data, training.without))
    if not isinstance(known, CnnClassifier) or known.classes != classes:
        raise UsageError(f"{first}: is no net of the classes {', '.join(classes)}; train one with train cnn")
    carried = carried_on(first, beside=beside)
    others = known.model.second.nets if beside and known.model.second is not None else ()
    if beside and not 1 <= len(others) < MOST_LARGER:
        raise UsageError(
            f"{first}: has {len(others)} larger nets; one can be added to 1 to {MOST_LARGER - 1}"
        )
    drawn = draw(training, out, progress, first=sha256_of(first))
    progress = drawn.spent.kept_by(progress)
    samples = HandSamples(drawn.pool, drawn.learnt_from, drawn.classes, MARGIN)
    how = replace(net_settings(training), steps=training.teacher_steps)
    larger = first_teacher(samples, how, training.seed, drawn.folder, progress)
    hands = held_out_hands(known.model, drawn.originals, drawn.pool, drawn.kept)
    model = with_second_look(known.model, larger, hands, others)
    card = {
        "name": "cnn",
        "what": "hand patch to token: a small net that was trained before, and larger ones for what it doubts",
        **carried,
        **make_card(
            drawn.rows,
            drawn.originals,
            drawn.pool,
            training.without,
            answers_of_both(model, hands),
            drawn.classes,
        ),
        "training": {
            "seed": training.seed,
            "steps": {"larger_net": training.teacher_steps},
            "settings": {"pool": asdict(training.pool), "net": asdict(how)},
            "seconds": drawn.spent.whole_seconds,
            "peak_memory_mib": peak_memory_mib(),
        },
        "model": {"temperature": model.temperature, "second_look": second_section(model)},
    }
    write_cnn_model(model, out)
    write_json(card, out.with_suffix(".json"))
    return card


def carried_on(first: Path, *, beside: bool) -> dict[str, Any]:
    """What a new card takes from the one beside a model's file: of its small net, whatever second look that has, and
    with `beside` the trainings of the larger nets that stay, the first's first. Raises InputError."""
    try:
        card = json.loads(first.with_suffix(".json").read_text(encoding="utf-8"))
        if "small_net" in card:
            small_net = dict(card["small_net"])
        else:
            known = {name: card["data"][name] for name in ("pictures", "sources", "licences")}
            small_net = {"of_the_file_with_sha256": sha256_of(first), "trained_on": known}
        larger = {EARLIER: [*card.get(EARLIER, []), card["training"]]} if beside else {}
        return {"small_net": small_net, **larger}
    except OSError as error:
        reason = error.strerror or "not readable"
    except (ValueError, KeyError, TypeError) as error:
        reason = f"no card of a classifier ({error})"
    raise InputError(f"{first.with_suffix('.json')}: {reason}; a model needs its card to go on from")
