"""When a fault was found, in one pass over the flight: one number for each fault, usable inside a traced step.

A fault with the sites S is *found* at the sample since which S ⊆ D(k) ⊆ F(k) has held without a break to its end; D are
the declared sites, F those that have been faulty so far. If that began before the fault did, or D did not change there,
it was declared before, which proves nothing about it. Looking back from the end of the fault tells this at once; a step
keeps instead, for each fault, the start of the stretch that may still last: `NEVER` while there is none, `BEFORE` (-1)
where its start cannot count, else its sample. At the end of the flight this number is the answer (`in_flight`), and the
largest over all faults is that of the flight: `NEVER` if one is missing, `BEFORE` if all were declared before.

State: that number for each fault, `NEVER` at the start, and what was declared at the sample before (the sites, or the
alarm), 0 at the start. Constants: of each site its first faulty sample (`NEVER`: healthy), of each fault its sites, its
first and its last faulty sample (`NEVER`: to the end of the flight). A fault that is not in a flight has first `NEVER`.
"""

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import total
from fddbench.interfaces import NEVER

__all__ = ["BEFORE", "NEVER", "changed", "detected", "found_by_alarm", "found_by_sites", "in_flight", "outside"]

BEFORE = -1.0
"""Instead of a sample: declared before the fault began, or standing when it did."""


def outside(declared: Rows, faulty_from: Rows, sample: Rows) -> Rows:
    """Whether a site is declared that has not been faulty yet: not D(k) ⊆ F(k), (n_cases,) of bool.

    Parameters
    ----------
    declared : (n_sites, n_cases) rows
        1 where a site is declared, else 0.
    faulty_from : (n_sites, n_cases) rows
        First faulty sample of each site by any fault, `NEVER` for a healthy one.
    sample : (n_cases,) row
        Number of the sample.
    """
    return total(np.where(sample < faulty_from, declared, 0.0)) > 0.0


def changed(declared: Rows, previous: Rows) -> Rows:
    """Whether another set of sites is declared than at the sample before, (n_cases,) of bool; before sample 0 none is."""
    return total(np.abs(declared - previous)) != 0.0


def detected(found: Rows) -> Rows:
    """Whether the number of a fault is a sample, (n_cases,) of bool."""
    return (found > BEFORE) & (found < NEVER)


def found_by_sites(
    found: Rows,
    own: Rows,
    declared: Rows,
    *,
    wrong: Rows,
    news: Rows,
    first: Rows,
    last: Rows,
    sample: Rows,
    active: Rows,
) -> Rows:
    """Number of one fault after one more sample, for a detector that isolates; from sample 0 on, not from its onset.

    Parameters
    ----------
    found : (n_cases,) row
        Number of the fault after the sample before.
    own, declared : (n_sites, n_cases) rows
        1 for the sites of the fault, and for those declared at this sample; else 0.
    wrong, news : (n_cases,) rows of bool
        `outside` and `changed` at this sample.
    first, last : (n_cases,) rows
        First and last faulty sample of the fault.
    sample : (n_cases,) row
        Number of the sample.
    active : (n_cases,) row of bool
        The sample is scored: the flight has neither departed nor ended.

    Returns
    -------
    (n_cases,) row
        `NEVER`, `BEFORE` or the sample at which the stretch began that still lasts.

    Examples
    --------
    Fault at 2, the site is declared at samples 3 and 5 to 6, so the fault is found at 5:

    >>> found, previous, own = np.array([NEVER]), np.zeros((1, 1)), np.ones((1, 1))
    >>> first, last, active = np.array([2.0]), np.array([NEVER]), np.array([True])
    >>> for k, value in enumerate([0, 0, 0, 1, 0, 1, 1]):
    ...     sample, declared = np.array([float(k)]), np.array([[float(value)]])
    ...     found = found_by_sites(
    ...         found, own, declared, wrong=outside(declared, first[np.newaxis], sample), news=changed(declared, previous),
    ...         first=first, last=last, sample=sample, active=active,
    ...     )
    ...     previous = declared
    >>> float(found[0])
    5.0
    """
    holds = (total(own * (1.0 - declared)) == 0.0) & ~wrong
    begun = np.where((sample >= first) & news, sample, BEFORE)
    since = np.where(holds, np.where(found == NEVER, begun, found), NEVER)
    return np.where(active & (sample <= last), since, found)


def found_by_alarm(
    found: Rows, alarm: Rows, previous: Rows, *, first: Rows, last: Rows, sample: Rows, active: Rows
) -> Rows:
    """Number of one fault after one more sample, for a detector that only detects.

    The first alarm *raised* from the onset to the end of the fault finds it, and need not stay. One that stands at the
    onset and at the sample before gives `BEFORE`, until it is let go and raised again.

    Parameters
    ----------
    found, first, last, sample, active : (n_cases,) rows
        As in `found_by_sites`.
    alarm, previous : (n_cases,) rows
        1 for an alarm at this sample and at the one before (0 before sample 0), else 0.
    """
    within = active & (sample >= first) & (sample <= last)
    unfound = (found == NEVER) | (found == BEFORE)
    raised = (alarm > 0.0) & (previous == 0.0)
    stands = (alarm > 0.0) & (previous > 0.0) & (sample == first)
    return np.where(within & unfound & raised, sample, np.where(within & stands, BEFORE, found))


def in_flight(found: Rows, *, first: Rows, last_scored: Rows) -> Rows:
    """Number of one fault of the whole flight; a fault that the flight did not reach is not found.

    Without this a second fault on a site that the first one made faulty, and that stays declared, would count as
    declared before although the flight ended before it began.

    Parameters
    ----------
    found, first : (n_cases,) rows
        After the last sample, and the fault's first faulty sample.
    last_scored : (n_cases,) row
        Last sample of the flight, or the one before its departure.
    """
    return np.where(last_scored < first, NEVER, found)
