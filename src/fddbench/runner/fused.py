"""Everything that can be traced, in one step: loop, detectors and their scores, ready for a kernel."""

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np

from fddbench.blocks.block import Part
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, leaves, mapped, record
from fddbench.blocks.program import Program, trace
from fddbench.designs.adapted import Adapted
from fddbench.interfaces import NEVER, Floats, Loop, Sample, Verdict
from fddbench.metrics.consequences import Consequences, ConsequenceState
from fddbench.metrics.score import ScoreConstants, ScoreState
from fddbench.metrics.scoring import Scoring
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.reconfiguration import acted_on

__all__ = ["Fused", "shown"]


def shown(verdict: Verdict, number: Row) -> dict[str, Row]:
    """All there is to record of a verdict: which sites are declared and how many, alarm, residual, what the detector shows."""
    own = {"n_declared": number, "declared": verdict.declared, "alarm": verdict.alarm, "residual": verdict.residual}
    return own | dict(verdict.signals)


@record
class FusedState:
    """States of the loop, of every detector and of its score; sample at which the flight departed, `NEVER` if it did not.

    `declared` has the rows of sites on which the loop acts at the next sample; `Nothing` where it acts on nobody.
    `consequences` is what is kept of the flight itself.
    """

    loop: Part
    departed: Row
    detectors: tuple[Part, ...]
    scores: tuple[ScoreState, ...]
    declared: Part
    consequences: ConsequenceState


@record
class FusedConstants:
    """Constants of the loop, and of the scoring, which is the same for all detectors."""

    loop: Part
    score: ScoreConstants


@record
class FusedDraws:
    """Random numbers of the loop, and of the detectors that draw any."""

    loop: Part
    detectors: tuple[Part, ...]


@record
class Flown:
    """What there is to see of a sample: the loop's, every verdict, and how many sites each declares."""

    sample: Sample
    departed: Row
    verdicts: tuple[Verdict, ...]
    numbers: tuple[Row, ...]


