"""The model-based detectors of the yaw rate: their recipes remake their numbers, and they say what they lack."""

import numpy as np
import pytest
import yaml

from fddbench import gallery, kinds
from fddbench.benchmarks.jet_engine import JetEngine
from fddbench.design.recipe import cook
from fddbench.errors import DesignError
from fddbench.interfaces import Bus

DESIGNS = ("kalman_gust", "observer_bank")


def numbers(nest):
    """All numbers of a design, in the order of the file."""
    if isinstance(nest, dict):
        return [x for value in nest.values() for x in numbers(value)]
    return [x for value in nest for x in numbers(value)] if isinstance(nest, (list, tuple)) else [nest]


@pytest.mark.parametrize("name", DESIGNS)
def test_its_recipe_remakes_it(name):
    path = gallery.folder("detectors") / f"{name}.yaml"
    np.testing.assert_allclose(
        numbers(cook(path).gains), numbers(yaml.safe_load(path.read_text())["gains"]), rtol=1e-6, atol=1e-9
    )


@pytest.mark.parametrize("name", DESIGNS)
def test_it_says_what_a_benchmark_lacks(name):
    data = yaml.safe_load((gallery.folder("detectors") / f"{name}.yaml").read_text())
    kind = kinds.load("detector", data["kind"])
    bus = Bus(sample_s=0.05, sites=JetEngine.sites, signals={"y": 3, "u": 3})
    with pytest.raises(DesignError, match=r"needs the signals .*'phi_deg'.*this benchmark has"):
        kind.from_design(kind.Gains.model_validate(data["gains"]), bus)
