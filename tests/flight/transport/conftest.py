"""Flights of the twin-jet, and the grid of Table 5 of the yaw-rate paper."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from fddbench.flight.atmosphere import FT_M, true_airspeed_m_s
from fddbench.flight.transport.body import body_of
from fddbench.flight.transport.reading import twin_jet
from fddbench.flight.transport.trim import trim

TABLE_5 = np.array(
    list(product((120e3, 180e3, 233e3), (0.17, 0.30, 0.41), (8e3, 18e3, 28e3, 38e3), (160.0, 220.0, 300.0)))
).T


def trimmed(mass_kg, x_cg_ratio, altitude_ft, v_cas_kt, *, aircraft=None):
    """Body and trim of flights."""
    aircraft = aircraft or twin_jet()
    m, x, h, v = np.broadcast_arrays(*map(np.atleast_1d, (mass_kg, x_cg_ratio, altitude_ft, v_cas_kt)))
    m, x, h, v = (np.array(each, dtype=float) for each in (m, x, h, v))
    body = body_of(aircraft, m, x)
    return body, trim(aircraft, body, true_airspeed_m_s(v, h), h * FT_M)


@pytest.fixture(scope="session")
def twin():
    """Namespace of the above; test modules are not packages and cannot import them."""
    return SimpleNamespace(jet=twin_jet(), trimmed=trimmed, table_5=TABLE_5)
