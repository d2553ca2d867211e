"""What flies the cases of a campaign: its closed loop, its detectors, and batches of cases with all their constants."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.blocks import philox
from fddbench.blocks.consumers import fault_number
from fddbench.blocks.drawn import Draws
from fddbench.campaign.addresses import Addresses
from fddbench.campaign.plan import Plan, PlannedScenario
from fddbench.designs.adapted import Adapted
from fddbench.faults.timing import first_samples
from fddbench.interfaces import NEVER, Fault, FlightFaults, Flights, Floats, Loop
from fddbench.metrics.consequences import Consequences
from fddbench.metrics.score import FaultTimes
from fddbench.metrics.scoring import Scoring
from fddbench.runner.faulty import BatchFaults, batch_faults

__all__ = ["BEFORE_START", "Assembly", "Batch", "has_events"]

Cases = npt.NDArray[np.int64]

BEFORE_START = 0xFFFFFFFF
"""First counter word of what is drawn before sample 0; no flight has so many samples."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Batch:
    """Cases ready at sample 0.

    Attributes
    ----------
    cases : (n_cases,) array
        Numbers of the cases in this plan; no part of any result.
    scenario, point, level, run : (n_cases,) arrays
        Their addresses, see `fddbench.campaign.addresses.Addresses`.
    parameters : mapping of str to (n_cases,) arrays
        True parameter values.
    faults : BatchFaults
        What was drawn and swept of the faults, and their times.
    state, constants, score_constants : (n_rows, n_cases) arrays
        Of the loop and of the scoring.
    scenario_stream : (n_cases,) array
        Fourth counter word of the faults' random numbers.
    infeasible_reason : tuple of str
        Why a case cannot fly; "" for one that can.
    """

    cases: Cases
    scenario: Cases
    point: Cases
    level: Cases
    run: Cases
    parameters: Mapping[str, Floats]
    faults: BatchFaults
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
            point=self.point[which],
            level=self.level[which],
            run=self.run[which],
            parameters={name: values[which] for name, values in self.parameters.items()},
            faults=self.faults.take(which),
            state=self.state[:, which],
            constants=self.constants[:, which],
            score_constants=self.score_constants[:, which],
            scenario_stream=self.scenario_stream[which],
            infeasible_reason=tuple(self.infeasible_reason[i] for i in which),
        )


def has_events(scenario: PlannedScenario, n_labelled: int = 0) -> bool:
    """Whether the faults of a scenario are scored one by one: there are several, one that ends, or some in what flies."""
    return n_labelled > 0 or len(scenario.faults) > 1 or any(fault.end_s is not None for fault in scenario.faults)


