"""One way to call cvxpy: a solver by name, and no answer that the solver itself doubts."""

import warnings
from importlib import import_module
from typing import Any

from fddbench.errors import DesignError, did_you_mean

__all__ = ["SOLVERS", "attempt", "modelling", "require_known", "solve"]

SOLVERS: dict[str, dict[str, Any]] = {
    "CLARABEL": {},
    "SCS": {"eps": 1e-8, "max_iters": 50_000},
    "MOSEK": {},
}
"""Solvers for linear matrix inequalities with the options that make their answers worth certifying."""


def modelling() -> Any:
    """Import cvxpy when it is first needed, since that takes a second, and as untyped, since that is what it is."""
    return import_module("cvxpy")


def require_known(solver: str) -> None:
    """Refuse the name of a solver that is none of ours."""
    if solver not in SOLVERS:
        raise DesignError(
            f"no solver is called {solver!r}. {did_you_mean(str(solver), SOLVERS)}\nKnown: {', '.join(SOLVERS)}."
        )


def attempt(problem: Any, solver: str, what: str) -> str:
    """Solve and return the status: "optimal", "optimal_inaccurate", "infeasible" ...; "failed" for a breakdown."""
    cvxpy = modelling()
    require_known(solver)
    if solver not in cvxpy.installed_solvers():
        raise DesignError(
            f"{what}: solver {solver} is not installed (MOSEK: `pip install mosek` and a licence); use CLARABEL."
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            problem.solve(solver=solver, **SOLVERS[solver])
        except cvxpy.SolverError:
            return "failed"
    return str(problem.status)


def solve(problem: Any, solver: str, what: str, *, infeasible: str) -> float:
    """Optimal value of a cvxpy problem; its variables hold the solution.

    Parameters
    ----------
    problem : cvxpy.Problem
    solver : {"CLARABEL", "SCS", "MOSEK"}
    what : str
        What is being solved, for messages.
    infeasible : str
        What it means, and what to do, when there is no solution.
    """
    status = attempt(problem, solver, what)
    if status in ("infeasible", "infeasible_inaccurate"):
        raise DesignError(f"{what}: {infeasible}")
    if status != "optimal":
        raise DesignError(
            f"{what}: {solver} stopped with status {status!r}, and what a solver doubts proves nothing. "
            "Scale states and signals to about one (weights W_f, W_d, W_u), or try another solver."
        )
    return float(problem.value)
