"""From numbers and patches to tokens."""

from lightgesture.models.classes import CLASSES, NONE, check_classes
from lightgesture.models.errors import ModelError
from lightgesture.models.loading import Classifier, load_classifier

__all__ = [
    "CLASSES",
    "NONE",
    "Classifier",
    "ModelError",
    "check_classes",
    "load_classifier",
]
