"""From a pair (L, W) to the gains that fly, steps 6 to 10 of section 4.1, and how large a fault may be, eq (15)."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_continuous_lyapunov

from fddbench.design.sliding_mode.canonical import Canonical
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["ObserverGains", "largest_fault", "observer_gains"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ObserverGains:
    """Gains in the coordinates and order of the plant.

    Attributes
    ----------
    G_l : (n_rho + 1, n, p) array
        Linear gain, affine in rho.
    G_n : (n, p) array
        Gain of the injection, eq (19).
    P_o : (p, p) array
        Solves the Lyapunov equation (14).
    """

    G_l: Floats
    G_n: Floats
    P_o: Floats


def observer_gains(form: Canonical, L: Floats, stable: Floats) -> ObserverGains:
    """Gains for a matrix Ã22s, (p, p), that the output error decays with.

    With ``e1 + L e_y`` for e1 the output error obeys ``e_y' = Ã22s e_y + ...`` and leaves e1 alone, if

        G_l = [Ã12 - Ã11 L + L Ã22s; Ã22 - Ã21 L - Ã22s],    G_n = [-L; I].

    Raises
    ------
    DesignError
        Ã22s is not Hurwitz.
    """
    pole = float(np.linalg.eigvals(stable).real.max())
    if pole >= 0.0:
        raise DesignError(f"A22s has a pole at {pole:.4g} 1/s: it must be Hurwitz, step 7; choose negative poles")
    p, (A11, A12, A21, A22) = len(form.F2), form.parts(form.A)
    constant = np.vstack([L @ stable, -stable])
    G_l = np.concatenate([A12 - A11 @ L, A22 - A21 @ L], axis=1)
    G_l[0] += constant
    back: Floats = np.asarray(np.linalg.inv(form.T), dtype=float)
    P_o: Floats = np.asarray(solve_continuous_lyapunov(stable.T, -np.eye(p)), dtype=float)
    return ObserverGains(
        G_l=back @ G_l, G_n=np.asarray(back @ np.vstack([-L, np.eye(p)]), dtype=float), P_o=0.5 * (P_o + P_o.T)
    )


def largest_fault(F2: Floats, k: Floats, eta_0: float) -> float:
    """Largest ``|f|`` for which condition (15), ``K > |F2| |f| + eta_0``, holds, in the unit of the model.

    A diagonal K counts by its smallest entry: ``e' P_o K P_o e >= min K |P_o e|^2``. Like the condition of the paper it
    leaves no room but `eta_0` for what else pushes the output error: uncertainty, noise and the hidden states' error.

    Raises
    ------
    DesignError
        K does not even exceed `eta_0`.
    """
    left = float(np.min(k)) - eta_0
    if left <= 0.0:
        raise DesignError(
            f"condition (15): min K = {np.min(k):g} does not exceed eta_0 = {eta_0:g}; raise k or lower eta_0"
        )
    return left / float(np.linalg.norm(F2, 2))
