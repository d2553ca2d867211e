"""What an aircraft is like without its laws, as a table."""

from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from fddbench.flight.envelope import infeasible_reasons
from fddbench.flight.transport.modes import modes_of
from fddbench.flight.transport.reading import read_aircraft, twin_jet

__all__ = ["modes"]

_MASSES_KG, _X_CG = (120e3, 180e3, 233e3), (0.17, 0.30, 0.41)
_ALTITUDES_FT, _SPEEDS_KT = (8e3, 18e3, 28e3, 38e3), (160.0, 220.0, 300.0)


def modes(path: str | Path | None = None) -> pd.DataFrame:
    """Trim and natural modes at the 108 points of Table 5 of the yaw-rate paper, and which of them cannot be flown.

    Parameters
    ----------
    path : path, optional
        File of an aircraft; the shipped twin-jet without.
    """
    aircraft = twin_jet() if path is None else read_aircraft(Path(path))
    condition = np.array(list(product(_MASSES_KG, _X_CG, _ALTITUDES_FT, _SPEEDS_KT))).T
    names = ("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
    mass, _, altitude, speed = condition
    reasons = infeasible_reasons(mass, altitude, speed, aircraft=aircraft)
    return pd.DataFrame(
        {**dict(zip(names, condition, strict=True)), **modes_of(aircraft, condition), "infeasible_reason": reasons}
    )
