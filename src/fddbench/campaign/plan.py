"""The case table of a campaign: which flights there are, and what each of them flies."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod

import numpy as np
import numpy.typing as npt

from fddbench.campaign.addresses import Address, Addresses, read_address
from fddbench.campaign.meaning import Campaign, Scenario
from fddbench.campaign.sampling import parameters, point_radices
from fddbench.campaign.streams import flight_stream, scenario_stream
from fddbench.campaign.timing import faulty_sites, flight_s, requirement_s
from fddbench.campaign.variation import Faults, at_levels, flown, variations
from fddbench.clock import samples
from fddbench.errors import FddbenchError, did_you_mean
from fddbench.faults.timing import latest_onset_s
from fddbench.interfaces import Floats, Plant

__all__ = ["Plan", "PlannedScenario", "plan"]

Cases = npt.NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class PlannedScenario:
    """A scenario in numbers.

    Attributes
    ----------
    scenario : Scenario
        What it is.
    first_case, n_points, n_levels, n_runs : int
        Its cases are ``first_case ... first_case + n_cases - 1``: the run is the fastest digit, then the level, then the
        point.
    durations_s, samples : tuple of float, of int
        Length of the flights of each level [s], and samples 0 ... samples - 1.
    faulty_sites : tuple of str
        Distinct faulty sites in the order of the benchmark.
    requirement_s : float or None
        Time within which the last fault must be found [s]; None in a healthy flight.
    event_requirements_s : tuple of float
        The same for each fault by itself.
    latest_onset_s : float or None
        Latest time at which a site can turn faulty [s].
    stream : int
        Fourth word of the counter of its faults' random numbers.
    """

    scenario: Scenario
    first_case: int
    n_points: int
    n_levels: int
    n_runs: int
    durations_s: tuple[float, ...]
    samples: tuple[int, ...]
    faulty_sites: tuple[str, ...]
    requirement_s: float | None
    event_requirements_s: tuple[float, ...]
    latest_onset_s: float | None
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
    def faults(self) -> Faults:
        """Its faults in the order of the file, as they are written: fault slot 0, 1, ..."""
        return self.scenario.faults

    @property
    def n_faulty(self) -> int:
        """Number of faulty sites."""
        return len(self.faulty_sites)

    @property
    def n_cases(self) -> int:
        """Flights of the scenario."""
        return self.n_points * self.n_levels * self.n_runs

    @property
    def flown_s(self) -> float:
        """Length of all its flights together [s]."""
        return self.n_points * self.n_runs * sum(self.durations_s)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """All cases of a campaign: (scenario, point, level, run), the last fastest.

    A case's number is its place in this plan and no part of any result; its name is its address, ``jam_a/3/0/17``.

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
        return sum(scenario.n_cases for scenario in self.scenarios)

    @property
    def n_rows(self) -> int:
        """Rows of the result table: cases x detectors."""
        return self.n_cases * len(self.campaign.designs)

    @property
    def n_kept(self) -> int:
        """Rows that are kept whatever is in them: all, or those of the first runs of every scenario."""
        if self.campaign.keep == "all":
            return self.n_rows
        most = self.campaign.kept_runs
        return sum(s.n_points * s.n_levels * min(s.n_runs, most) for s in self.scenarios) * len(self.campaign.designs)

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """Columns of what differs between the faults of flights, ``f1_amplitude_percent``, of all scenarios."""
        found = {(each.line, each.key): each.column for s in self.scenarios for each in variations(s.faults)}
        return tuple(found[at] for at in sorted(found))

    @property
    def gain_columns(self) -> tuple[str, ...]:
        """Columns of the gains of detectors that are swept, ``gain_threshold_deg_s``."""
        return self.campaign.gain_columns

    def locate(self, cases: npt.ArrayLike) -> Addresses:
        """Addresses of cases by their numbers.

        Raises
        ------
        IndexError
            A case number outside 0 ... n_cases - 1.
        """
        numbers = np.asarray(cases, dtype=np.int64)
        if numbers.size and not (numbers.min() >= 0 and numbers.max() < self.n_cases):
            raise IndexError(f"need case numbers in 0 ... {self.n_cases - 1}, got {numbers.min()} ... {numbers.max()}")
        scenario = np.searchsorted(self._radices[0], numbers, side="right") - 1
        first, n_levels, n_runs = self._radices[:, scenario]
        rest, run = np.divmod(numbers - first, n_runs)
        point, level = np.divmod(rest, n_levels)
        return Addresses(scenario=scenario, point=point, level=level, run=run)

    @cached_property
    def _radices(self) -> Cases:
        """First case, levels and runs of every scenario, (3, n_scenarios)."""
        return np.array([(s.first_case, s.n_levels, s.n_runs) for s in self.scenarios], dtype=np.int64).T

    def n_samples(self, cases: npt.ArrayLike) -> Cases:
        """Samples of the flights of cases, (n,)."""
        at = self.locate(cases)
        found = np.empty(len(at.scenario), dtype=np.int64)
        for s in np.unique(at.scenario).tolist():
            mine = at.scenario == s
            found[mine] = np.array(self.scenarios[s].samples)[at.level[mine]]
        longest_s = getattr(self.plant, "longest_s", None)
        if longest_s is not None:
            whole = np.floor(longest_s(self.parameters(cases)) / self.campaign.sample_s + 1e-6)
            found = np.minimum(found, whole.astype(np.int64) + 1)
        return found

    @property
    def n_labelled(self) -> int:
        """The most faults that a flight brings with it, because they are in what flies."""
        count = getattr(self.plant, "n_labelled", None)
        return 0 if count is None else int(count())

    def names(self, cases: npt.ArrayLike) -> tuple[str, ...]:
        """Names of cases, ``jam_a/3/0/17``."""
        at = self.locate(cases)
        known = [scenario.name for scenario in self.scenarios]
        rows = zip(*(part.tolist() for part in (at.scenario, at.point, at.level, at.run)), strict=True)
        return tuple(f"{known[s]}/{point}/{level}/{run}" for s, point, level, run in rows)

    def numbers(self, cases: Sequence[Address], scenario: str | None = None) -> Cases:
        """Numbers of cases by their addresses, ``"jam_a/3/0/17"``, or ``"3/0/17"`` or (3, 0, 17) in a scenario.

        Raises
        ------
        FddbenchError
            There is no such case.
        """
        return np.array([self._number(case, scenario) for case in cases], dtype=np.int64)

    def _number(self, case: Address, scenario: str | None) -> int:
        name, *digits = read_address(case, scenario)
        own = {planned.name: planned for planned in self.scenarios}
        if name not in own:
            hint = " ".join(filter(None, [did_you_mean(name, own), f"Known: {', '.join(own)}"]))
            raise FddbenchError(f"campaign {self.campaign.name!r} has no scenario {name!r}. {hint}")
        planned = own[name]
        for what, digit, n in zip(
            ("point", "level", "run"), digits, (planned.n_points, planned.n_levels, planned.n_runs), strict=True
        ):
            if not 0 <= digit < n:
                raise FddbenchError(f"there is no case {case!r}: scenario {name!r} has the {what}s 0 to {n - 1}")
        point, level, run = digits
        return planned.first_case + (point * planned.n_levels + level) * planned.n_runs + run

    def parameters(self, cases: npt.ArrayLike) -> dict[str, Floats]:
        """Parameters of cases, true values, each (n,) in the unit of its name; every parameter of the benchmark."""
        at = self.locate(cases)
        return parameters(
            self.campaign.dispersions,
            self.plant.parameters,
            key=self.campaign.seed,
            purpose=self.campaign.purpose,
            points=at.point,
            runs=at.run,
            table=self.campaign.table,
        )

    def flown(self, scenario: int, level: Cases, run: Cases) -> tuple[Faults, dict[str, Floats]]:
        """Faults of flights of a scenario, and what differs between them by column; see `variation.flown`."""
        planned, campaign = self.scenarios[scenario], self.campaign
        return flown(
            planned.faults, level=level, run=run, key=campaign.seed, stream=planned.stream, sample_s=campaign.sample_s
        )