@dataclass(frozen=True, kw_only=True, eq=False)
class Assembly:
    """What flies every case of a campaign.

    Attributes
    ----------
    plan : Plan
        Cases.
    loop : Loop
        Benchmark in closed loop.
    detectors : mapping of str to Adapted
        By the names of their designs.
    scoring : Scoring
        Score of a detector that isolates all sites and estimates nothing; its constants are those of all detectors.
    consequences : Consequences
        What is kept of a flight besides, as the loop announces it.
    """

    plan: Plan
    loop: Loop
    detectors: Mapping[str, Adapted]
    scoring: Scoring
    consequences: Consequences = field(default_factory=lambda: Consequences((), ()))

    @property
    def commander(self) -> str:
        """Detector on whose declarations the aircraft acts; "" for none."""
        return self.plan.campaign.reconfigure

    @property
    def scoring_of(self) -> Mapping[str, Scoring]:
        """Score of each detector: by its sites or its alarm, with its estimate if it has one."""
        return {
            name: self.scoring.of(watches=own.watches, isolates=own.isolates, estimates=own.estimates)
            for name, own in self.detectors.items()
        }

    def batch(self, cases: Cases) -> Batch:
        """Constants and states of cases, a pure function of campaign, seed and case number."""
        at, parameters = self.plan.locate(cases), self.plan.parameters(cases)
        scenario, run = at.scenario, at.run
        lists, faults = batch_faults(self.plan, at, parameters)
        n_samples = self.plan.n_samples(cases)
        outside = self._outside(parameters, faults, n_samples)
        streams = np.array([planned.stream for planned in self.plan.scenarios], dtype=np.int64)[scenario]
        n_cases, loop = len(cases), self.loop
        prepared = loop.prepare(
            Flights(
                parameters=parameters,
                manoeuvres=[self.plan.scenarios[s].manoeuvre for s in scenario],
                faults=FlightFaults(lists=lists, which=scenario, uniform=self._uniform(run, streams)),
                normals=self._before(run, streams),
            )
        )
        state = loop.states.spread(loop.start(prepared.constants), n_cases)
        return Batch(
            cases=cases,
            scenario=scenario,
            point=at.point,
            level=at.level,
            run=run,
            parameters=parameters,
            faults=faults,
            state=loop.states.pack(state, n_cases),
            constants=loop.constants.pack(loop.constants.spread(prepared.constants, n_cases), n_cases),
            score_constants=self._score_rows(at, lists, faults, n_samples),
            scenario_stream=streams,
            infeasible_reason=tuple(a or b for a, b in zip(outside, prepared.infeasible_reason, strict=True)),
        )

    def _outside(self, parameters: Mapping[str, Floats], faults: BatchFaults, n_samples: Cases) -> list[str]:
        """Why a case cannot be flown: a value is drawn that the benchmark does not have, or a fault begins after its log."""
        reasons, sample_s = [""] * len(n_samples), self.plan.campaign.sample_s
        if hasattr(self.plan.plant, "longest_s"):
            late = np.where(faults.first < NEVER, faults.last_onset, 0.0).max(axis=0, initial=0.0)
            for i in np.flatnonzero(late >= n_samples).tolist():
                reasons[i] = (
                    f"a fault begins at {late[i] * sample_s:g} s, after the log's end at {(n_samples[i] - 1) * sample_s:g} s"
                )
        for limit in self.plan.plant.parameters:
            drawn = parameters[limit.name]
            for i in np.flatnonzero((drawn < limit.low) | (drawn > limit.high)).tolist():
                reasons[i] = f"drawn {limit.name} {drawn[i]:g} lies outside {limit.low:g} to {limit.high:g}"
        return reasons

    def ends(self, batch: Batch) -> Floats:
        """Last sample of each flight of a batch, (n_cases,)."""
        last: Floats = self.scoring.constants.unpack(batch.score_constants).last
        return last

    def shortened(self, batch: Batch, last: Floats | float) -> Batch:
        """The same batch, flown and scored only to these samples."""
        named = self.scoring.constants.unpack(rows := batch.score_constants.copy())
        named.last[...] = np.minimum(named.last, last)
        return replace(batch, score_constants=rows)

    def nothing_scored(self, batch: Batch, scoring: Scoring) -> Floats:
        """Score of a detector that saw nothing of a batch, (n_score, n_cases)."""
        n_cases, states = len(batch.cases), scoring.states
        begun = scoring.start(scoring.constants.unpack(batch.score_constants))
        packed: Floats = states.pack(states.spread(begun, n_cases), n_cases)
        return packed

    def last_scored(self, batch: Batch, departed: Floats) -> Floats:
        """Last scored sample of each flight of a batch, (n_cases,); -1 for none."""
        last: Floats = np.minimum(self.ends(batch), departed - 1.0)
        return last

    def normals(self, draws: Draws[Any], batch: Batch, first: int, count: int) -> Floats:
        """Normals of samples ``first ... first + count - 1``, (count, n_normals, n_cases), in the order of the draws."""
        sample = np.arange(first, first + count)[:, np.newaxis]
        drawn = self._drawn(philox.normals, draws, sample, batch.run, batch.scenario_stream)
        return drawn.transpose(1, 0, 2)

    def _before(self, run: Cases, streams: Cases) -> Any:
        """What the loop draws before the first sample, by name."""
        return self.loop.before.unpack(self._drawn(philox.normals, self.loop.before, BEFORE_START, run, streams))

    def _drawn(
        self, generator: Callable[..., Floats], draws: Draws[Any], sample: Any, run: Cases, scenario_stream: Cases
    ) -> Floats:
        """Numbers of all the streams of draws, four each, stacked."""
        words = {"flight": self.plan.stream, "scenario": scenario_stream}
        key, shape = self.plan.campaign.seed, np.broadcast_shapes(np.shape(sample), run.shape)
        each = [generator((sample, number, run, words[stream]), key) for number, stream in draws.streams]
        return np.concatenate([*each, np.zeros((0, *shape))])

    def _uniform(self, run: Cases, streams: Cases) -> Floats:
        """A number in (0, 1) for every line, site and flight, (n_lines, n_sites, n_cases): what a fault draws once."""
        slots = max((len(planned.faults) for planned in self.plan.scenarios), default=0)
        sites = len(self.loop.bus.sites)
        uniform = np.empty((slots, sites, len(run)))
        for slot in range(slots):
            for site in range(sites):
                consumer, place = fault_number(slot, site)
                counter = (BEFORE_START, consumer, run, streams)
                uniform[slot, site] = philox.uniforms(counter, self.plan.campaign.seed)[place]
        return uniform

    def _score_rows(
        self, at: Addresses, lists: Sequence[Sequence[Fault]], faults: BatchFaults, n_samples: Cases
    ) -> Floats:
        """Constants of the scoring of flights, (n_rows, n_cases)."""
        sites, n_cases = self.loop.bus.names, len(at.run)
        begins = np.full((len(faults.first), len(sites), n_cases), NEVER)
        for s in np.unique(at.scenario).tolist():
            mine = at.scenario == s
            for line, fault in enumerate(lists[s]):
                for row, first in enumerate(first_samples(fault, sites, self.plan.campaign.sample_s)):
                    begins[line, row, mine] = first
        begins = np.concatenate([begins[: len(begins) - len(faults.labelled)], faults.labelled])
        own = np.where(begins < NEVER, 1.0, 0.0)
        each = [FaultTimes(first=faults.first[j], last=faults.last[j], own=own[j]) for j in range(len(faults.first))]
        faulty_from = begins.min(axis=0, initial=NEVER)
        return self.scoring.rows(last=n_samples - 1.0, faults=each, faulty_from=faulty_from, n_cases=n_cases)
