"""One sample of recorded flights: read the logs, break sensors, vote."""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.benchmarks.recorded.plant import RecordedPlant
from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.primitives import gather
from fddbench.blocks.table import Table
from fddbench.faults.injection import SignalFaults
from fddbench.interfaces import Bus, Flights, Options, Prepared, Sample, Voter
from fddbench.voting.block import VoterBlock

__all__ = ["RecordedLoop"]

# measured: compiling takes 2.8 s and 180 MB a million numbers, linear up to 4 million (11 s); flying them in Python some
# 0.4 ms a sample, 9 minutes for the 1.3 million samples of three channels
MOST_NUMBERS = 4_000_000
"""In all channels of all logs together; more are not compiled into the program that flies."""


@record
class RecordedState:
    """What faults and voters keep."""

    faults: tuple[Any, ...]
    voters: tuple[Any, ...]


@record
class RecordedConstants:
    """Where the log of a flight begins in the tables, its last sample, and its injected faults."""

    first: Row
    last: Row
    faults: tuple[Any, ...]


class RecordedLoop:
    """Open loop of recorded flights, see `fddbench.interfaces.Loop`: detectors see what was logged, with injected faults.

    Nothing that was logged answers to an injected fault but what is voted here.

    Parameters
    ----------
    plant : RecordedPlant
        Logs.
    voter : class of a Voter
        Of the signals that are voted.
    options : Options
        Clock and faults.
    """

    before: Draws[Any] = NO_DRAWS

    def __init__(self, plant: RecordedPlant, voter: type[Voter], options: Options) -> None:
        self.plant, self.sample_s, own = plant, options.sample_s, plant.mapping
        self.broken = tuple(on.signal for on in own.sites)
        self.faults = tuple(SignalFaults(plant.sites, name, options.faults, options.sample_s) for name in self.broken)
        self.voted = {name: str(one.vote) for name, one in own.signals.items() if one.vote is not None}
        self.voters = tuple(VoterBlock.on(voter, v, own.signals[v].rows, self.sample_s) for v in self.voted.values())
        self.states = Layout(
            RecordedState(
                faults=tuple(part.states.shape for part in self.faults),
                voters=tuple(part.states.shape for part in self.voters),
            )
        )
        self.constants = Layout(
            RecordedConstants(first=ROW, last=ROW, faults=tuple(part.constants.shape for part in self.faults))
        )
        self.draws: Draws[Any] = Draws(tuple(part.draws.names for part in self.faults))
        self.truth = tuple(own.truth)
        signals = {name: one.rows for name, one in own.signals.items()}
        self.bus = Bus(sample_s=self.sample_s, sites=plant.sites, signals=signals)
        sampled = plant.sampled(self.sample_s)
        self.tables = {
            channel: Table.of(np.concatenate([each[channel].values for each in sampled])) for channel in sampled[0]
        }
        self.lengths = np.array([len(next(iter(each.values())).values) for each in sampled])
        numbers = sum(map(len, self.tables.values()))
        self.in_python = f"the logs hold {numbers:,} numbers, at most {MOST_NUMBERS:,} are compiled" * (
            numbers > MOST_NUMBERS
        )

    def prepare(self, flights: Flights) -> Prepared:
        """Where each log lies in the tables; a fault that begins after the end of its log cannot be flown."""
        log = self.plant.numbers(flights.parameters)
        begins = np.concatenate([[0], np.cumsum(self.lengths)[:-1]])
        constants = RecordedConstants(
            first=begins[log].astype(float),
            last=self.lengths[log] - 1.0,
            faults=tuple(part.prepare(flights.faults) for part in self.faults),
        )
        return Prepared(constants=constants, infeasible_reason=("",) * flights.n_cases)

    def start(self, c: RecordedConstants) -> RecordedState:
        """Nothing read yet."""
        return RecordedState(
            faults=tuple(part.start(own) for part, own in zip(self.faults, c.faults, strict=True)),
            voters=tuple(part.start(Nothing()) for part in self.voters),
        )

    def step(self, x: RecordedState, c: RecordedConstants, n: Any, sample: Row) -> tuple[RecordedState, Sample]:
        """One sample, see `fddbench.interfaces.Loop.step`; after the end of a log its last one stands."""
        place = c.first + np.minimum(sample, c.last)
        healthy = {name: self._logged(name, place) for name, one in self.plant.mapping.signals.items() if not one.vote}
        shown, kept, added = dict(healthy), [], {}
        for name, part, own, constants, numbers in zip(self.broken, self.faults, x.faults, c.faults, n, strict=True):
            rows = healthy[name] if self.bus.signals[name] else np.stack([healthy[name]])
            after, faulty = part.step(own, constants, numbers, np.stack([rows[row] for row in part.rows]), sample)
            kept.append(after)
            all_rows = list(rows)
            for row, value in zip(part.rows, faulty, strict=True):
                all_rows[row], added[name, row] = value, value - rows[row]
            shown[name] = np.stack(all_rows) if self.bus.signals[name] else all_rows[0]
        truth = {name: self._logged(name, place) for name in self.truth}
        voters, voted = self._vote(x.voters, shown)
        seen = Sample(
            measured=SimpleNamespace(**{name: (shown | voted)[name] for name in self.bus.signals}),
            truth=truth,
            departed=place < 0.0,
            # of a fault that is in the log nobody knows what it adds
            added=None if self.plant.labels else np.stack([added[s.signal, s.row] for s in self.bus.sites]),
            voted=self._errors(voted, truth),
        )
        return RecordedState(faults=tuple(kept), voters=voters), seen

    def _logged(self, name: str, place: Row) -> Rows:
        """A signal as it was logged, or what no log says."""
        one = (self.plant.mapping.signals | self.plant.mapping.truth)[name]
        if one.value is not None:
            values = one.value if isinstance(one.value, tuple) else (one.value,)
            rows = [0.0 * place + value for value in values]
        else:
            rows = [gather(self.tables[name, row], place) for row in range(len(one.columns))]
        return np.stack(rows) if one.rows else rows[0]

    def _vote(self, x: tuple[Any, ...], shown: Mapping[str, Rows]) -> tuple[tuple[Any, ...], dict[str, Row]]:
        kept, found = [], {}
        for (name, sensors), part, own in zip(self.voted.items(), self.voters, x, strict=True):
            after, found[name] = part.step(own, Nothing(), Nothing(), shown[sensors])
            kept.append(after)
        return tuple(kept), found

    def _errors(self, voted: Mapping[str, Row], truth: Mapping[str, Row]) -> dict[str, Row]:
        true = {name: one.true for name, one in self.plant.mapping.signals.items() if one.true is not None}
        return {name: voted[name] - truth[other] for name, other in true.items()}
