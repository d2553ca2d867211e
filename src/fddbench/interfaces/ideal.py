"""What the best test that there can be knows of a benchmark: a linear model with Gaussian noise, and where faults enter."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from fddbench.interfaces.floats import Floats

__all__ = ["IdealModel"]


@dataclass(frozen=True, kw_only=True, eq=False)
class IdealModel:
    """``x[k+1] = A x[k] + B f[k] + w[k], y[k] = C x[k] + D f[k] + v[k]`` of some flights, inputs known and left out.

    w and v are white, Gaussian, of covariance Q and R, and independent; x[0] is Gaussian too. A benchmark states here what
    nobody can know better: its own matrices, the true noise of its sensors and its air. What it leaves out makes the test that
    knows this model better than any detector, so the bound holds all the same.

    Attributes
    ----------
    about : str
        What is supposed, in words, for those who read the bound.
    A, C : (n_cases, n, n), (n_cases, n_y, n) arrays
    Q, R : (n_cases, n, n), (n_cases, n_y, n_y) arrays
        R regular.
    start : (n_cases, n, n) array
        Covariance of the state at sample 0.
    outputs : mapping of str to int
        Row of y to which a fault on a site adds, in the unit of the site.
    states : mapping of str to (n_cases, n) arrays
        Column of B by which one enters the state, held over a sample.
    together : sequence of sequences of str
        Sites that measure one and the same quantity: a fault on some of them looks like the opposite one on the others.
    """

    about: str
    A: Floats
    C: Floats
    Q: Floats
    R: Floats
    start: Floats
    outputs: Mapping[str, int] = field(default_factory=dict)
    states: Mapping[str, Floats] = field(default_factory=dict)
    together: Sequence[Sequence[str]] = ()
