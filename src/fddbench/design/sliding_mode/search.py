"""The best pair (L, W) with one V over all vertices: inequalities for fixed T, and a search over T by their multipliers."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import minimize

from fddbench.design.sliding_mode.error_system import ErrorSystem
from fddbench.design.sliding_mode.inequality import Point, assemble, vertex
from fddbench.design.solver import attempt, modelling
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["Found", "Programme", "best"]

_FAR = 1e6
"""What a T without a solution counts, so that the search turns back."""
_ROUNDS = 2
"""Searches: the second in units of the storage that the first found."""
_BARELY = 1e-7
"""P1 and Pd stay that far from singular, in units in which they are about one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Found:
    """The optimum, and a solution within `relax` of it that is far from the border; rows of e1 in units of `scale`."""

    optimum: Point
    moderate: Point
    scale: Floats


class Programme:
    """The inequality at every vertex as a convex programme with T as its parameter.

    Parameters
    ----------
    system : ErrorSystem
    points : (n_vertices, n_rho) array
    scale : (n_1,) array
        Size of each row of e1.
    """

    def __init__(self, system: ErrorSystem, points: Floats, scale: Floats) -> None:
        cp = modelling()
        form = system.form
        n_1, n_d, n_b, q = form.n_1, system.shown.shape[1], len(form.blind), form.F2.shape[1]
        self.scale, self.vertices = scale, [vertex(system, rho, scale) for rho in points]
        self.shape, self.gamma, self.margin = (n_1, n_d), cp.Variable(), cp.Variable()
        self.for_gamma, self.for_margin, self.level = (cp.Parameter(nonneg=True) for _ in range(3))
        self.T: Any = cp.Parameter((n_1, n_d)) if n_1 and n_d else np.zeros((n_1, n_d))
        P1: Any = cp.Variable((n_1, n_1), symmetric=True) if n_1 else np.zeros((0, 0))
        Pd: Any = cp.Variable((n_d, n_d), symmetric=True) if n_d else np.zeros((0, 0))
        Y, W1 = (cp.Variable((n_1, n_b)) if n_1 else np.zeros((0, n_b))), cp.Variable((q, n_b))
        self.unknown = Point(P1=P1, Pd=Pd, Y=Y, W1=W1, gamma=self.gamma, T=self.T)
        matrices = [assemble(at, self.unknown, cp.bmat) for at in self.vertices]
        self.inequalities = [M << -self.margin * np.eye(M.shape[0]) for M in matrices]
        positive = [P >> _BARELY * np.eye(n) for P, n in ((P1, n_1), (Pd, n_d)) if n]
        # compiled once for two aims: the smallest γ; and, for a given γ, the solution that is farthest from the border
        aim = self.for_gamma * self.gamma - self.for_margin * self.margin
        held = [self.for_margin * self.gamma <= self.level, self.margin >= 0.0]
        self.problem = cp.Problem(cp.Minimize(aim), [*self.inequalities, *positive, *held])

    def solve(self, T: Floats, solver: str) -> Point | None:
        """Solution with the smallest γ for this T; None: there is none."""
        return self._solved(T, solver, gamma=None)

    def inside(self, T: Floats, gamma: float, solver: str) -> Point | None:
        """Solution for this T and γ with the largest margin: moderate gains, and a V that proves γ without doubt."""
        found = self._solved(T, solver, gamma=gamma)
        return found if found is not None and float(self.margin.value) > 0.0 else None

    def slope(self, x: Point) -> Floats:
        """Gradient of the smallest γ in T, (n_1 n_d,), from the multipliers of the last solution."""
        slope = np.zeros(self.shape)
        for at, inequality in zip(self.vertices, self.inequalities, strict=True):
            here, weight = assemble(at, x, np.block), np.asarray(inequality.dual_value)
            for entry in np.ndindex(*self.shape):
                there = np.array(x.T)
                there[entry] += 1.0  # the inequality is affine in T
                slope[entry] += np.sum(weight * (assemble(at, replace(x, T=there), np.block) - here))
        return slope.ravel()

    def _solved(self, T: Floats, solver: str, *, gamma: float | None) -> Point | None:
        if 0 not in self.shape:
            self.T.value = T.reshape(self.shape)
        self.for_gamma.value, self.for_margin.value = (1.0, 0.0) if gamma is None else (0.0, 1.0)
        self.level.value = 1.0 if gamma is None else gamma
        status = attempt(self.problem, solver, "sliding-mode synthesis")
        if status not in ("optimal", "optimal_inaccurate") or self.gamma.value is None:
            return None
        return self._value()

    def _value(self) -> Point:
        names = ("P1", "Pd", "Y", "W1", "gamma", "T")
        found = {name: getattr(self.unknown, name) for name in names}
        return Point(**{name: np.array(getattr(v, "value", v), dtype=float) for name, v in found.items()})


def best(system: ErrorSystem, points: Floats, solver: str, relax: float) -> Found:
    """Pair with the smallest γ that one V proves at all points, and a moderate one whose γ is `relax` larger.

    Raises
    ------
    DesignError
        No gain L with one V makes the hidden states stable at all vertices, or numbers of very different size.
    """
    scale, T = np.ones(system.form.n_1), np.zeros((system.form.n_1, system.shown.shape[1]))
    for _ in range(_ROUNDS):
        programme = Programme(system, points, scale)
        optimum = _searched(programme, T, solver)
        # units in which P1 has ones on its diagonal: then T and Y are about one too
        own = 1.0 / np.sqrt(np.diag(optimum.P1))
        if np.all((own > 0.1) & (own < 10.0)):
            break
        scale, T = scale * own, optimum.T / own[:, np.newaxis]
    moderate = programme.inside(optimum.T, (1.0 + relax) * float(optimum.gamma), solver)
    if moderate is None:
        raise DesignError(
            f"{solver} finds γ = {float(optimum.gamma):.4g} but no solution inside the inequalities: entries of the model "
            "differ too much in size. Choose units in which states, outputs and weights are about one"
        )
    return Found(optimum=optimum, moderate=moderate, scale=programme.scale)


def _searched(programme: Programme, start: Floats, solver: str) -> Point:
    kept: list[Point] = []

    def value(T: Floats) -> tuple[float, Any]:
        x = programme.solve(T, solver)
        if x is None:
            return _FAR, np.zeros(T.size)
        if not kept or x.gamma < kept[0].gamma:
            kept[:] = [x]
        return float(x.gamma), programme.slope(x)

    if start.size:
        minimize(value, start.ravel(), jac=True, method="L-BFGS-B", options={"maxiter": 80, "ftol": 1e-9})
    else:
        value(start)
    if not kept:
        raise DesignError(
            "no constant L with one Lyapunov matrix makes the states that no output shows stable at every vertex of the box "
            "(step 5 of section 4.1). Make the box smaller, trust another output, or design for one flight condition"
        )
    return kept[0]
