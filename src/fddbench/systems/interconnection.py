"""Systems connected: series, side by side, feedback, and the linear fractional transformations of robust control."""

import numpy as np

from fddbench.systems.errors import MisfitError
from fddbench.systems.shapes import Matrix
from fddbench.systems.state_space import StateSpace

__all__ = ["append", "feedback", "lower_lft", "series", "star", "upper_lft"]


def append(*systems: StateSpace) -> StateSpace:
    """Side by side: inputs, outputs and states of all, in the order given; no system at all has no signals."""
    return StateSpace(*(_diagonal([getattr(system, name) for system in systems]) for name in "ABCD"))


def series(*systems: StateSpace) -> StateSpace:
    """One after the other in the order in which the signal flows, ``y = G_n ... G_2 G_1 u``; states in the same order.

    Raises
    ------
    MisfitError
        A system has another number of inputs than the one before has outputs.

    Examples
    --------
    >>> lag = StateSpace.diagonal([-1.0], [1.0], [1.0], [0.0])
    >>> series(lag, StateSpace.gain(3.0)).at(0.0).real
    array([[3.]])
    """
    whole = systems[0]
    for number, after in enumerate(systems[1:], start=2):
        _require(after.n_inputs, whole.n_outputs, f"series: system {number} has", "inputs", "the one before", "outputs")
        whole = StateSpace(
            np.block([[whole.A, np.zeros((whole.order, after.order))], [after.B @ whole.C, after.A]]),
            np.vstack([whole.B, after.B @ whole.D]),
            np.hstack([after.D @ whole.C, after.C]),
            after.D @ whole.D,
        )
    return whole


def feedback(forward: StateSpace, back: StateSpace, *, sign: float = -1.0) -> StateSpace:
    """Closed loop ``y = G (u + sign K y)`` of `forward` G and `back` K; negative feedback unless `sign` is +1.

    Raises
    ------
    MisfitError
        Numbers of signals differ, or ``I - sign D_G D_K`` is singular.
    """
    _require(back.n_inputs, forward.n_outputs, "feedback: the system in the return has", "inputs", "forward", "outputs")
    _require(back.n_outputs, forward.n_inputs, "feedback: the system in the return has", "outputs", "forward", "inputs")
    doubled = StateSpace(
        forward.A,
        np.hstack([forward.B, forward.B]),
        np.vstack([forward.C, forward.C]),
        np.block([[forward.D, forward.D], [forward.D, forward.D]]),
    )
    return lower_lft(doubled, series(back, StateSpace.gain(sign * np.eye(back.n_outputs))))


def lower_lft(plant: StateSpace, controller: StateSpace) -> StateSpace:
    """``F_l(P, K)``: the last outputs of P feed K, whose outputs are the last inputs of P.

    Raises
    ------
    MisfitError
        K has more inputs than P outputs or more outputs than P inputs, or the loop has no solution.
    """
    return star(plant, controller, controller.n_inputs, controller.n_outputs)


def upper_lft(plant: StateSpace, delta: StateSpace) -> StateSpace:
    """``F_u(P, Δ)``: the first outputs of P feed Δ, whose outputs are the first inputs of P; raises as `lower_lft`."""
    if delta.n_inputs > plant.n_outputs or delta.n_outputs > plant.n_inputs:
        return star(plant, delta, delta.n_inputs, delta.n_outputs)  # says what does not fit
    y = np.roll(np.arange(plant.n_outputs), -delta.n_inputs)
    u = np.roll(np.arange(plant.n_inputs), -delta.n_outputs)
    turned = StateSpace(plant.A, plant.B[:, u], plant.C[y], plant.D[np.ix_(y, u)])
    return lower_lft(turned, delta)


def star(upper: StateSpace, lower: StateSpace, n_down: int, n_up: int) -> StateSpace:
    """Redheffer's star product: outputs (z, y) of `upper` and (v, e) of `lower`, inputs (w, v) and (y, d).

    The last `n_down` outputs of `upper` are the first inputs of `lower`; the first `n_up` outputs of `lower` are the last
    inputs of `upper`. What is left, in this order: from (w, d) to (z, e); states of `upper` first.

    Parameters
    ----------
    upper, lower : StateSpace
    n_down, n_up : int
        Numbers of signals y and v.

    Raises
    ------
    MisfitError
        A system has fewer signals than that, or ``I - D_vy D_yv`` is singular: the loop has no or many solutions.

    References
    ----------
    Zhou, Doyle, Glover (1996), Robust and Optimal Control, chapter 10.
    """
    for system, name, down, up in ((upper, "upper", "outputs", "inputs"), (lower, "lower", "inputs", "outputs")):
        for need, what in ((n_down, down), (n_up, up)):
            found = system.n_outputs if what == "outputs" else system.n_inputs
            if found < need:
                raise MisfitError(
                    f"star product: {need} signals are to be connected, but the {name} system has {found} {what} "
                    f"(D {system.D.shape})."
                )
    v, y = upper.n_inputs - n_up, upper.n_inputs  # where v and y begin among the inputs (w, v, y, d)
    y_out, v_out = upper.n_outputs - n_down, upper.n_outputs  # and among the outputs (z, y, v, e)
    inside = [*range(v, v + n_up), *range(y, y + n_down)]
    sources = [*range(v_out, v_out + n_up), *range(y_out, y_out + n_down)]
    return _closed(append(upper, lower), inside, sources, n_up)


def _closed(system: StateSpace, inside: list[int], sources: list[int], n_up: int) -> StateSpace:
    """Inputs `inside` are the outputs `sources`, one by one, the first `n_up` fed by the others; the rest stays."""
    free = [j for j in range(system.n_inputs) if j not in set(inside)]
    shown = [i for i in range(system.n_outputs) if i not in set(sources)]
    B, C, D = system.B, system.C, system.D
    around = D[np.ix_(sources, inside)]
    once = np.eye(n_up) - around[:n_up, n_up:] @ around[n_up:, :n_up]  # one way round: the units of signals cancel
    if n_up and np.linalg.cond(once) > 1e12:
        raise MisfitError(
            "the loop is ill-posed: the feedthroughs D around it multiply to one, so that its signals have no or many "
            f"solutions (condition of I - D D' {np.linalg.cond(once):.3g}). Put a lag or another gain into the loop."
        )
    loop = np.eye(len(inside)) - around
    fed = np.linalg.solve(loop, np.hstack([C[sources], D[np.ix_(sources, free)]]))
    states, signals = fed[:, : system.order], fed[:, system.order :]
    return StateSpace(
        system.A + B[:, inside] @ states,
        B[:, free] + B[:, inside] @ signals,
        C[shown] + D[np.ix_(shown, inside)] @ states,
        D[np.ix_(shown, free)] + D[np.ix_(shown, inside)] @ signals,
    )


def _diagonal(blocks: list[Matrix]) -> Matrix:
    """Blocks down the diagonal; those without rows or columns still take their place."""
    whole, row, column = np.zeros([sum(block.shape[axis] for block in blocks) for axis in (0, 1)]), 0, 0
    for block in blocks:
        whole[row : row + block.shape[0], column : column + block.shape[1]] = block
        row, column = row + block.shape[0], column + block.shape[1]
    return whole


def _require(found: int, need: int, who: str, what: str, other: str, whose: str) -> None:
    """Refuse two numbers of signals that differ."""
    if found != need:
        raise MisfitError(f"{who} {found} {what} but {other} has {need} {whose}; they must agree.")
