"""Scoring inside the flight: extremes, integers and three sums, so that no signal has to be stored.

The conventions are those of the columns in ``fddbench.results.schema``: k0 is the first faulty sample, D the declared sites,
F those that have been faulty so far; onsets and declarations are sample numbers and are compared as such. What a fault
needs to be found is kept by `fddbench.metrics.found`, the error of its estimate by `fddbench.metrics.estimate`.
"""

from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from fddbench.blocks.block import NO_DRAWS, Part
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, mapped
from fddbench.blocks.linear import total
from fddbench.blocks.primitives import rarely
from fddbench.errors import DesignError
from fddbench.interfaces import NEVER, Floats, Sample, Verdict
from fddbench.metrics.estimate import Sums, add_errors
from fddbench.metrics.found import changed, detected, found_by_alarm, found_by_sites, outside
from fddbench.metrics.score import LOWEST, FaultScore, FaultTimes, ScoreConstants, ScoreState

__all__ = ["SITES", "Scoring"]

SITES = "sites"
"""What a detector `estimates` that gives the size of the fault on each site that it watches."""

SETTLING_S = 1.0
"""After a detection, what the estimate may take to settle [s]."""


class Scoring:
    """Score of one detector on many flights, as a block that is fed with its verdicts.

    Parameters
    ----------
    sites : sequence of str
        Fault sites of the benchmark.
    n_faults : int
        The most faults that a flight has.
    sample_s : float
        Sample time [s].
    watches : sequence of str, optional
        Sites that the detector declares and estimates; all by default.
    isolates : bool
        False for a detector that only detects: it is scored by its alarm.
    estimates : str or None
        What `Verdict.estimate` is of: `SITES`, or the name of a voted signal; None: the detector estimates nothing.
    units : sequence of str
        Unit of each site; none: all have the same. Errors of estimates in different units have no common mean.
    """

    draws: Draws[Any] = NO_DRAWS

    def __init__(
        self,
        sites: Sequence[str],
        n_faults: int,
        sample_s: float,
        *,
        watches: Sequence[str] | None = None,
        isolates: bool = True,
        estimates: str | None = None,
        units: Sequence[str] = (),
    ) -> None:
        self.units = tuple(units) or ("",) * len(sites)
        self.sites, self.n_faults, self.sample_s = tuple(sites), n_faults, sample_s
        self.isolates, self.estimates = isolates, estimates
        self.watches = self.sites if watches is None else tuple(watches)
        self.settling = max(1.0, float(round(SETTLING_S / sample_s)))
        n = len(self.sites)
        times = tuple(FaultTimes(first=ROW, last=ROW, own=n) for _ in range(n_faults))
        self.constants = Layout(ScoreConstants(k0=ROW, last=ROW, faulty_from=n, faults=times))
        sums: Part = (ROW, ROW, ROW) if estimates else Nothing()
        scores = tuple(FaultScore(found=ROW, sums=sums) for _ in range(n_faults))
        self.states = Layout(
            ScoreState(
                declared=n, alarm=ROW, false_alarm=ROW, raised=ROW, wrong=ROW, over_declared=ROW, changes=ROW,
                margin_healthy=ROW, margin_faulty=ROW, nonfinite=ROW, faults=scores,
            )
        )  # fmt: skip

    def of(self, *, watches: Sequence[str], isolates: bool, estimates: str | None) -> "Scoring":
        """Score of another detector on the same flights: the same constants."""
        more: dict[str, Any] = {"watches": watches, "isolates": isolates, "estimates": estimates, "units": self.units}
        return Scoring(self.sites, self.n_faults, self.sample_s, **more)

    def rows(self, *, last: Row, faults: Sequence[FaultTimes], faulty_from: Rows, n_cases: int) -> Floats:
        """Constant rows of flights, (n_rows, n_cases), that end with the sample `last`.

        Rows of sites are (n_sites, 1) or (n_sites, n_cases), single ones numbers or (n_cases,).
        """
        nothing = FaultTimes(first=NEVER, last=NEVER, own=0.0)
        own = tuple(faults[j] if j < len(faults) else nothing for j in range(self.n_faults))
        k0 = np.broadcast_to(np.min(faulty_from, axis=0), (n_cases,))
        constants = ScoreConstants(k0=k0, last=last, faulty_from=faulty_from, faults=own)
        packed: Floats = self.constants.pack(self.constants.spread(constants, n_cases), n_cases)
        return packed

    def start(self, c: ScoreConstants) -> ScoreState:
        """Nothing seen yet, and nothing declared."""
        del c
        sums = mapped(lambda _: 0.0, self.states.shape.faults[0].sums) if self.n_faults else Nothing()
        return ScoreState(
            declared=0.0, alarm=0.0, false_alarm=NEVER, raised=NEVER, wrong=NEVER, over_declared=0.0, changes=0.0,
            margin_healthy=LOWEST, margin_faulty=LOWEST, nonfinite=0.0,
            faults=(FaultScore(found=NEVER, sums=sums),) * self.n_faults,
        )  # fmt: skip

    @property
    def truth(self) -> str:
        """What `actual` needs of a sample, as recordings call it: ``added``, ``voted:NAME`` or, without an estimate, ""."""
        return "" if self.estimates is None else "added" if self.estimates == SITES else f"voted:{self.estimates}"

    def actual(self, seen: Sample) -> Rows:
        """What the estimate of the detector is compared with; None where there is none, or the benchmark does not say.

        Raises
        ------
        DesignError
            The benchmark votes on no such signal.
        """
        if self.estimates is None:
            return None
        if self.estimates == SITES:
            return seen.added
        if seen.voted and self.estimates not in seen.voted:
            raise DesignError(f"estimates says {self.estimates!r}; write 'sites' or one of {sorted(seen.voted)}")
        return seen.voted.get(self.estimates)

    def step(
        self, x: ScoreState, c: ScoreConstants, n: Nothing, verdict: Verdict, actual: Rows, sample: Row, alive: Row
    ) -> tuple[ScoreState, Row]:
        """Score after one more sample, and the number of declared sites at this one.

        Flights that have departed or ended keep their score. `verdict` has a row for every site of the benchmark, and an
        alarm; `actual` is what its estimate is compared with, None for nothing.
        """
        del n
        declared = verdict.declared * 1.0  # a plug-in may declare with booleans, whose sum would be a logical or
        number = total(declared)
        alarm = np.maximum(verdict.alarm * 1.0, np.where(number > 0.0, 1.0, 0.0))
        active = alive & (sample <= c.last)
        faulty, healthy = active & (sample >= c.k0), active & (sample < c.k0)
        news, finite = changed(declared, x.declared), _finite(verdict)
        said = news | (alarm != x.alarm)
        # nothing but the margins and the sums of errors moves in any other sample
        busy = rarely(active & (said | _onset(c, sample) | ~finite))
        wrong = outside(declared, c.faulty_from, sample)
        so_far = total(np.where(sample >= c.faulty_from, 1.0, 0.0))
        residual, errors = verdict.residual, _errors(verdict, actual)

        def kept(new: Rows, old: Rows) -> Rows:
            return np.where(busy, new, old)

        def first(number: Row, condition: Row) -> Row:
            return kept(np.where(condition, np.minimum(number, sample), number), number)

        after = ScoreState(
            declared=kept(declared, x.declared),
            alarm=kept(alarm, x.alarm),
            false_alarm=first(x.false_alarm, healthy & (alarm > 0.0)),
            raised=first(x.raised, faulty & (alarm > 0.0) & (x.alarm == 0.0)),
            wrong=first(x.wrong, faulty & wrong),
            over_declared=kept(np.where(faulty & (number > so_far), 1.0, x.over_declared), x.over_declared),
            changes=kept(
                np.where(faulty & (news if self.isolates else alarm != x.alarm), x.changes + 1.0, x.changes), x.changes
            ),
            margin_healthy=np.where(healthy, np.maximum(x.margin_healthy, residual), x.margin_healthy),
            margin_faulty=np.where(faulty, np.maximum(x.margin_faulty, residual), x.margin_faulty),
            nonfinite=kept(np.where(finite & _sound(verdict, declared), x.nonfinite, 1.0), x.nonfinite),
            faults=tuple(
                self._fault(
                    one, times, declared, alarm, x.alarm, wrong=wrong, news=news, sample=sample, active=active,
                    errors=errors, busy=busy,
                )
                for one, times in zip(x.faults, c.faults, strict=True)
            ),
        )  # fmt: skip
        return after, number

    def _fault(
        self, x: FaultScore, c: FaultTimes, declared: Rows, alarm: Row, alarm_before: Row, *, wrong: Row, news: Row,
        sample: Row, active: Row, errors: Rows, busy: Row,
    ) -> FaultScore:  # fmt: skip
        """Number of one fault, and the sums of the errors of its estimate."""
        when: dict[str, Row] = {"last": c.last, "sample": sample, "active": active}
        if self.isolates:
            found = found_by_sites(x.found, c.own, declared, wrong=wrong, news=news, first=c.first, **when)
        else:
            found = found_by_alarm(x.found, alarm, alarm_before, first=c.first, **when)
        if self.estimates is None or errors is None:
            return FaultScore(found=np.where(busy, found, x.found), sums=x.sums)
        counting = rarely(busy | (active & detected(x.found)))
        own = self._estimated(c.own) if self.estimates == SITES else np.ones_like(errors)
        sums = add_errors(
            cast("Sums", x.sums), errors, own, found=found, before=x.found, settling=self.settling, **when
        )
        new: Part = tuple(np.where(counting, one, old) for one, old in zip(sums, cast("Sums", x.sums), strict=True))
        return FaultScore(found=np.where(counting, found, x.found), sums=new)

    def _estimated(self, own: Rows) -> Rows:
        """1 for the sites of a fault that the detector watches, else 0."""
        watched = [float(site in self.watches) for site in self.sites]
        return np.stack([row * one for row, one in zip(own, watched, strict=True)])


def _errors(verdict: Verdict, actual: Rows) -> Rows:
    """Estimate minus what it is of, (n_signals, n_cases); None without one of both."""
    if actual is None or verdict.estimate is None:
        return None
    error = verdict.estimate - actual
    return error if np.ndim(error) == 2 else error[np.newaxis]


def _finite(verdict: Verdict) -> Row:
    """Whether residual and estimate are finite; what is not is not repaired but said."""
    finite = np.abs(verdict.residual) < np.inf
    if verdict.estimate is None:
        return finite
    size = np.abs(verdict.estimate)
    return finite & ((total(size) if np.ndim(size) == 2 else size) < np.inf)


def _sound(verdict: Verdict, declared: Rows) -> Row:
    """Whether declarations and alarm are 0 or 1."""
    alarm = verdict.alarm * 1.0
    return total(np.abs(declared * (declared - 1.0))) + np.abs(alarm * (alarm - 1.0)) == 0.0


def _onset(c: ScoreConstants, sample: Row) -> Row:
    """Whether a site becomes faulty at this sample, or a fault begins."""
    firsts = [*c.faulty_from, *(fault.first for fault in c.faults)]
    return total([np.where(sample == first, 1.0, 0.0) for first in firsts]) > 0.0
