"""The yaw-rate benchmark as campaigns see it: choices, parameters, manoeuvres, requirements."""

from collections.abc import Mapping

from fddbench.benchmarks.yaw_rate.loop import LateralLoop
from fddbench.benchmarks.yaw_rate.manoeuvres import DURATIONS_S
from fddbench.benchmarks.yaw_rate.parameters import PARAMETERS, REFUSED
from fddbench.benchmarks.yaw_rate.sensors import PRESETS
from fddbench.flight.turbulence import WINDS_M_S
from fddbench.interfaces import FaultUnits, Options, Parameter

__all__ = ["YawRate"]


class YawRate:
    """Three yaw-rate sensors of a transport aircraft in closed loop through the voted signal.

    The published figures are percent of a confidential range; 40 deg/s is our choice (it makes all ten faults agree
    with the published detection times). Limits of 120 s for one faulty sensor and 0.36 s for two are inferred from the
    published normalised times, which are integers of 10 ms only over these; Runaway-A, 1.5 s, states its own.
    """

    name = "yaw_rate"
    about = "three yaw-rate sensors of a transport aircraft in closed loop"
    sites: tuple[str, ...] = ("r1", "r2", "r3")
    parameters: tuple[Parameter, ...] = PARAMETERS
    refused_parameters: Mapping[str, str] = REFUSED
    plants: tuple[str, ...] = ("lateral_lpv",)
    voters: tuple[str, ...] = ("median", "closest_two")
    sensors: tuple[str, ...] = tuple(PRESETS)
    winds: tuple[str, ...] = tuple(WINDS_M_S)
    manoeuvres: Mapping[str, float] = DURATIONS_S
    fault_units = FaultUnits(unit="deg/s", admissible=40.0, sensor_range=128.0)
    shown: tuple[str, ...] = ("r_deg_s", "r_voted_deg_s")
    limits_from = "inferred from the printed numbers"

    def detection_time_limit_s(self, n_faulty: int) -> float:
        """Requirement by number of faulty sensors [s]: 120 for one, 0.36 for two or more."""
        return 120.0 if n_faulty <= 1 else 0.36

    def loop(self, options: Options) -> LateralLoop:
        """Closed loop for these options."""
        return LateralLoop(options, self.sites, self.fault_units)
