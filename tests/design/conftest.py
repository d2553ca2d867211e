"""Plants for the tests of the synthesis: the jet engine of the paper and random ones."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from fddbench.benchmarks.jet_engine import plant
from fddbench.design.norms import hinf_norm
from fddbench.design.robust_hinf import synthesize
from fddbench.systems import StateSpace, UncertainPlant

DATA = yaml.safe_load((Path(plant.__file__).parent / "data" / "jet_engine.yaml").read_text())


@pytest.fixture(scope="session")
def engine() -> UncertainPlant:
    """The jet engine of section 5 with its unstructured Δ."""
    return UncertainPlant(**plant.MATRICES)


@pytest.fixture(scope="session")
def printed():
    """The references (75), "init", and (78), "final", and the "identity" of Remark 5."""
    return lambda name: StateSpace.diagonal(**DATA[f"Tref_{name}"])


@pytest.fixture(scope="session")
def for_identity(engine):
    """The design of the jet engine for ``T_ref = I``."""
    return synthesize(engine, StateSpace.gain(np.eye(3)))


@pytest.fixture(scope="session")
def random_plant():
    """Random plants by seed, states, faults and size of Δ."""
    return draw_plant


def draw_plant(seed: int, n_x: int, n_f: int, n_delta: int = 0) -> UncertainPlant:
    """Stable plant whose faults have a stable inverse and outweigh disturbances and uncertainty."""
    random = np.random.default_rng(seed)
    n_y, n_d, n_u = n_f + random.integers(2), random.integers(3), random.integers(3)

    def draw(rows: int, columns: int, size: float = 1.0) -> np.ndarray:
        return size * random.standard_normal((rows, columns))

    A = draw(n_x, n_x)
    A -= (np.linalg.eigvals(A).real.max() + random.uniform(0.2, 2.0)) * np.eye(n_x)
    left, _, right = np.linalg.svd(draw(n_y, n_f), full_matrices=False)
    C, Df = draw(n_y, n_x), (left * random.uniform(0.5, 2.0, n_f)) @ right
    parts = {"A": A, "C": C, "Df": Df, "Dd": draw(n_y, n_d, 0.1), "D": draw(n_y, n_u)}
    parts["Bf"] = shrink(A, draw(n_x, n_f), np.linalg.pinv(Df) @ C, random.uniform(0.1, 0.7))
    parts["Bd"] = shrink(A, draw(n_x, n_d), np.linalg.pinv(Df) @ C, 0.2)
    parts["B"] = draw(n_x, n_u)
    if n_delta:
        EA, H = draw(n_delta, n_x, 0.3), draw(n_delta, n_delta)
        parts |= {"FA": shrink(A, draw(n_x, n_delta), EA, 0.2), "EA": EA, "H": 0.3 * H / np.linalg.norm(H, 2)}
        parts |= {"FC": draw(n_y, n_delta, 0.05), "EB": draw(n_delta, n_u, 0.1), "Ef": draw(n_delta, n_f, 0.1)}
    return UncertainPlant(**parts)


def shrink(A: np.ndarray, B: np.ndarray, C: np.ndarray, gain: float) -> np.ndarray:
    """B scaled so that ``C (sI - A)⁻¹ B`` has the H∞ norm `gain`."""
    if not B.size:
        return B
    return B * gain / hinf_norm(StateSpace(A, B, C, np.zeros((len(C), B.shape[1])))).value
