"""The keys of a recipe that makes a `yaw_rate_best`, and the gains that they give."""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator
from scipy.linalg import expm, solve_discrete_are

from fddbench.campaign.rules.model import Strict
from fddbench.design.lateral_table import Fitted, lpv_table, transport_table
from fddbench.design.recipes.recipe import Made, Recipe, short
from fddbench.errors import DesignError
from fddbench.flight.atmosphere import true_airspeed_m_s
from fddbench.flight.lateral_lpv import SCHEDULING, lateral_lpv
from fddbench.flight.transport.reading import read_aircraft, twin_jet
from fddbench.flight.turbulence import SCALE_LENGTH_M
from fddbench.interfaces import Floats
from fddbench.units import DEG_PER_RAD

__all__ = ["YawRateBestRecipe"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Range = tuple[Positive, Positive]


class Envelope(Strict):
    """Where the aircraft flies: lowest and highest of each."""

    mass_kg: Range
    x_cg_ratio: Range
    altitude_ft: tuple[NonNegative, Positive]
    v_cas_kt: Range


class Noise(Strict):
    """What the filters believe of sensors, air and model.

    Attributes
    ----------
    rate_deg_s, vane_deg : float
        One sigma a sample of a yaw-rate sensor and of the sideslip vane [deg/s, deg].
    acceleration_deg_s2, acceleration_s : float
        Yaw acceleration that the model does not know: standard deviation, correlation time [deg/s^2, s].
    gust_m_s : float
        Standard deviation of the lateral gust [m/s]; its correlation time is L / V.
    turn_deg_s_root_s : float
        How far an unknown turn rate wanders in a second [deg/s].
    turn_s : float
        Correlation time of that turn rate [s].
    """

    rate_deg_s: Positive
    vane_deg: Positive
    acceleration_deg_s2: Positive
    acceleration_s: Positive
    gust_m_s: Positive
    turn_deg_s_root_s: Positive
    turn_s: Positive


class Decision(Strict):
    """Numbers of the decision that are copied into the gains, see `YawRateBestGains`."""

    smooth_s: Positive
    floor_deg_s: Positive
    floor_deg: Positive
    level_ratio: tuple[NonNegative, NonNegative]
    level_s: Positive
    most: Positive
    differ_deg_s: Positive
    differ_per_roll: NonNegative
    differ_s: Positive
    offset_s: Positive
    offset_deg_s: NonNegative
    rest_s: Positive
    memory_s: Positive
    evidence_one: Positive
    evidence_two: Positive


class YawRateBestRecipe(Recipe):
    """How the numbers of a `yaw_rate_best` design come about: an aircraft linearised, two steady Kalman filters.

    Attributes
    ----------
    aircraft : str
        ``lateral_lpv``, the published model; ``transport_6dof``, the shipped twin-jet; or the file of another one,
        ``mine.yaml``, beside the design.
    envelope : Envelope, or None
        Where an aircraft with six degrees of freedom is linearised; the published model has its own box.
    degree, points : int
        Of the polynomials; how many trims they are fitted to.
    sample_s : float
        Clock [s].
    beta_lag_s : float
        Time constant of the vane that is allowed for [s].
    noise, decision
        See there.
    """

    aircraft: str = "lateral_lpv"
    envelope: Envelope | None = None
    degree: Literal[1, 2, 3] = 2
    points: Annotated[int, Field(ge=50, le=5000)] = 600
    sample_s: Positive
    beta_lag_s: NonNegative
    noise: Noise
    decision: Decision

    @model_validator(mode="after")
    def _consistent(self) -> "YawRateBestRecipe":
        if (self.aircraft == "lateral_lpv") != (self.envelope is None):
            raise ValueError(
                "envelope: lateral_lpv has a box of its own and takes none; every other aircraft needs one, the ranges of "
                f"{', '.join(SCHEDULING)}"
            )
        for name, (low, high) in (self.envelope.model_dump() if self.envelope else {}).items():
            if not low < high:
                raise ValueError(f"envelope: {name} needs low < high, got [{low}, {high}]")
        return self

    def make(self) -> Made:
        """Table of the aircraft, gains at the middle of its envelope, and how well the table fits."""
        fitted = self._fitted()
        centre = fitted.table["centre"]
        v_tas_m_s = float(true_airspeed_m_s(np.array([centre[3]]), np.array([centre[2]]))[0])
        n_r = float(fitted.table["yaw"][2][0])
        yaw_gain, keeps_a = _yaw_filter(self.noise, n_r, self.sample_s)
        slip_gain, keeps_gust, keeps_turn = _slip_filter(self.noise, v_tas_m_s, self.sample_s)
        gains = {
            "sample_s": self.sample_s,
            "table": dict(fitted.table),
            "beta_lag_s": self.beta_lag_s,
            "yaw_gain": [short(value) for value in yaw_gain],
            "slip_gain": [short(value) for value in slip_gain],
            "keeps": [short(value) for value in (keeps_a, keeps_gust, keeps_turn)],
            **self.decision.model_dump(mode="json"),
        }
        found = {
            "v_tas_m_s": short(v_tas_m_s),
            "largest_yaw_error_percent": [short(100.0 * e) for e in fitted.yaw_error],
            "largest_side_error_percent": [short(100.0 * e) for e in fitted.side_error],
        }
        return Made(gains=gains, found=found)

    def _fitted(self) -> Fitted:
        if self.aircraft == "lateral_lpv":
            return lpv_table(lateral_lpv())
        assert self.envelope is not None
        shipped = self.aircraft == "transport_6dof"
        path = self.beside / Path(self.aircraft)
        if not (shipped or path.is_file()):
            raise DesignError(
                f"recipe.aircraft: {self.aircraft!r} is neither lateral_lpv nor transport_6dof, and there is no file {path}"
            )
        aircraft = twin_jet() if shipped else read_aircraft(path)
        return transport_table(aircraft, self.envelope.model_dump(), self.degree, self.points)


def _yaw_filter(noise: Noise, n_r: float, sample_s: float) -> tuple[Floats, float]:
    """Gains of ``r' = N_r r + a`` on a sensor of r, and what is left of a after a sample."""
    A = np.array([[n_r, 1.0], [0.0, -1.0 / noise.acceleration_s]])
    q = 2.0 * noise.acceleration_deg_s2**2 / noise.acceleration_s
    # what is not white in a sensor looks to the filter like a rate that wanders a little
    Q = np.diag([noise.rate_deg_s**2 / 4.0, q])
    K = _steady(A, np.array([[1.0, 0.0]]), Q, noise.rate_deg_s, sample_s)
    return K, 1.0 - sample_s / noise.acceleration_s


def _slip_filter(noise: Noise, v_tas_m_s: float, sample_s: float) -> tuple[Floats, float, float]:
    """Gains of ``path' = d``, gust, and d on the vane, ``beta = path - gust``; what is left of gust and d after a sample."""
    gust_s = SCALE_LENGTH_M / v_tas_m_s
    # Dryden's lateral gust is steeper than a first-order one by sqrt 3 in its derivative
    gust_deg = DEG_PER_RAD * noise.gust_m_s / v_tas_m_s
    A = np.zeros((3, 3))
    A[0, 2], A[1, 1], A[2, 2] = 1.0, -1.0 / gust_s, -1.0 / noise.turn_s
    Q = np.diag([1e-4, 3.0 * gust_deg**2 / gust_s, noise.turn_deg_s_root_s**2])
    K = _steady(A, np.array([[1.0, -1.0, 0.0]]), Q, noise.vane_deg, sample_s)
    return K, 1.0 - sample_s / gust_s, 1.0 - sample_s / noise.turn_s


def _steady(A: Floats, C: Floats, Q: Floats, sigma: float, sample_s: float) -> Floats:
    """Gain of the steady filter, (n,), that corrects by a measurement and then predicts."""
    F = expm(A * sample_s)
    try:
        P = solve_discrete_are(F.T, C.T, Q * sample_s, np.array([[sigma**2]]))
    except (np.linalg.LinAlgError, ValueError) as error:
        raise DesignError(
            f"recipe.noise: no steady Kalman filter ({error}); bring the sizes of sensors, gust and model closer together"
        ) from error
    gain: Floats = (P @ C.T / (C @ P @ C.T + sigma**2))[:, 0]
    return gain
