"""Parity relations of the jet engine: zero but for their own fault, which they read; refusals with what fails."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.benchmarks.jet_engine import JetEngine
from fddbench.benchmarks.jet_engine.plant import MATRICES as M
from fddbench.blocks.layout import Nothing
from fddbench.design.recipe import cook
from fddbench.design.recipes.parity_space import ParitySpaceRecipe
from fddbench.detection.parity_space import ParitySpace, ParitySpaceGains
from fddbench.errors import DesignError
from fddbench.interfaces import Bus
from fddbench.systems import DiscreteLti, StateSpace

PATH = gallery.folder("detectors") / "parity_space_jet.yaml"
BUS = Bus(sample_s=0.05, sites=JetEngine.sites, signals={"y": 3, "u": 3})
RNG = np.random.default_rng(6)


def gains(**changes):
    return ParitySpaceGains.model_validate(yaml.safe_load(PATH.read_text())["gains"] | changes)


def residuals(faults, inputs):
    """Residuals, (n_time, 3), of the nominal engine without disturbances."""
    made = ParitySpace.from_design(gains(window_s=0.05), BUS)
    engine = DiscreteLti.of(
        StateSpace(M["A"], np.hstack([M["Bf"], M["B"]]), M["C"], np.hstack([M["Df"], M["D"]])), 0.05
    )
    x, state, found = engine.start(1), made.states.spread(made.start(Nothing()), 1), []
    for f, u in zip(faults, inputs, strict=True):
        x, y = engine.step(x, np.concatenate([f, u])[:, np.newaxis])
        state, verdict = made.step(state, Nothing(), Nothing(), SimpleNamespace(y=y, u=u[:, np.newaxis]))
        found.append([verdict.signals[f"mean_{i + 1}"][0] for i in range(3)])
    return np.array(found)


@pytest.mark.parametrize("i", [0, 1, 2])
def test_a_relation_is_blind_to_the_other_faults_whatever_they_do_and_reads_its_own(i):
    faults = RNG.standard_normal((100, 3))
    faults[:, i] = 1.0
    found = residuals(faults, np.zeros((100, 3)))[30:, i]
    assert found == pytest.approx(1.0, abs=0.15)  # the state is noise to it
    faults[:, i] = 0.0
    assert np.abs(residuals(faults, np.zeros((100, 3)))[:, i]).max() < 0.3
    assert np.abs(residuals(np.zeros((100, 3)), RNG.standard_normal((100, 3)))[:21]).max() < 1e-9  # from rest


def test_the_recipe_remakes_the_relations():
    np.testing.assert_allclose(np.array(cook(PATH).gains["V"]), np.array(gains().V), rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"decouple": ["faults", "disturbances"]},
            r"no parity relation is blind to the faults and disturbances beside fault 1",
        ),
        ({"order": 2, "state": None}, r"no parity relation is blind to the faults beside fault 1: rank \[O H_d\] = 9"),
    ],
)
def test_what_cannot_be_decoupled_is_refused_with_the_condition_that_fails(change, message):
    written = {key: value for key, value in yaml.safe_load(PATH.read_text())["recipe"].items() if key != "found"}
    with pytest.raises(DesignError, match=message):
        ParitySpaceRecipe.model_validate(written | change).make()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"sample_s": 0.1}, r"these relations are for 0.1 s, this campaign has 0.05; design them anew"),
        ({"V": [[1.0] * 7] * 3}, r"V has 3 rows of \[7\] numbers .* needs 3 of each, and twice or more the 6 numbers"),
    ],
)
def test_relations_that_do_not_fit_are_refused(change, message):
    with pytest.raises(DesignError, match=message):
        ParitySpace.from_design(gains(**change), BUS)
