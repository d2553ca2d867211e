"""What a design promises of its residuals: r = T_ref f, eq (80) of the robust fault-detection paper, beside what they are."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.interfaces import Floats, Recording

__all__ = ["Promise", "lost_reference", "promise_of"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Promise:
    """Reference ``x' = A x + B f, r = C x + D f``, and the moving mean through which residuals are seen.

    Attributes
    ----------
    A, B, C, D : matrices
        Faults to promised residuals.
    window_s : float
        Length of the moving mean [s].
    """

    A: Floats
    B: Floats
    C: Floats
    D: Floats
    window_s: float

    def promised(self, time_s: Floats, fault: Floats) -> Floats:
        """Moving mean of T_ref f, (n_time, n_residuals), of the true faults (n_time, n_faults), held over each sample.

        >>> same = Promise(A=np.zeros((0, 0)), B=np.zeros((0, 1)), C=np.zeros((1, 0)), D=np.ones((1, 1)), window_s=0.1)
        >>> same.promised(np.array([0.0, 0.1, 0.2]), np.array([[0.0], [2.0], [2.0]])).ravel().tolist()
        [0.0, 2.0, 2.0]
        """
        from scipy.linalg import expm

        sample_s = float(time_s[1] - time_s[0]) if len(time_s) > 1 else 1.0
        n, m = self.B.shape
        held = expm(np.block([[self.A, self.B], [np.zeros((m, n + m))]]) * sample_s)
        x, found = np.zeros(n), []
        for f in np.nan_to_num(fault):
            found.append(self.C @ x + self.D @ f)
            x = held[:n, :n] @ x + held[:n, n:] @ f
        values = np.array(found)
        window = max(round(self.window_s / sample_s), 1)
        total = np.vstack([np.zeros((window, values.shape[1])), np.cumsum(values, axis=0)])
        mean: Floats = (total[window:] - total[:-window]) / window
        return mean

    def lines(self, recording: Recording, case: int) -> dict[str, Floats]:
        """Promised residuals of a flight by the names of those shown; none where its faults are not recorded."""
        names = [f"f_true_{i + 1}" for i in range(self.B.shape[1])]
        if any(name not in recording.signals for name in names):
            return {}
        fault = np.stack([recording.signals[name][:, case] for name in names], axis=1)
        values = self.promised(recording.time_s, fault)
        return {f"mean_{i + 1}": values[:, i] for i in range(values.shape[1])}


_SEARCHING = ("free_reference", "fixed_poles", "two_step")
"""Methods of a `hinf_filter` recipe that choose the reference themselves and write it under `found`."""


def promise_of(content: Mapping[str, Any]) -> Promise | None:
    """Promise of a design file from its recipe; None where it makes none.

    A method that searches for a reference promises the one that it found, not the one it began with.
    """
    recipe, gains = content.get("recipe") or {}, content.get("gains") or {}
    rows, window_s = gains.get("C"), gains.get("window_s")
    if content.get("kind") != "hinf_filter" or not rows or not window_s or not isinstance(recipe, Mapping):
        return None
    searched = recipe.get("method") in _SEARCHING
    reference = (recipe.get("found") or {}).get("reference") if searched else recipe.get("reference")
    if reference is None:
        return _matrices({"D": np.eye(len(rows)).tolist()}, float(window_s)) if gains.get("estimates_faults") else None
    return _matrices(reference, float(window_s))


def lost_reference(content: Mapping[str, Any]) -> bool:
    """Whether a design was made for a reference that a search found and its file does not keep: its promise is unknown."""
    recipe = content.get("recipe")
    if content.get("kind") != "hinf_filter" or not isinstance(recipe, Mapping):
        return False
    return recipe.get("method") in _SEARCHING and not (recipe.get("found") or {}).get("reference")


def _matrices(reference: Mapping[str, Any], window_s: float) -> Promise:
    """Of a diagonal reference, ``c_i b_i / (s - a_i) + d_i``, or of matrices."""
    own = {name.upper(): np.asarray(value, dtype=np.float64) for name, value in reference.items()}
    own = {name: np.diag(value) if value.ndim == 1 else value for name, value in own.items()}
    D = own.get("D", np.zeros((len(own["C"]), own["B"].shape[1])) if "C" in own else np.eye(1))  # noqa: N806
    n = len(own["A"]) if "A" in own else 0
    return Promise(
        A=own.get("A", np.zeros((0, 0))), B=own.get("B", np.zeros((n, D.shape[1]))), C=own.get("C", np.zeros((D.shape[0], n))),
        D=D, window_s=window_s,
    )  # fmt: skip
