"""The case table of a campaign: which number flies what."""

from dataclasses import dataclass
from math import prod

import numpy as np
import numpy.typing as npt

from fddbench.campaign.meaning import Campaign, Scenario
from fddbench.campaign.sampling import Runs, count, parameters
from fddbench.campaign.streams import flight_stream, scenario_stream
from fddbench.campaign.timing import faulty_sites, first_faulty_sample, flight_limit_s, flight_s, requirement_s
from fddbench.faults.specification import FaultSpecification
from fddbench.faults.timing import last_onset_s, samples
from fddbench.interfaces import Floats, Plant

__all__ = ["Plan", "PlannedScenario", "plan"]


@dataclass(frozen=True, kw_only=True)
class PlannedScenario:
    """A scenario in numbers.

    Attributes
    ----------
    scenario : Scenario
        What it is.
    first_case, n_runs : int
        Its cases are ``first_case ... first_case + n_runs - 1``.
    duration_s, n_samples : float, int
        Length of the flight [s], and samples 0 ... n_samples - 1.
    k0 : int or None
        First faulty sample; None in a healthy flight.
    faulty_sites : tuple of str
        Distinct faulty sites in the order of the benchmark.
    limit_s : float or None
        Detection time limit of the flight, from its first onset [s]; None in a healthy flight.
    event_limits_s : tuple of float
        Detection time limit of each fault by itself [s].
    stream : int
        Fourth word of the counter of its faults' random numbers.
    """

    scenario: Scenario
    first_case: int
    n_runs: int
    duration_s: float
    n_samples: int
    k0: int | None
    faulty_sites: tuple[str, ...]
    limit_s: float | None
    event_limits_s: tuple[float, ...]
    stream: int

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.scenario.entry.name

    @property
    def manoeuvre(self) -> str:
        """What is flown."""
        return self.scenario.entry.manoeuvre

    @property
    def faults(self) -> tuple[FaultSpecification, ...]:
        """Its faults in the order of the file: fault slot 0, 1, ..."""
        return self.scenario.faults

    @property
    def n_faulty(self) -> int:
        """Number of faulty sites."""
        return len(self.faulty_sites)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """All cases of a campaign, numbered scenario by scenario.

    Attributes
    ----------
    campaign : Campaign
        What is flown.
    scenarios : tuple of PlannedScenario
        In the order of the file.
    stream : int
        Fourth word of the counter of the flights' own random numbers.
    """

    campaign: Campaign
    scenarios: tuple[PlannedScenario, ...]
    stream: int

    @property
    def plant(self) -> Plant:
        """What flies."""
        return self.campaign.plant

    @property
    def n_cases(self) -> int:
        """Flights of the campaign."""
        return sum(scenario.n_runs for scenario in self.scenarios)

    @property
    def n_rows(self) -> int:
        """Rows of the result table: cases x detectors."""
        return self.n_cases * len(self.campaign.designs)

    def locate(self, cases: npt.ArrayLike) -> tuple[Runs, Runs]:
        """Position of the scenario and number of the run of cases; each (n,).

        Raises
        ------
        IndexError
            A case number outside 0 ... n_cases - 1.
        """
        numbers = np.asarray(cases, dtype=np.int64)
        if numbers.size and not (numbers.min() >= 0 and numbers.max() < self.n_cases):
            raise IndexError(f"need case numbers in 0 ... {self.n_cases - 1}, got {numbers.min()} ... {numbers.max()}")
        first = np.array([scenario.first_case for scenario in self.scenarios], dtype=np.int64)
        position = np.searchsorted(first, numbers, side="right") - 1
        return position, numbers - first[position]

    def parameters(self, cases: npt.ArrayLike) -> dict[str, Floats]:
        """Parameters of cases, true values, each (n,) in the unit of its name; every parameter of the benchmark."""
        position, runs = self.locate(cases)
        found = {entry.name: np.empty(len(runs)) for entry in self.plant.parameters}
        for number in np.unique(position):
            mine = position == number
            drawn = parameters(
                self.campaign.dispersions,
                self.plant.parameters,
                key=self.campaign.seed,
                purpose=self.campaign.purpose,
                runs=runs[mine],
                monte_carlo_runs=self.scenarios[number].scenario.entry.runs,
            )
            for name, values in drawn.items():
                found[name][mine] = values
        return found


def plan(campaign: Campaign) -> Plan:
    """Case table of a campaign; nothing is expanded."""
    planned: list[PlannedScenario] = []
    for scenario in campaign.scenarios:
        first = planned[-1].first_case + planned[-1].n_runs if planned else 0
        planned.append(_planned(scenario, campaign, first_case=first))
    return Plan(campaign=campaign, scenarios=tuple(planned), stream=flight_stream(campaign.purpose))


def _planned(scenario: Scenario, campaign: Campaign, *, first_case: int) -> PlannedScenario:
    faults, entry, plant = scenario.faults, scenario.entry, campaign.plant
    own_limit = entry.detection_time_limit_s
    given = campaign.duration_s if entry.duration_s is None else entry.duration_s
    duration = flight_s(faults, entry.manoeuvre, plant, duration_s=given, override_s=own_limit)
    return PlannedScenario(
        scenario=scenario,
        first_case=first_case,
        n_runs=prod(count(campaign.dispersions, monte_carlo_runs=entry.runs)),
        duration_s=duration,
        n_samples=samples(duration, campaign.sample_s) + 1,
        k0=first_faulty_sample(faults, campaign.sample_s),
        faulty_sites=tuple(site.name for site in faulty_sites(faults, plant.sites)),
        limit_s=flight_limit_s(faults, plant.sites, override_s=own_limit) if faults else None,
        event_limits_s=tuple(
            round(last_onset_s(fault) - fault.onset_s, 9) + requirement_s([fault], plant.sites, override_s=own_limit)
            for fault in faults
        ),
        stream=scenario_stream(campaign.purpose, entry.name),
    )
