"""From numbers and patches to tokens."""

from lightgesture.models.errors import ModelError
from lightgesture.models.loading import Classifier, load_classifier
from lightgesture.models.samples import CLASSES, NONE, TrainingSample, check_classes, in_order

__all__ = [
    "CLASSES",
    "NONE",
    "Classifier",
    "ModelError",
    "TrainingSample",
    "check_classes",
    "in_order",
    "load_classifier",
]
