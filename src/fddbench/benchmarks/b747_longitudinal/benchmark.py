"""The longitudinal Boeing 747 as campaigns see it: what there is to choose."""

from collections.abc import Mapping
from typing import Any

from fddbench.benchmarks.b747_longitudinal.law import LAW_NEEDS
from fddbench.benchmarks.b747_longitudinal.laws.open_loop import OpenLoop
from fddbench.benchmarks.b747_longitudinal.laws.tracking import Hinf, Lqi, Scheduled
from fddbench.benchmarks.b747_longitudinal.loop import LongitudinalLoop
from fddbench.benchmarks.b747_longitudinal.plant import PLANT_NEEDS, LongitudinalPlant
from fddbench.benchmarks.b747_longitudinal.plants.affine import LpvApprox, LpvFold
from fddbench.benchmarks.b747_longitudinal.plants.nonlinear import Nonlinear
from fddbench.benchmarks.b747_longitudinal.sensors import PRESETS
from fddbench.flight.dryden import LONGITUDINAL_WINDS
from fddbench.interfaces import Choice, Detectability, Floats, Options

__all__ = ["B747Longitudinal"]


def _smallest_loss(site: str, *, times: str, hatch_below: float = 0.0) -> Detectability:
    """Map of the smallest loss of what a site does in trim, over the envelope."""
    axes = ("v_tas_m_s", "altitude_m")
    return Detectability(site=site, size="loss_percent", axes=axes, times=times, hatch_below=hatch_below)


class B747Longitudinal:
    """Elevator and thrust of a Boeing 747-100/200 whose law tracks flight-path angle and airspeed.

    The aircraft of the LPV detection-filter paper: a nonlinear model of five states, and its affine LPV model as another
    plant. Losses of effectiveness act on the total deflection and thrust, trim included. A law may be brought from a file.
    """

    name = "b747_longitudinal"
    about = "longitudinal Boeing 747-100/200 in closed loop, elevator and thrust"
    choices: Mapping[str, Choice] = {
        "plant": Choice(
            about="what flies",
            options={"nonlinear": Nonlinear, "lpv_fold": LpvFold, "lpv_approx": LpvApprox},
            family="plant",
            needs=PLANT_NEEDS,
        ),
        "law": Choice(
            about="how flight-path angle and airspeed are tracked",
            options={"hinf": Hinf, "lqi": Lqi, "scheduled": Scheduled, "open_loop": OpenLoop},
            family="law",
            needs=LAW_NEEDS,
        ),
        "sensors": Choice(
            about="noise of the sensors",
            options=PRESETS,
            family="sensor",
            needs=(
                *("alpha_deg", "q_deg_s", "v_tas_m_s", "theta_deg", "altitude_m", "gamma_deg", "acceleration_m_s2"),
                *("elevator_deg", "stabiliser_deg", "thrust_n"),
            ),
        ),
        "wind": Choice(
            about="longitudinal turbulence",
            options=LONGITUDINAL_WINDS,
            family="wind",
            needs=("states", "draws", "before", "prepare", "step"),
        ),
    }
    shown: tuple[str, ...] = ("gamma_true_deg", "v_tas_true_m_s", "elevator_true_deg", "thrust_true_n")
    limits_from = "our choice: 10 s for the elevator, 20 s for the thrust"
    envelope_axes = (("v_tas_m_s", "altitude_m"), ("x_cg_ratio", "mass_kg"))
    detectability = (
        _smallest_loss("elevator", times="elevator_trim_deg", hatch_below=0.3),
        _smallest_loss("thrust", times="thrust_trim_n"),
    )

    def plant(self, chosen: Mapping[str, Any]) -> LongitudinalPlant:
        """The chosen plant."""
        plant: LongitudinalPlant = chosen["plant"]
        return plant

    def loop(self, options: Options) -> LongitudinalLoop:
        """Closed loop for these options."""
        chosen = options.chosen
        plant = chosen["plant"](options.sample_s, options.substeps)
        law = chosen["law"](options.sample_s)
        return LongitudinalLoop(plant, plant.sites, law, chosen["sensors"], chosen["wind"], options)

    def derived(self, chosen: Mapping[str, Any], parameters: Mapping[str, Floats]) -> dict[str, Floats]:
        """Trim elevator [deg] of flights with these parameters, which a loss of effectiveness multiplies."""
        at = chosen["plant"](0.01, 1).trimmed(parameters)
        return {"elevator_trim_deg": at.elevator_deg, "thrust_trim_n": at.thrust_n}
