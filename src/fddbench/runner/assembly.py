"""A campaign made ready to fly: its closed loop, its detectors, and batches of cases with all their constants."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fddbench.blocks import philox
from fddbench.campaign.meaning import Campaign, build_detectors
from fddbench.campaign.plan import Plan, PlannedScenario, plan
from fddbench.faults.injection import first_samples
from fddbench.interfaces import Detector, Flights, Floats, Loop, Options
from fddbench.metrics.scoring import NEVER, EventTimes, Scoring

__all__ = ["BEFORE_START", "Assembly", "Batch", "assemble", "has_events"]

Cases = npt.NDArray[np.int64]

BEFORE_START = 0xFFFFFFFF
"""First counter word of what is drawn before sample 0; no flight has so many samples."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Batch:
    """Cases ready at sample 0.

    Attributes
    ----------
    cases, scenario, run : (n_cases,) arrays
        Case numbers, positions of their scenarios, and run numbers.
    parameters : mapping of str to (n_cases,) arrays
        True parameter values.
    state, constants, score_constants : (n_rows, n_cases) arrays
        Of the loop and of the scoring.
    scenario_stream : (n_cases,) array
        Fourth counter word of the faults' random numbers.
    infeasible_reason : tuple of str
        Why a case cannot fly; "" for one that can.
    """

    cases: Cases
    scenario: Cases
    run: Cases
    parameters: Mapping[str, Floats]
    state: Floats
    constants: Floats
    score_constants: Floats
    scenario_stream: Cases
    infeasible_reason: tuple[str, ...]

    def take(self, which: Cases) -> "Batch":
        """Some of the cases."""
        return Batch(
            cases=self.cases[which],
            scenario=self.scenario[which],
            run=self.run[which],
            parameters={name: values[which] for name, values in self.parameters.items()},
            state=self.state[:, which],
            constants=self.constants[:, which],
            score_constants=self.score_constants[:, which],
            scenario_stream=self.scenario_stream[which],
            infeasible_reason=tuple(self.infeasible_reason[i] for i in which),
        )


def has_events(scenario: PlannedScenario) -> bool:
    """Whether the faults of a scenario are scored one by one: there are several, or one that ends."""
    return len(scenario.faults) > 1 or any(fault.end_s is not None for fault in scenario.faults)


@dataclass(frozen=True, kw_only=True, eq=False)
class Assembly:
    """What flies every case of a campaign.

    Attributes
    ----------
    plan : Plan
        Cases.
    loop : Loop
        Benchmark in closed loop.
    detectors : mapping of str to Detector
        By the names of their designs.
    scoring : Scoring
        Score of one detector.
    """

    plan: Plan
    loop: Loop
    detectors: Mapping[str, Detector]
    scoring: Scoring

    def batch(self, cases: Cases) -> Batch:
        """Constants and states of cases, a pure function of campaign, seed and case number."""
        scenario, run = self.plan.locate(cases)
        parameters = self.plan.parameters(cases)
        streams = np.array([planned.stream for planned in self.plan.scenarios], dtype=np.int64)[scenario]
        start = self.loop.start(
            Flights(
                parameters=parameters,
                manoeuvres=[self.plan.scenarios[s].manoeuvre for s in scenario],
                faults=self._per_scenario(self._fault_rows, scenario, run),
                normals=self._start_normals(run),
            )
        )
        return Batch(
            cases=cases,
            scenario=scenario,
            run=run,
            parameters=parameters,
            state=start.state,
            constants=start.constants,
            score_constants=self._per_scenario(self._score_rows, scenario, run),
            scenario_stream=streams,
            infeasible_reason=start.infeasible_reason,
        )

    def normals(self, batch: Batch, first: int, count: int) -> Floats:
        """Normals of samples ``first ... first + count - 1``, (count, n_normals, n_cases)."""
        sample = np.arange(first, first + count)[:, np.newaxis]
        key, run = self.plan.campaign.seed, batch.run
        own = [philox.normals((sample, c, run, self.plan.stream), key) for c in self.loop.consumers]
        of_faults = [philox.normals((sample, c, run, batch.scenario_stream), key) for c in self.loop.fault_consumers]
        return np.concatenate([*own, *of_faults]).transpose(1, 0, 2)

    def _start_normals(self, run: Cases) -> Floats:
        key = self.plan.campaign.seed
        drawn = [philox.normals((BEFORE_START, c, run, self.plan.stream), key) for c in self.loop.start_consumers]
        return np.concatenate(drawn)

    def _per_scenario(self, rows_of: Callable[[PlannedScenario, Cases], Floats], scenario: Cases, run: Cases) -> Floats:
        """Rows made scenario by scenario, put back into the order of the cases."""
        parts = {int(s): rows_of(self.plan.scenarios[s], run[scenario == s]) for s in np.unique(scenario)}
        n_rows = len(next(iter(parts.values()))) if parts else 0
        rows = np.empty((n_rows, len(scenario)))
        for s, part in parts.items():
            rows[:, scenario == s] = part
        return rows

    def _fault_rows(self, planned: PlannedScenario, run: Cases) -> Floats:
        slots, sites = len(self.loop.fault_consumers), len(self.loop.bus.sites)
        key = self.plan.campaign.seed
        phases = [
            philox.uniforms((BEFORE_START, c, run, planned.stream), key)[:sites] for c in self.loop.fault_consumers
        ]
        return self.loop.fault_rows(planned.faults, np.array(phases).reshape(slots, sites, len(run)))

    def _score_rows(self, planned: PlannedScenario, run: Cases) -> Floats:
        sample_s, sites = self.plan.campaign.sample_s, self.loop.bus.sites
        events = []
        for fault in planned.faults if has_events(planned) else ():
            firsts = first_samples(fault, sites, sample_s)
            last = NEVER if fault.end_s is None else float(round(fault.end_s / sample_s)) - 1.0
            events.append(EventTimes(min(firsts), last, tuple(float(site in fault.sites) for site in sites)))
        return self.scoring.rows(
            k0=NEVER if planned.k0 is None else float(planned.k0),
            n_faulty=planned.n_faulty,
            last=float(planned.n_samples - 1),
            events=events,
            n_cases=len(run),
        )


def loop_of(planned: Plan) -> Loop:
    """Closed loop of a campaign's benchmark with its options."""
    campaign = planned.campaign
    return planned.benchmark.loop(
        Options(
            plant=campaign.plant,
            voter=campaign.voter,
            sensors=campaign.sensors,
            wind=campaign.wind,
            sample_s=campaign.sample_s,
            substeps=campaign.substeps,
            # one at least: a layout has no field of no rows
            fault_slots=max(1, *(len(scenario.faults) for scenario in planned.scenarios)),
        )
    )


def assemble(campaign: Campaign) -> Assembly:
    """Loop, detectors and scoring of a campaign.

    Raises
    ------
    CampaignError
        A design does not make a detector for this benchmark.
    """
    planned = plan(campaign)
    loop = loop_of(planned)
    n_events = max((len(s.faults) for s in planned.scenarios if has_events(s)), default=0)
    return Assembly(
        plan=planned,
        loop=loop,
        detectors=build_detectors(campaign, loop.bus),
        scoring=Scoring(len(loop.bus.sites), n_events),
    )
