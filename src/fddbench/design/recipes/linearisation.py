"""An affine model linearised at one flight condition: its parameters move with the states, which a frozen rho would forget."""

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from fddbench.design.geometric.affine import Box
from fddbench.errors import DesignError
from fddbench.interfaces import AffineModel, Channel, Floats, Scheduling

__all__ = ["linearised"]

_STEP = 1e-5
"""Of the central differences, of the size of each state or of one."""


def linearised(model: AffineModel, scheduling: Scheduling, at: Mapping[str, float]) -> AffineModel:
    """``x' = f(x0) + J (x - x0) + B(rho0) (u - u0)`` of ``f = A(rho(x)) x + B(rho(x)) u0``, with channels about that point.

    What is left of f(x0), where the condition is no trim, becomes a constant input.

    Parameters
    ----------
    at : mapping of signal to number
        Value of every signal of the model and of the scheduling, in the units of the bus.

    Raises
    ------
    DesignError
        A signal is not given, or the outputs do not give the state.
    """
    _refuse_unfit(model, scheduling, at)
    u0 = np.array([_number(c, at) for c in model.inputs])
    x0 = np.linalg.solve(model.C, np.array([_number(c, at) for c in model.outputs]))

    def rho(x: Floats) -> Floats:
        y = model.C @ x
        signals = dict(at) | {c.signal: v / c.scale + c.offset for c, v in zip(model.outputs, y, strict=True)}
        measured = SimpleNamespace(**{name: np.array([value]) for name, value in signals.items()})
        return np.asarray(scheduling.rho(measured), dtype=float)[:, 0]

    def rate(x: Floats) -> Floats:
        factors = np.concatenate([[1.0], rho(x)])
        found: Floats = np.tensordot(factors, model.A, axes=1) @ x + np.tensordot(factors, model.B, axes=1) @ u0
        return found

    _refuse_outside(rho(x0), Box.of(model.box.tolist() or None, len(model.A) - 1))
    J = np.empty_like(model.A[0])
    for j, h in enumerate(_STEP * np.maximum(np.abs(x0), 1.0)):
        moved = np.zeros_like(x0)
        moved[j] = h
        J[:, j] = (rate(x0 + moved) - rate(x0 - moved)) / (2.0 * h)
    B = np.tensordot(np.concatenate([[1.0], rho(x0)]), model.B, axes=1)
    signals = [j for j, c in enumerate(model.inputs) if c.signal]
    return AffineModel(
        A=J[np.newaxis],
        B=np.hstack([B[:, signals], rate(x0)[:, np.newaxis]])[np.newaxis],
        C=model.C,
        outputs=tuple(replace(c, offset=at[c.signal]) for c in model.outputs),
        inputs=(*(replace(model.inputs[j], offset=at[model.inputs[j].signal]) for j in signals), Channel()),
        box=np.zeros((0, 2)),
    )


def _refuse_unfit(model: AffineModel, scheduling: Scheduling, at: Mapping[str, float]) -> None:
    """Refuse conditions that say too little or too much, and models that cannot be linearised."""
    needed = [c.signal for c in (*model.outputs, *model.inputs) if c.signal]
    missing = [name for name in dict.fromkeys([*needed, *scheduling.signals]) if name not in at]
    if missing:
        raise DesignError(
            f"recipe.at: {', '.join(missing)} missing; give every signal that model and scheduling look at"
        )
    multiplied = [c.signal for c in (*model.outputs, *model.inputs) if c.times]
    if multiplied:
        raise DesignError(
            f"recipe.at: {', '.join(multiplied)} is multiplied by another signal and cannot be linearised"
        )
    unknown = [name for name in at if name not in (*needed, *scheduling.signals)]
    if unknown:
        raise DesignError(
            f"recipe.at: nothing looks at {', '.join(unknown)}; model and scheduling look at "
            f"{', '.join(dict.fromkeys([*needed, *scheduling.signals]))}"
        )
    if model.C.shape[0] != model.C.shape[1] or np.linalg.matrix_rank(model.C) < len(model.C):
        raise DesignError("recipe.at needs a model whose outputs give its state: C square and regular")


def _refuse_outside(rho: Floats, box: Box) -> None:
    """Refuse a condition at which a parameter is no number or lies outside its box, by more than a hundredth of it."""
    low, high = box.low, box.high
    margin = 0.02 * box.half
    outside = np.flatnonzero(~((rho >= low - margin) & (rho <= high + margin)))
    if len(outside):
        said = ", ".join(f"rho {j + 1} = {rho[j]:.4g}, not in {low[j]:.4g} ... {high[j]:.4g}" for j in outside)
        raise DesignError(f"recipe.at: the condition lies outside the box of the model: {said}. Choose one inside")


def _number(channel: Channel, at: Mapping[str, float]) -> float:
    return channel.scale * (at[channel.signal] - channel.offset) if channel.signal else channel.scale
