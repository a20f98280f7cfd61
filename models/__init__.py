"""From numbers and patches to tokens."""

from lightgesture.models.errors import ModelError
from lightgesture.models.loading import Classifier, load_classifier
from lightgesture.models.samples import CLASSES, NONE, TrainingSample

__all__ = ["CLASSES", "NONE", "Classifier", "ModelError", "TrainingSample", "load_classifier"]
