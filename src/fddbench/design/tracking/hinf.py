"""H∞ synthesis by SLICOT, the reduction of its controller, and the controller as a law."""

from typing import Any

import numpy as np
from scipy.linalg import schur, solve_sylvester

from fddbench.design.norms import hinf_norm
from fddbench.design.tracking.interconnection import CONTROLS, KNOWN
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace, lower_lft

__all__ = ["as_law", "closed_norm", "controller_of", "reduce_order", "slow_part", "synthesize"]


def _control() -> Any:
    """python-control with SLICOT, imported when it is needed: slycot is GPL and no dependency."""
    try:
        import control
        import slycot  # noqa: F401
    except ImportError as error:
        raise DesignError(
            f"H∞ synthesis needs python-control and slycot, and {error.name} is not installed. "
            "Install both with `pip install 'fddbench[synthesis]'`; the shipped laws fly without them"
        ) from None
    return control


def synthesize(plant: StateSpace) -> tuple[StateSpace, float]:
    """The optimal controller from `KNOWN` to `CONTROLS`, and the closed-loop norm γ that it reaches.

    Parameters
    ----------
    plant : StateSpace
        As `generalised_plant` makes it.

    References
    ----------
    Glover, Doyle (1988), State-space formulae for all stabilizing controllers that satisfy an H∞-norm bound, Systems &
    Control Letters 11(3), 167-172.
    """
    control = _control()
    system = control.ss(plant.A, plant.B, plant.C, plant.D)
    try:
        K, _, gamma, _ = control.hinfsyn(system, len(KNOWN), len(CONTROLS))
    except (ValueError, ArithmeticError) as error:
        raise DesignError(f"there is no H∞ controller for these weights: {error}. Tolerate more") from error
    return _system(K), float(gamma)


def _system(K: Any) -> StateSpace:
    return StateSpace(*(np.asarray(getattr(K, name), dtype=float) for name in "ABCD"))


def closed_norm(plant: StateSpace, controller: StateSpace) -> float:
    """‖F_l(P, K)‖∞ by level sets, independent of the synthesis; infinite where the loop is unstable."""
    closed = lower_lft(plant, controller)
    return hinf_norm(closed, tolerance=1e-6).value if closed.stable() else float("inf")


def slow_part(controller: StateSpace, fastest_rad_s: float) -> StateSpace:
    """The controller with its modes faster than this at their steady state.

    An optimal controller has modes of 1e6 rad/s and more that no sampled law can fly; its gain below is left as it is.
    """
    T, Z, n = schur(controller.A, output="real", sort=lambda re, im: bool(np.hypot(re, im) < fastest_rad_s))
    slow, fast = T[:n, :n], T[n:, n:]
    X = solve_sylvester(slow, -fast, -T[:n, n:])  # takes the coupling of both out
    B, C = Z.T @ controller.B, controller.C @ Z
    left = C[:, :n] @ X + C[:, n:]
    D = controller.D - left @ np.linalg.solve(fast, B[n:]) if len(fast) else controller.D
    return StateSpace(slow, B[:n] - X @ B[n:], C[:, :n], D)


def reduce_order(plant: StateSpace, controller: StateSpace, sizes: tuple[Floats, Floats], loss: float) -> StateSpace:
    """The controller of lowest order whose closed-loop norm is at most `loss` above that of the one given.

    Parameters
    ----------
    plant, controller : StateSpace
    sizes : (9,) and (2,) arrays
        Sizes of what comes in and goes out; the states of a balanced realisation between them are cut, at their steady state.
    loss : float
        Share by which the norm may rise [-].
    """
    control = _control()
    limit = (1.0 + loss) * closed_norm(plant, controller)
    into, out = sizes
    scaled = (controller.A, controller.B * into, controller.C / out[:, None], controller.D * into / out[:, None])
    best = controller
    for order in range(controller.order - 1, 0, -1):
        found = _system(control.balred(control.ss(*scaled), order, method="matchdc"))
        smaller = StateSpace(found.A, found.B / into, found.C * out[:, None], found.D / into * out[:, None])
        if closed_norm(plant, smaller) > limit:
            break
        best = smaller
    return best


def as_law(controller: StateSpace) -> StateSpace:
    """The controller from the inputs of a law, errors and `MEASURED`: integrals are states, the last two, commands sums."""
    n = controller.order
    known = np.zeros((len(KNOWN), 7))  # commands are errors plus measured flight path and speed
    known[0, [0, 2]] = known[1, [1, 6]] = 1.0
    known[4:, 2:] = np.eye(5)
    A, B = np.zeros((n + 2, n + 2)), np.zeros((n + 2, 7))
    A[:n, :n], A[:n, n:] = controller.A, controller.B[:, 2:4]
    B[:n], B[n:, :2] = controller.B @ known, np.eye(2)
    return StateSpace(A, B, np.hstack([controller.C, controller.D[:, 2:4]]), controller.D @ known)


def controller_of(law: StateSpace) -> StateSpace:
    """The controller that `as_law` made a law of: how a certificate is checked from the numbers of a file alone."""
    n = law.order - 2
    B, D = (np.zeros((len(M), len(KNOWN))) for M in (law.B[:n], law.D))
    for own, M, by_integral in ((B, law.B[:n], law.A[:n, n:]), (D, law.D, law.C[:, n:])):
        own[:, :2], own[:, 2:4], own[:, 4:] = M[:, :2], by_integral, M[:, 2:]
        own[:, [4, 8]] -= M[:, :2]  # what errors brought along with the commands
    return StateSpace(law.A[:n, :n], B, law.C[:, :n], D)