class Fused:
    """Loop, detectors and scores as one block, fed with the number of the sample.

    Parameters
    ----------
    loop : Loop
        What flies.
    detectors : mapping of str to Adapted
        Those to fuse, by the names of their designs.
    scoring : mapping of str to Scoring
        Score of each of them, all with the same constants.
    nobody : Scoring
        Those constants, where there is no detector.
    commander : str
        That of them on whose declarations the loop acts; "" for none.
    consequences : Consequences
        What is kept of the flight itself.
    """

    def __init__(
        self,
        loop: Loop,
        detectors: Mapping[str, Adapted],
        scoring: Mapping[str, Scoring],
        nobody: Scoring,
        commander: str = "",
        consequences: Consequences | None = None,
    ) -> None:
        self.loop, self.detectors, self.nobody = loop, dict(detectors), nobody
        self.consequences = consequences or Consequences((), ())
        self.commander = list(self.detectors).index(commander) if commander else None
        declared: Part = len(loop.bus.sites) if commander else Nothing()
        own, self.scoring = tuple(self.detectors.values()), tuple(scoring[name] for name in detectors)
        self.states = Layout(
            FusedState(
                loop=loop.states.shape,
                departed=ROW,
                detectors=tuple(detector.states.shape for detector in own),
                scores=tuple(score.states.shape for score in self.scoring),
                declared=declared,
                consequences=self.consequences.states.shape,
            )
        )
        self.constants = Layout(FusedConstants(loop=loop.constants.shape, score=nobody.constants.shape))
        drawn = tuple(detector.draws.names for detector in own)
        self.draws: Draws[FusedDraws] = Draws(FusedDraws(loop=loop.draws.names, detectors=drawn))

    @classmethod
    def of(cls, assembly: Assembly, detectors: tuple[str, ...]) -> "Fused":
        """Everything of an assembly, with some of its detectors."""
        own = {name: assembly.detectors[name] for name in detectors}
        commander = assembly.commander if assembly.commander in own else ""
        return cls(
            assembly.loop, own, assembly.scoring_of, assembly.scoring, commander, consequences=assembly.consequences
        )

    def packed(self, batch: Batch) -> tuple[Floats, Floats]:
        """State before sample 0 and constants of a batch, (n_rows, n_cases) each."""
        n_cases = len(batch.cases)
        c = FusedConstants(
            loop=self.loop.constants.unpack(batch.constants), score=self.nobody.constants.unpack(batch.score_constants)
        )
        begun = self.states.spread(self.start(c), n_cases)
        state = self.states.pack(begun, n_cases)
        # the loop has begun already, with the batch
        state[: self.loop.states.size] = batch.state
        return state, self.constants.pack(c, n_cases)

    def start(self, c: FusedConstants) -> FusedState:
        """Nothing flown, nothing declared, nothing scored."""
        return FusedState(
            loop=self.loop.start(c.loop),
            departed=NEVER,
            detectors=tuple(detector.start(Nothing()) for detector in self.detectors.values()),
            scores=tuple(scoring.start(c.score) for scoring in self.scoring),
            declared=Nothing() if self.commander is None else 0.0,
            consequences=self.consequences.start(),
        )

    def step(self, x: FusedState, c: FusedConstants, n: FusedDraws, sample: Row) -> tuple[FusedState, Flown]:
        """One sample of everything."""
        told = {} if self.commander is None else {"declared": x.declared}
        loop, seen = self.loop.step(x.loop, c.loop, n.loop, sample, **told)
        departed = np.where(seen.departed, np.minimum(x.departed, sample), x.departed)
        kept, scores, verdicts, numbers = [], [], [], []
        parts = zip(self.detectors.values(), x.detectors, n.detectors, self.scoring, x.scores, strict=True)
        for detector, state, numbers_drawn, scoring, score in parts:
            kept_state, verdict = detector.step(state, Nothing(), numbers_drawn, seen.measured)
            actual, alive = scoring.actual(seen), sample < departed
            scored, number = scoring.step(score, c.score, Nothing(), verdict, actual, sample, alive)
            kept.append(kept_state)
            scores.append(scored)
            verdicts.append(verdict)
            numbers.append(number)
        own = c.score
        lasting = self.consequences.step(
            x.consequences, seen.truth, k0=own.k0, last=own.last, sample=sample, alive=sample < departed
        )
        flown = Flown(sample=seen, departed=departed, verdicts=tuple(verdicts), numbers=tuple(numbers))
        after = FusedState(
            loop=loop,
            departed=departed,
            detectors=tuple(kept),
            scores=tuple(scores),
            declared=x.declared if self.commander is None else acted_on(verdicts[self.commander]),
            consequences=lasting,
        )
        return after, flown

    def merge_keys(self) -> list[Hashable]:
        """One key a state row: equal keys may be flown as one row, if they also change alike.

        Rows of detectors and scores, and of what the loop is told, that start with one and the same number share a key; rows
        of the loop never do.
        """
        nowhere = mapped(lambda _: None, self.nobody.constants.shape)  # what depends on constants is no number
        told = self.states.shape.declared
        starts = (
            *(d.start(Nothing()) for d in self.detectors.values()),
            *(scoring.start(nowhere) for scoring in self.scoring),
            mapped(lambda _: 0.0, told),
            self.consequences.start(),
        )
        layouts: tuple[Layout[Any], ...] = (
            *(d.states for d in self.detectors.values()),
            *(scoring.states for scoring in self.scoring),
            Layout(told),
            self.consequences.states,
        )
        keys: list[Hashable] = list(range(self.loop.states.size + 1))
        for start, layout in zip(starts, layouts, strict=True):
            for (_, value), rows in zip(leaves(start), layout.counts.values(), strict=True):
                alike = isinstance(value, float | int)
                keys += [("start", float(value).hex()) if alike else len(keys) + j for j in range(rows or 1)]
        return keys

    def program(self) -> Program:
        """Traced step; outputs ``state``, ``finished``, ``departed`` and by their names all signals there are."""

        def step(state: Rows, constants: Rows, normals: Rows, sample: Any) -> Mapping[str, Rows]:
            x, c, n = self.states.unpack(state), self.constants.unpack(constants), self.draws.unpack(normals)
            after, flown = self.step(x, c, n, sample)
            rows = {"state": self.states.pack(after), "finished": flown.departed < NEVER, "departed": flown.departed}
            return rows | self._signals(flown)

        sizes = {"state": self.states.size, "constants": self.constants.size, "normals": self.draws.size}
        return trace(step, **sizes, sample=0)

    def _signals(self, flown: Flown) -> dict[str, Rows]:
        """Everything that may be recorded, by name."""
        bus, seen = self.loop.bus, flown.sample
        found: dict[str, Rows] = {f"measured:{name}": getattr(seen.measured, name) for name in bus.signals}
        found |= {f"truth:{name}": value for name, value in seen.truth.items()}
        found |= {f"voted:{name}": value for name, value in seen.voted.items()}
        found |= {} if seen.added is None else {"added": seen.added}
        for name, verdict, number in zip(self.detectors, flown.verdicts, flown.numbers, strict=True):
            found |= {f"{name}:{signal}": rows for signal, rows in shown(verdict, number).items()}
        return found
