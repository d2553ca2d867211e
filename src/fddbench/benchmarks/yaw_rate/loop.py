"""One sample of the closed loop: sense, break, vote, order, actuate, fly."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench import registry
from fddbench.benchmarks.yaw_rate import lateral_lpv_plant as plant
from fddbench.benchmarks.yaw_rate.control_law import LateralLaw
from fddbench.benchmarks.yaw_rate.manoeuvres import KNOTS, bank_commands
from fddbench.benchmarks.yaw_rate.sensors import PRESETS
from fddbench.blocks import consumers
from fddbench.blocks.functions import asin, interpolate
from fddbench.blocks.layout import Layout, Rows
from fddbench.faults.injection import FaultStep
from fddbench.faults.specification import FaultSpecification
from fddbench.flight import turbulence
from fddbench.interfaces import Bus, FaultUnits, Flights, Floats, Options, Start

__all__ = ["LateralLoop"]

_DEG = 180.0 / np.pi
_DEPARTED_RAD = np.pi / 2.0
"""Beyond this bank angle the lateral model means nothing and the flight has departed."""


class LateralLoop:
    """Closed loop of the yaw-rate benchmark, see `fddbench.interfaces.Loop`.

    The measured bus holds what a flight computer has: bank and sideslip angle, roll rate, three yaw rates and the voted
    one, surface positions, airspeeds, mass, X_cg and altitude, all with their measurement errors.
    """

    truth = (
        "phi_true_deg",
        "beta_true_deg",
        "p_true_deg_s",
        "r_true_deg_s",
        "psi_deg",
        "y_m",
        "gust_m_s",
        "bank_command_deg",
    )

    def __init__(self, options: Options, sites: tuple[str, ...], units: FaultUnits) -> None:
        self.sample_s, self.substeps = options.sample_s, options.substeps
        self.noise = PRESETS[options.sensors]
        self.voter = registry.load("voter", options.voter)()
        self.units = units
        self.faults = FaultStep(sites, options.fault_slots, options.sample_s)
        self.law = LateralLaw(sample_s=options.sample_s)
        self.actuators = plant.actuators(options.sample_s)
        self.wind_m_s = turbulence.WINDS_M_S[options.wind]
        self.windy = self.wind_m_s > 0.0
        self.consumers = (consumers.SENSORS_A, consumers.SENSORS_B, *((consumers.GUST,) if self.windy else ()))
        self.fault_consumers = tuple(consumers.FAULT_SLOT_0 + j for j in range(options.fault_slots))
        self.start_consumers = (consumers.START,)
        gust = {"gust": 2} if self.windy else {}
        self.states = Layout(
            aircraft=plant.STATES.size, surface_deg=13, integral_rad_s=0, faults=self.faults.states.size, **gust
        )
        self.constants = Layout(
            **dict.fromkeys(plant.CONSTANTS.names, 0),
            **({"gust": turbulence.GUST_CONSTANTS.size} if self.windy else {}),
            knots_s=KNOTS,
            bank_deg=KNOTS,
            faults=self.faults.constants.size,
        )
        self.bus = Bus(
            sample_s=options.sample_s,
            sites=sites,
            signals={
                **dict.fromkeys(("phi_deg", "beta_deg", "p_deg_s", "r_voted_deg_s", "v_tas_m_s"), 0),
                "r_deg_s": 3,
                "surface_deg": 13,
                **dict.fromkeys(("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt"), 0),
            },
        )

    def fault_rows(self, faults: Sequence[FaultSpecification], phases: Floats) -> Floats:
        """Data rows of the faults of a scenario, see `fddbench.interfaces.Loop.fault_rows`."""
        return self.faults.rows(faults, self.units, phases)

    def start(self, flights: Flights) -> Start:
        """Wings level in trim: all lateral states are zero, the gust is stationary."""
        constants, reasons = plant.prepare(flights.parameters)
        n_cases = len(reasons)
        knots_s, bank_deg = bank_commands(flights.manoeuvres, constants["v_tas_m_s"])
        gust, gust_constants = {}, {}
        if self.windy:
            gust = {"gust": turbulence.gust_start(flights.normals)}
            gust_constants = {
                "gust": turbulence.gust_constants(
                    sigma_m_s=self.wind_m_s * flights.parameters["gust_scale_ratio"],
                    v_tas_m_s=constants["v_tas_m_s"],
                    sample_s=self.sample_s,
                )
            }
        return Start(
            state=self.states.pack(
                aircraft=plant.STATES.zeros(n_cases),
                surface_deg=np.zeros((13, n_cases)),
                integral_rad_s=np.zeros(n_cases),
                faults=self.faults.states.zeros(n_cases),
                **gust,
            ),
            constants=self.constants.pack(
                **constants, **gust_constants, knots_s=knots_s, bank_deg=bank_deg, faults=flights.faults
            ),
            infeasible_reason=reasons,
        )

    def step(
        self, state: Rows, constants: Rows, normals: Rows, sample: Any
    ) -> tuple[Rows, SimpleNamespace, Mapping[str, Rows], Rows]:
        """One sample, see `fddbench.interfaces.Loop.step`."""
        x, c = self.states.unpack(state), self.constants.unpack(constants)
        air = plant.STATES.unpack(x.aircraft)
        gust = turbulence.gust_m_s(x.gust, c.gust) if self.windy else np.zeros_like(air.v_y_m_s)
        beta_deg = _DEG * asin((air.v_y_m_s - gust) / c.v_tas_m_s)
        measured, faults = self._measure(x, c, air, beta_deg, normals, sample)
        command_deg = interpolate(sample * self.sample_s, c.knots_s, c.bank_deg)
        integral, orders = self.law.step(x.integral_rad_s, measured, command_deg)
        moved = self.actuators.step(x.surface_deg, orders, *plant.travel(c.rudder_travel_deg))
        flown = plant.fly(x.aircraft, x.surface_deg, gust, c, self.sample_s, self.substeps)
        windy = {"gust": turbulence.gust_step(x.gust, c.gust, normals[8:10])} if self.windy else {}
        after = self.states.pack(aircraft=flown, surface_deg=moved, integral_rad_s=integral, faults=faults, **windy)
        truth = dict(
            zip(
                self.truth,
                (
                    _DEG * air.phi_rad,
                    beta_deg,
                    _DEG * air.p_rad_s,
                    _DEG * air.r_rad_s,
                    _DEG * air.psi_rad,
                    air.y_m,
                    gust,
                    command_deg,
                ),
                strict=True,
            )
        )
        departed = ~(np.abs(air.phi_rad) <= _DEPARTED_RAD)
        return after, measured, truth, departed

    def _measure(
        self, x: SimpleNamespace, c: SimpleNamespace, air: SimpleNamespace, beta_deg: Rows, normals: Rows, sample: Any
    ) -> tuple[SimpleNamespace, Floats]:
        """Measured bus at this sample, and the state of the fault step at the next."""
        healthy = self.noise.r(_DEG * air.r_rad_s, normals)
        first = 4 * len(self.consumers)
        slots = [normals[first + 4 * j : first + 4 * j + 4] for j in range(self.faults.slots)]
        r_deg_s, faults = self.faults.step(healthy, x.faults, c.faults, slots, sample)
        beta, p, phi = self.noise.others(beta_deg, _DEG * air.p_rad_s, _DEG * air.phi_rad, normals)
        measured = SimpleNamespace(
            phi_deg=phi,
            beta_deg=beta,
            p_deg_s=p,
            r_deg_s=r_deg_s,
            r_voted_deg_s=self.voter.vote(r_deg_s),
            surface_deg=x.surface_deg,
            v_tas_m_s=c.v_tas_measured_m_s,
            mass_kg=c.mass_measured_kg,
            x_cg_ratio=c.x_cg_measured_ratio,
            altitude_ft=c.altitude_measured_ft,
            v_cas_kt=c.v_cas_measured_kt,
        )
        return measured, faults
