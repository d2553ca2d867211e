"""Plants of one's own on the yaw-rate benchmark: more sites, more sensors, other aerodynamics."""

from dataclasses import replace

from fddbench.benchmarks.yaw_rate.plant import SITES
from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant
from fddbench.interfaces import Site


class WithRudder(LateralLpvPlant):
    sites = (
        *SITES,
        Site(name="rudder", kind="actuator", signal="surface_deg", unit_name="deg", admissible=30.0, limits_s=(5.0,)),
    )


class SevenSensors(LateralLpvPlant):
    sites = tuple(replace(SITES[0], name=f"r{row + 1}", row=row) for row in range(7))


class WeakFin(LateralLpvPlant):
    def prepare(self, parameters, manoeuvres):
        return super().prepare({**parameters, "delta_c_n_percent": parameters["delta_c_n_percent"] - 20.0}, manoeuvres)