def plan(campaign: Campaign) -> Plan:
    """Case table of a campaign; no flight is expanded."""
    planned: list[PlannedScenario] = []
    for scenario in campaign.scenarios:
        first = planned[-1].first_case + planned[-1].n_cases if planned else 0
        planned.append(_planned(scenario, campaign, first_case=first))
    return Plan(campaign=campaign, scenarios=tuple(planned), stream=flight_stream(campaign.purpose))


def _planned(scenario: Scenario, campaign: Campaign, *, first_case: int) -> PlannedScenario:
    faults, entry, plant = scenario.faults, scenario.entry, campaign.plant
    limit = entry.detection_time_limit_s
    given = campaign.duration_s if entry.duration_s is None else entry.duration_s
    durations = tuple(
        flight_s(at_level, entry.manoeuvre, plant, duration_s=given, override_s=limit) for at_level in at_levels(faults)
    )
    drawn = campaign.dispersions.monte_carlo
    return PlannedScenario(
        scenario=scenario,
        first_case=first_case,
        n_points=prod(point_radices(campaign.dispersions)),
        n_levels=len(durations),
        n_runs=entry.runs or (drawn.runs if drawn else 1),
        durations_s=durations,
        samples=tuple(samples(duration, campaign.sample_s) + 1 for duration in durations),
        faulty_sites=tuple(site.name for site in faulty_sites(faults, plant.sites)),
        requirement_s=requirement_s(faults, plant.sites, override_s=limit) if faults else None,
        event_requirements_s=tuple(requirement_s([fault], plant.sites, override_s=limit) for fault in faults),
        latest_onset_s=max(map(latest_onset_s, faults), default=None),
        stream=scenario_stream(campaign.purpose, entry.name),
    )
