"""Faults that are in what flies already, and when they must be found."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.campaign.plan import Plan
from fddbench.interfaces import NEVER, Floats, LoggedFaults
from fddbench.interfaces.site import limit_s

__all__ = ["add_labelled", "in_what_flies", "names_of"]


def in_what_flies(plan: Plan, parameters: Mapping[str, Floats]) -> LoggedFaults:
    """Faults that flights bring with them."""
    plant: Any = plan.plant
    found: LoggedFaults = plant.labelled(parameters, plan.campaign.sample_s)
    return found


def add_labelled(found: Any, plan: Plan, own: LoggedFaults, scenario: npt.NDArray[np.int64], injected: int) -> None:
    """Write their times into the last lines of `BatchFaults`, and the limits of flights that have any.

    Parameters
    ----------
    found : BatchFaults
        With the faults of the scenarios in its first lines.
    scenario : (n_cases,) array
        Of each flight.
    injected : int
        Number of those lines.
    """
    lines, sample_s = slice(injected, None), plan.campaign.sample_s
    found.first[lines], found.last[lines] = own.first.min(axis=1, initial=NEVER), own.last
    found.last_onset[lines] = np.where(own.first < NEVER, own.first, -1.0).max(axis=1, initial=-1.0)
    found.last_onset[lines] = np.where(found.first[lines] < NEVER, found.last_onset[lines], NEVER)
    there = np.concatenate([own.first < NEVER, np.zeros((1, *own.first.shape[1:]), dtype=bool)])
    for case in np.flatnonzero(there.any(axis=(0, 1))).tolist():
        planned = plan.scenarios[scenario[case]]
        override = planned.scenario.entry.detection_time_limit_s
        for line in np.flatnonzero(there[:, :, case].any(axis=1)).tolist():
            at = injected + line
            apart = found.last_onset[at, case] - found.first[at, case]
            own_s = _requirement_s(plan, there[line, :, case], override)
            found.event_limits_s[at, case] = round(float(apart) * sample_s, 9) + own_s
        faulty = there[:, :, case].any(axis=0)
        faulty |= np.array([site.name in planned.faulty_sites for site in plan.plant.sites])
        begun = found.first[:, case] < NEVER
        apart = found.last_onset[begun, case].max() - found.first[begun, case].min()
        found.limit_s[case] = round(float(apart) * sample_s, 9) + _requirement_s(plan, faulty, override)


def _requirement_s(plan: Plan, faulty: npt.NDArray[np.bool_], override_s: float | None) -> float:
    if override_s is not None:
        return override_s
    return limit_s([site for site, is_faulty in zip(plan.plant.sites, faulty, strict=True) if is_faulty])


def names_of(faulty: npt.NDArray[np.bool_], sites: tuple[str, ...]) -> list[str]:
    """Names joined by + of faulty sites, (n_sites, n_cases), of each flight."""
    return ["+".join(site for site, one in zip(sites, column, strict=True) if one) for column in faulty.T]
