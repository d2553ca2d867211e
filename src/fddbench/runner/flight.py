"""Flies batches: compiled where llvmlite is, else with NumPy; the same bits either way."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from types import SimpleNamespace

import numpy as np

from fddbench.blocks import kernel, llvm
from fddbench.blocks.flown import Flown
from fddbench.interfaces import NEVER, Floats, Sample
from fddbench.metrics.scoring import Scoring
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.eager import DetectorFlight, feed_eagerly, flown_only, fly_eagerly
from fddbench.runner.fused import Fused
from fddbench.runner.given_up import GivenUp
from fddbench.runner.in_c import as_c
from fddbench.runner.reconfiguration import without_commander
from fddbench.runner.twins import healthy_twins

__all__ = ["Flyer", "Outcome"]

_TILE = 500
"""Samples recorded at a time for opaque detectors; no part of any result."""


@dataclass(kw_only=True, eq=False)
class Outcome:
    """What is known of a batch after the flight.

    Attributes
    ----------
    batch : Batch
        Cases.
    scores : dict of str to (n_score, n_cases) arrays
        Final score state by detector.
    departed : (n_cases,) array
        Sample at which the flight departed, `NEVER` if it did not.
    errors : dict of str to list of str
        By detector, what its step raised for each case ("": nothing).
    recorded : dict of str to (n_time, n_rows, n_cases) arrays
        What was asked for: ``measured:NAME``, ``truth:NAME``, ``voted:NAME``, ``added``, ``DETECTOR:NAME``.
    scoring : dict of str to Scoring
        How what is no detector of the campaign was scored.
    consequences, twins : (n_rows, n_cases) arrays or None
        What is kept of the flights themselves and of their healthy twins, by `Assembly.consequences`; None: not known.
    """

    batch: Batch
    scores: dict[str, Floats]
    departed: Floats
    errors: dict[str, list[str]] = field(default_factory=dict)
    recorded: dict[str, Floats] = field(default_factory=dict)
    scoring: dict[str, Scoring] = field(default_factory=dict)
    consequences: Floats | None = None
    twins: Floats | None = None


class Flyer:
    """Flies batches of one assembly.

    Parameters
    ----------
    assembly : Assembly
        What flies.
    backend : {"auto", "llvm", "numpy"}, or one of them and "+c"
        ``auto`` compiles where llvmlite is installed. Where the aircraft acts on a detector that cannot be compiled, all fly
        in Python, whatever this says. With ``+c`` detectors that can be traced fly as exported C.
    given_up : mapping of str to GivenUp
        Detectors that are not flown any more.
    """

    def __init__(
        self, assembly: Assembly, backend: str = "auto", given_up: Mapping[str, GivenUp] | None = None
    ) -> None:
        backend, plus, _ = backend.partition("+c")
        self.assembly, self.backend = as_c(assembly) if plus else assembly, backend + plus
        self.given_up = given_up or {}
        large = bool(getattr(assembly.loop, "in_python", ""))
        self.compiled = (backend == "llvm" or (backend == "auto" and llvm.available())) and not (
            large or self._acts_on_python()
        )

    def _acts_on_python(self) -> bool:
        """Whether the aircraft acts on a detector that cannot be compiled: then all fly in Python, sample by sample."""
        own = self.assembly.detectors.get(self.assembly.commander)
        return own is not None and bool(own.opaque)

    @cached_property
    def opaque(self) -> dict[str, str]:
        """Detectors that cannot be compiled, and why; they fly in Python on recorded signals."""
        reasons = {name: own.opaque for name, own in self.assembly.detectors.items() if name not in self.given_up}
        return {name: reason for name, reason in reasons.items() if reason}

    @cached_property
    def fused(self) -> Fused:
        """Step of everything that can be compiled."""
        return Fused.of(self.assembly, tuple(name for name, own in self.assembly.detectors.items() if not own.opaque))

    @lru_cache(maxsize=4)  # noqa: B019  (a flyer lives as long as its process)
    def kernel(self, recorded: tuple[str, ...]) -> kernel.Kernel:
        """Kernel that stores these outputs."""
        fused = self.fused
        return kernel.build(
            fused.program(), streams=fused.draws.streams, merge=fused.merge_keys(), recorded=recorded, backend="llvm"
        )

    def prepare(self) -> None:
        """Compile what flying without a recording needs, so that threads find it done."""
        if self.compiled:
            self.kernel(self.needed(()))
        if self.twins is not None and self.twins.compiled:
            self.twins.kernel(self.twins.needed(self.of_twins))

    @cached_property
    def twins(self) -> "Flyer | None":
        """What flies the healthy twins of the faulty flights; None where no number of a row needs any."""
        planned = self.assembly.plan
        if not self.of_twins or not any(each.faults for each in planned.scenarios):
            return None
        return Flyer(healthy_twins(self.assembly), self.backend)

    @property
    def of_twins(self) -> tuple[str, ...]:
        """Signals that are recorded of healthy twins."""
        return tuple(f"truth:{name}" for name in self.assembly.consequences.signals)

    def stretches(self, batch: Batch, recorded: Sequence[str]) -> Iterator[tuple[int, dict[str, Floats], Floats]]:
        """First sample, recordings and departures so far, stretch after stretch; all at once without a compiler."""
        if not self.compiled:
            departed, tape = feed_eagerly(self.assembly, batch, (), recorded)
            yield 0, tape, departed
            return
        first = 0
        for flown in self._tiles(batch, self.needed(tuple(recorded)), ()):
            yield first, dict(flown.recorded), self.fused.states.unpack(flown.state).departed
            first += _TILE

    def fly(self, batch: Batch, recorded: Sequence[str] = ()) -> Outcome:
        """Fly all cases of a batch, each to its own end."""
        if self.assembly.commander in self.given_up:
            return self._unflown(batch)
        if self.compiled:
            outcome = self._fly_compiled(batch, tuple(recorded))
        else:
            names = [name for name in self.assembly.detectors if name not in self.given_up]
            scores, departed, errors, tape, lasting = fly_eagerly(self.assembly, batch, recorded, names)
            outcome = Outcome(
                batch=batch, scores=scores, departed=departed, errors=errors, recorded=tape, consequences=lasting
            )
        for name, given in self.given_up.items():
            outcome.scores[name] = self.assembly.nothing_scored(batch, self.assembly.scoring_of[name])
            outcome.errors[name] = [given.reason(case) for case in batch.cases.tolist()]
        return outcome

    def _unflown(self, batch: Batch) -> Outcome:
        """Nothing but the reason: the detector on which the aircraft acts is given up."""
        assembly, name, n_cases = self.assembly, self.assembly.commander, len(batch.cases)
        errors: dict[str, list[str]] = {other: [""] * n_cases for other in assembly.detectors}
        errors[name] = [self.given_up[name].reason(case) for case in batch.cases.tolist()]
        scores = {other: assembly.nothing_scored(batch, own) for other, own in assembly.scoring_of.items()}
        departed = np.full(n_cases, NEVER)
        return Outcome(batch=batch, scores=scores, departed=departed, errors=without_commander(name, errors))

    def feed(self, batch: Batch, flights: Sequence[DetectorFlight]) -> None:
        """Fly a batch and show it to these flights of detectors, until all of them have raised."""
        if self.compiled:
            for _ in self._tiles(batch, self.needed(()), flights):
                if all(flight.over for flight in flights):
                    return
        else:
            feed_eagerly(self.assembly, batch, flights, until_over=True)

    def needed(self, recorded: tuple[str, ...]) -> tuple[str, ...]:
        """Outputs to store: those asked for, and the measured bus where an opaque detector reads it."""
        own = tuple(name for name in recorded if name.split(":")[0] not in self.opaque)
        bus = tuple(f"measured:{name}" for name in self.assembly.loop.bus.signals) if self.opaque else ()
        departed = ("departed",) if self.opaque else ()
        return tuple(dict.fromkeys((*own, *bus, *self._truths, *departed)))

    @cached_property
    def _truths(self) -> tuple[str, ...]:
        """What the estimates of opaque detectors are scored against, where the benchmark says it."""
        wanted = {self.assembly.scoring_of[name].truth for name in self.opaque}
        return tuple(sorted(wanted & self.fused.program().outputs.keys())) if wanted - {""} else ()

    def _fly_compiled(self, batch: Batch, recorded: tuple[str, ...]) -> Outcome:
        assembly, fused = self.assembly, self.fused
        needed = self.needed(recorded)
        opaque = [DetectorFlight(assembly, name, batch, recorded, alone=False, feed=self.feed) for name in self.opaque]
        kept: dict[str, list[Floats]] = {name: [] for name in needed if name in recorded}
        for flown in self._tiles(batch, needed, opaque):
            for name, parts in kept.items():
                parts.append(flown.recorded[name])
        x = fused.states.unpack(flown.state)
        outcome = Outcome(
            batch=batch,
            scores={name: fused.scoring[i].states.pack(x.scores[i]) for i, name in enumerate(fused.detectors)},
            departed=x.departed,
            recorded={name: np.concatenate(parts) for name, parts in kept.items()},
            consequences=fused.consequences.states.pack(x.consequences),
        )
        for flight in opaque:
            outcome.scores[flight.name], outcome.errors[flight.name] = flight.finish()
            outcome.recorded |= flown_only(assembly, batch, outcome.departed, flight.tape())
        return outcome

    def _tiles(self, batch: Batch, needed: tuple[str, ...], flights: Sequence[DetectorFlight]) -> Iterator[Flown]:
        """Fly a batch, stretch by stretch where outputs are needed, and show each to flights of detectors."""
        assembly, compiled = self.assembly, self.kernel(needed)
        state, constants = self.fused.packed(batch)
        samples = assembly.ends(batch).astype(np.int64) + 1
        addresses = kernel.Addresses(
            key=assembly.plan.campaign.seed, run=batch.run, flight=assembly.plan.stream, scenario=batch.scenario_stream
        )
        end = int(samples.max())
        step = _TILE if needed else end
        for first in range(0, end, step):
            flown = compiled.fly(state, constants, samples, addresses, first=first, end=min(first + step, end))
            state, samples = flown.state, flown.samples
            if flights:
                self._show(flights, flown.recorded, first=first)
            yield flown

    def _show(self, opaque: Sequence[DetectorFlight], recorded: Mapping[str, Floats], *, first: int) -> None:
        """Feed opaque detectors with a tile of recorded signals; flights that have ended show not-a-number."""
        signals = self.assembly.loop.bus.signals
        departed = np.nan_to_num(recorded["departed"][:, 0], nan=0.0)
        for rows in recorded.values():
            rows.flags.writeable = False
        with np.errstate(all="ignore"):
            for j in range(len(departed)):
                measured = SimpleNamespace(
                    **{
                        name: recorded[f"measured:{name}"][j] if rows else recorded[f"measured:{name}"][j, 0]
                        for name, rows in signals.items()
                    }
                )
                voted = {name[6:]: rows[j, 0] for name, rows in recorded.items() if name.startswith("voted:")}
                added = recorded["added"][j] if "added" in recorded else None
                seen = Sample(measured=measured, truth={}, departed=departed[j] < np.inf, added=added, voted=voted)
                for flight in opaque:
                    flight.step(seen, float(first + j), departed[j])
