"""The faults of a batch of flights: what was drawn or swept, when each begins and ends, how soon it must be found."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fddbench.campaign.addresses import Addresses, Numbers
from fddbench.campaign.plan import Plan
from fddbench.faults.timing import first_samples, last_sample
from fddbench.interfaces import NEVER, Fault, Floats
from fddbench.runner.in_log import add_labelled, in_what_flies

__all__ = ["BatchFaults", "batch_faults"]


@dataclass(frozen=True, kw_only=True, eq=False)
class BatchFaults:
    """Faults of some cases; a line is a fault of a scenario, in the order of the file, or behind them one in what flies.

    Attributes
    ----------
    first, last : (n_lines, n_cases) arrays
        First and last faulty sample of each fault, on whichever of its sites is first; `NEVER` for none.
    last_onset : (n_lines, n_cases) array
        Sample at which the last of its sites turns faulty.
    limit_s : (n_cases,) array
        From the first onset of the flight, how soon all must be found [s]; not-a-number in a healthy flight.
    event_limits_s : (n_lines, n_cases) array
        The same for each fault by itself, from its own onset [s].
    numbers : mapping of str to (n_cases,) arrays
        What differs between flights, by its column; not-a-number where a scenario does not vary it.
    labelled : (n_labelled, n_sites, n_cases) array
        First faulty sample of every site of the faults that are in what flies: the last lines.
    """

    first: Floats
    last: Floats
    last_onset: Floats
    limit_s: Floats
    event_limits_s: Floats
    numbers: Mapping[str, Floats]
    labelled: Floats

    @property
    def k0(self) -> Floats:
        """First faulty sample of each flight, (n_cases,); `NEVER` in a healthy one."""
        found: Floats = self.first.min(axis=0, initial=NEVER)
        return found

    def take(self, which: Numbers) -> "BatchFaults":
        """Those of some of the cases."""
        return BatchFaults(
            first=self.first[:, which],
            last=self.last[:, which],
            last_onset=self.last_onset[:, which],
            limit_s=self.limit_s[which],
            event_limits_s=self.event_limits_s[:, which],
            numbers={name: values[which] for name, values in self.numbers.items()},
            labelled=self.labelled[:, :, which],
        )


def batch_faults(
    plan: Plan, at: Addresses, parameters: Mapping[str, Floats] | None = None
) -> tuple[list[Sequence[Fault]], BatchFaults]:
    """Faults of every scenario as these flights fly them (of scenarios that do not fly, as written), and their times.

    `parameters` are those of the flights; they say which faults are in what flies, where there can be any.
    """
    n_cases, injected = len(at.run), max((len(planned.faults) for planned in plan.scenarios), default=0)
    own = None if parameters is None or not plan.n_labelled else in_what_flies(plan, parameters)
    n_lines = injected + (0 if own is None else len(own.first))
    lists: list[Sequence[Fault]] = [planned.faults for planned in plan.scenarios]
    found = BatchFaults(
        first=np.full((n_lines, n_cases), NEVER),
        last=np.full((n_lines, n_cases), NEVER),
        last_onset=np.full((n_lines, n_cases), NEVER),
        limit_s=np.full(n_cases, np.nan),
        event_limits_s=np.full((n_lines, n_cases), np.nan),
        numbers={column: np.full(n_cases, np.nan) for column in plan.columns},
        labelled=np.full((0, len(plan.plant.sites), n_cases), NEVER) if own is None else own.first,
    )
    for s in np.unique(at.scenario).tolist():
        mine = at.scenario == s
        faults, numbers = plan.flown(s, at.level[mine], at.run[mine])
        lists[s] = faults
        for column, values in numbers.items():
            found.numbers[column][mine] = values
        if faults:
            _fill(found, plan, s, faults, mine)
    if own is not None:
        add_labelled(found, plan, own, at.scenario, injected)
    return lists, found


def _fill(found: BatchFaults, plan: Plan, s: int, faults: Sequence[Fault], mine: Numbers) -> None:
    """Times of the flights of one scenario."""
    planned, sample_s = plan.scenarios[s], plan.campaign.sample_s
    for line, fault in enumerate(faults):
        each = first_samples(fault, fault.sites, sample_s)
        found.first[line, mine], found.last_onset[line, mine] = each[0], each[-1]
        found.last[line, mine] = last_sample(fault, sample_s)
    lines, requirement_s = len(faults), planned.requirement_s
    assert requirement_s is not None
    first, last_onset = found.first[:lines, mine], found.last_onset[:lines, mine]
    own = np.array(planned.event_requirements_s)[:, np.newaxis]
    found.event_limits_s[:lines, mine] = _seconds(last_onset - first, sample_s) + own
    found.limit_s[mine] = _seconds(last_onset.max(axis=0) - first.min(axis=0), sample_s) + requirement_s


def _seconds(samples: Floats, sample_s: float) -> Floats:
    """Times of sample numbers [s], without the digits that binary fractions add."""
    rounded: Floats = np.round(samples * sample_s, 9)
    return rounded
