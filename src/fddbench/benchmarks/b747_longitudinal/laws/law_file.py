"""A tracking law as a file holds it: a linear system between named signals, its gains perhaps over dynamic pressure."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from fddbench.blocks.tustin import tustin
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

__all__ = ["INPUTS", "OUTPUTS", "DiscreteLaw", "Handover", "TrackingLaw", "law_of", "read_law"]

INPUTS = (
    "flight_path_error_deg", "speed_error_m_s", "flight_path_deg", "acceleration_g", "pitch_deg", "pitch_rate_deg_s",
    "speed_m_s",
)  # fmt: skip
"""Command minus measured flight path and airspeed, then what is measured, as deviations from trim."""
OUTPUTS = ("elevator_deg", "thrust_n")
"""Orders minus trim; thrust is that of one engine."""
_KEYS = ("inputs", "outputs", "dynamic_pressure_pa", *"ABCDE", "handover")


@dataclass(frozen=True, kw_only=True)
class Handover:
    """Pitch by the stabiliser: what a law orders from a declared elevator, whose own order is frozen.

    Attributes
    ----------
    lead_s, lag_s : float
        ``(lead_s s + 1) / (lag_s s + 1)`` between elevator order and stabiliser, the lead that of its actuator [s].
    command_lag_s : float
        The flight-path command passes ``1 / (command_lag_s s + 1)`` from then on [s].
    """

    lead_s: float
    lag_s: float
    command_lag_s: float


@dataclass(frozen=True, kw_only=True)
class DiscreteLaw:
    """``x[k+1] = A x + B y + E (u_stopped - u)``, ``u = C x + D y`` by Tustin's rule; C and D one a knot."""

    A: Floats
    B: Floats
    C: Floats
    D: Floats
    E: Floats


@dataclass(frozen=True, kw_only=True)
class TrackingLaw:
    """``x' = A x + B y + E (u_stopped - u)``, ``u = C x + D y`` from `INPUTS` to `OUTPUTS`.

    Attributes
    ----------
    A, B, E : (n_x, n_x), (n_x, 7), (n_x, 2) arrays
        E moves integrals while a stop holds an order, so that they do not wind up.
    C, D : (n_knots, 2, n_x), (n_knots, 2, 7) arrays
        One pair at each dynamic pressure, linear between them and held outside; one only where nothing is scheduled.
    dynamic_pressure_pa : (n_knots,) array
        In rising order [Pa]; empty where nothing is scheduled.
    handover : Handover
    """

    A: Floats
    B: Floats
    C: Floats
    D: Floats
    E: Floats
    dynamic_pressure_pa: Floats
    handover: Handover

    def discrete(self, sample_s: float) -> DiscreteLaw:
        """The law at a sample time [s]; interpolating its C and D is the same as interpolating those of the file."""
        A, B = self.A[..., np.newaxis], self.B[..., np.newaxis]
        C, D = np.moveaxis(self.C, 0, -1), np.moveaxis(self.D, 0, -1)
        Ad, Bd, Cd, Dd = tustin(A, B, C, D, sample_s=sample_s)
        C, D = np.moveaxis(Cd, -1, 0), np.moveaxis(Dd, -1, 0)
        return DiscreteLaw(A=Ad[..., 0], B=Bd[..., 0], C=C, D=D, E=sample_s * self.E)


def read_law(path: Path) -> TrackingLaw:
    """Law of a file.

    Raises
    ------
    DesignError
        The file cannot be read, a key is missing or unknown, signals are not `INPUTS` and `OUTPUTS`, or matrices do not fit.
    """
    try:
        data = yaml.load(path.read_text(encoding="utf-8"), Loader=_LOADER)
    except (OSError, UnicodeError, yaml.YAMLError) as error:
        raise DesignError(f"{path} cannot be read: {' '.join(str(error).split())}") from error
    if not isinstance(data, dict) or data.get("kind") != "tracking_law" or not isinstance(data.get("gains"), dict):
        raise DesignError(f"{path} holds no law: expected kind: tracking_law, and gains")
    return law_of(data["gains"], where=f"{path}: gains")


def law_of(data: dict[str, Any], *, where: str) -> TrackingLaw:
    """Law of the gains of a file; `where` they stand, for messages."""
    unknown = [str(key) for key in data if key not in _KEYS]
    if unknown:
        raise DesignError(f"{where}: unknown key {', '.join(unknown)}; allowed: {', '.join(_KEYS)}")
    for key, known in (("inputs", INPUTS), ("outputs", OUTPUTS)):
        given = data.get(key)
        if not isinstance(given, list) or tuple(given) != known:
            raise DesignError(f"{where}: {key} of a law are {', '.join(known)}, in this order; got {given}")
    try:
        A, B, C, D, E = (np.asarray(data[name], dtype=float) for name in "ABCDE")
        handover = Handover(**{key: float(value) for key, value in data["handover"].items()})
        knots = np.asarray(data.get("dynamic_pressure_pa", ()), dtype=float)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise DesignError(
            f"{where}: {type(error).__name__} {error}; a law has matrices A, B, C, D and E with rows of one length, and "
            "handover: {lead_s, lag_s, command_lag_s}"
        ) from error
    lags = [f"{key} = {value:g}" for key, value in vars(handover).items() if not 0.0 < value < np.inf]
    if lags:
        raise DesignError(f"{where}: times of handover must be > 0 [s], got {', '.join(lags)}")
    if not len(knots):
        C, D = C[np.newaxis], D[np.newaxis]
    n, k = len(A), max(len(knots), 1)
    need = {"A": (n, n), "B": (n, 7), "C": (k, 2, n), "D": (k, 2, 7), "E": (n, 2)}
    for name, array in zip("ABCDE", (A, B, C, D, E), strict=True):
        if array.shape != need[name] or not np.isfinite(array).all():
            raise DesignError(f"{where}: {name} needs finite numbers of shape {need[name]}, got shape {array.shape}")
    if (np.diff(knots) <= 0.0).any() or len(knots) == 1:
        raise DesignError(
            f"{where}: dynamic_pressure_pa needs two or more numbers in rising order, got {knots.tolist()}"
        )
    return TrackingLaw(A=A, B=B, C=C, D=D, E=E, dynamic_pressure_pa=knots, handover=handover)
