"""What is no system, no box or no fault is refused in words, whatever shape it comes in."""

import numpy as np
import pytest

from fddbench.design.geometric import invariant_subspace, residual_generator, unobservability_subspace
from fddbench.errors import DesignError

A = np.array([[-1.0, 1.0], [0.0, -2.0]])
EYE = np.eye(2)
FAULTS = {"a": [1.0, 0.0], "b": [0.0, 1.0]}
FAMILY = np.stack([A, 0.1 * EYE])


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"A": "foo"}, "A is no matrix of real numbers"),
        ({"A": [[1, 2], [3]]}, "A is no matrix of real numbers"),
        ({"A": A + 1j}, "A is no matrix of real numbers"),
        ({"C": EYE * np.nan}, "C has numbers that are not finite"),
        ({"faults": [[1.0, 0.0]]}, "directions by name"),
        ({"faults": {}}, "directions by name"),
        ({"faults": {"a": [[1.0, 2.0], [0.0, 0.0]], "b": [0.0, 1.0]}}, "2 columns that say only 1"),
        ({"faults": {"a": [[1.0, 0.0], [0.0, 0.0]]}}, "2 columns that say only 1"),
        ({"watch": "a"}, "watch is a list"),
        ({"watch": []}, "watch is a list"),
        ({"decay": "fast"}, "decay is a rate"),
        ({"solver": "FOO"}, "no solver is called 'FOO'"),
        ({"A": FAMILY, "box": 3.0}, "needs 1 rows"),
        ({"A": FAMILY, "box": [0.0, 1.0]}, "needs 1 rows"),
        ({"A": FAMILY, "box": [[0.0, 1.0, 2.0]]}, "needs 1 rows"),
        ({"A": np.stack([A, *[EYE] * 4]), "box": [[0.0] * 4, [1.0] * 4]}, "needs 4 rows"),  # lows, then highs
        (
            {"A": FAMILY, "box": [[-1, 1]], "faults": {"a": [[[0.0], [0.0]], [[1.0], [0.0]]]}},
            r"does nothing at rho = \[0",
        ),
    ],
)
def test_a_bank_of_nonsense(wrong, words):
    given = {"A": A, "C": EYE, "faults": FAULTS} | wrong
    with pytest.raises(DesignError, match=words):
        residual_generator(given.pop("A"), EYE, given.pop("C"), given.pop("faults"), **given)


@pytest.mark.parametrize("subspace", [invariant_subspace, unobservability_subspace])
def test_subspaces_of_lists_and_of_nonsense(subspace):
    want = subspace([A], EYE[:1], EYE[:, 1:])
    assert np.array_equal(subspace(A.tolist(), [1.0, 0.0], [0.0, 1.0]), want)
    for wrong in (
        ([], EYE, EYE),
        ([A, np.eye(3)], EYE, EYE),
        ([A], np.eye(3), EYE),
        ([A], EYE, [1.0]),
        ([A * np.nan], EYE, EYE),
    ):
        with pytest.raises(DesignError):
            subspace(*wrong)
