"""The nets of a selector among the parts of its training."""

import numpy as np

from lightgesture.features.find.selector_file import load_learned
from lightgesture.training.model_files import write_networks
from lightgesture.training.regions.nets import LOCATOR, NETS, REFINER, RegionTraining, learn_nets
from lightgesture.training.regions.region_pictures import Material


def test_nets_that_lie_in_their_folder_are_not_trained_again(tmp_path):
    parts = load_learned()
    write_networks({LOCATOR: parts.locator, REFINER: parts.refiner}, tmp_path / NETS)
    locator, refiner = learn_nets(Material([], [], [], []), [], tmp_path, 0, RegionTraining(), lambda _: None)
    assert (locator.nodes, refiner.nodes) == (parts.locator.nodes, parts.refiner.nodes)
    assert all(
        np.array_equal(own.weights, parts.locator.weights[name].weights)
        for name, own in locator.weights.items()
    )
