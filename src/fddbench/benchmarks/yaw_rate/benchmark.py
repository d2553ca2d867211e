"""The yaw-rate benchmark as campaigns see it: what there is to choose."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fddbench.benchmarks.yaw_rate.plant import PLANT_NEEDS, YawRatePlant
from fddbench.benchmarks.yaw_rate.sensors import PRESETS
from fddbench.benchmarks.yaw_rate.unit_sites import plant_with_units
from fddbench.benchmarks.yaw_rate.winds import WINDS
from fddbench.interfaces import Choice, Floats, IdealModel, Loop, Options
from fddbench.kinds import Named
from fddbench.voting.closest_two import ClosestTwo
from fddbench.voting.median import Median
from fddbench.voting.monitored import Monitored

__all__ = ["YawRate"]

_PLANTS = Named(
    {
        "lateral_lpv": "fddbench.benchmarks.yaw_rate.plants.lateral_lpv:LateralLpvPlant",
        "transport_6dof": "fddbench.benchmarks.yaw_rate.plants.transport_6dof:Transport6Dof",
    }
)


def _of_file(path: Path) -> Any:
    """Plant of a file: an aircraft with six degrees of freedom."""
    return _PLANTS["transport_6dof"].of_file(path)


class YawRate:
    """Three yaw-rate sensors of a transport aircraft in closed loop through the voted signal.

    The published figures are percent of a confidential range; 40 deg/s is our choice (it makes all ten faults agree
    with the published detection times). Limits of 120 s for one faulty sensor and 0.36 s for two are inferred from the
    published normalised times, which are integers of 10 ms only over these; Runaway-A, 1.5 s, states its own.
    """

    name = "yaw_rate"
    about = "three yaw-rate sensors of a transport aircraft in closed loop"
    choices: Mapping[str, Choice] = {
        "plant": Choice(
            about="what flies",
            options=_PLANTS,
            family="plant",
            needs=PLANT_NEEDS,
            reads=_of_file,
        ),
        "voter": Choice(
            about="how the sensors are voted",
            options={"median": Median, "closest_two": ClosestTwo, "monitored": Monitored},
            family="voter",
            needs=("vote",),
        ),
        "sensors": Choice(
            about="noise and errors of the sensors",
            options=PRESETS,
            says={
                "iru": "inertial units, drawn: bias 0.02 deg/s, scale 0.1 %, tilt 0.1 deg, latency 5 to 20 ms; noise "
                "0.01 deg/s, quantum 0.0156 deg/s; sideslip 0.3 deg off, 0.1 s late; phi and p are voted, and fault sites too"
            },
            family="sensor",
            needs=("r_deg_s", "beta_deg", "p_deg_s", "phi_deg"),
        ),
        "wind": Choice(
            about="turbulence, or a gust from the left",
            options=WINDS,
            family="wind",
            needs=("states", "draws", "before", "prepare", "step"),
        ),
    }
    shown: tuple[str, ...] = ("r_deg_s", "r_voted_deg_s")
    limits_from = "inferred from the printed numbers"
    envelope_axes = (("v_cas_kt", "altitude_ft"), ("x_cg_ratio", "mass_kg"))
    published = "table8"

    def plant(self, chosen: Mapping[str, Any]) -> YawRatePlant:
        """The chosen plant; sensors of inertial units bring it more fault sites."""
        plain, has_units = chosen["plant"], getattr(chosen["sensors"], "errors", None) is not None
        plant: YawRatePlant = plant_with_units(plain) if has_units else plain
        return plant

    def loop(self, options: Options) -> Loop:
        """The loop that the chosen plant flies in, for these options."""
        return self.plant(options.chosen).loop(options)

    def ideal(
        self, chosen: Mapping[str, Any], parameters: Mapping[str, Floats], sample_s: float
    ) -> Mapping[str, IdealModel] | str:
        """What the ideal test knows of flights, as their plant says; see `fddbench.interfaces.Benchmark`."""
        own = getattr(self.plant(chosen), "ideal", None)
        return "this plant states no ideal model" if own is None else own(chosen, parameters, sample_s)
