from dataclasses import dataclass, replace

import numpy as np
import pytest

from fddbench.design.geometric.affine import Box
from fddbench.design.sliding_mode import FaultyPlant, Weights, synthesise, with_sensor_faults
from fddbench.flight.lateral_lpv import lateral_lpv


@dataclass(frozen=True)
class Paper:
    """The problem of section 5.3."""

    plant: FaultyPlant
    weights: Weights

    def at_one_condition(self) -> FaultyPlant:
        return replace(self.plant, A=self.plant.A[:1], box=Box.of(None, 0))


@pytest.fixture(scope="session")
def paper():
    plant = with_sensor_faults(
        lateral_lpv().tables["A"][..., 0], np.eye(4), suspects=[3], filter_poles=[0.01],
        M=np.array([[0.0, 0.0, 0.0, 100.0], [0.0, 0.0, 100.0, 0.0]]).T, box=Box.of([(-1.0, 1.0)] * 4, 4),
    )  # fmt: skip
    weights = Weights(
        uncertainty=np.array([0.01, 1e-4]), corruption=np.array([1.0, 60.0, 1.0, 0.0]), corruption_pole_1_s=25.0,
        fault=np.ones(1),
    )  # fmt: skip
    return Paper(plant, weights)


@pytest.fixture(scope="session")
def best(paper):
    """The designed pair."""
    return synthesise(paper.plant, paper.weights)
