"""Dispersed values that a benchmark flies, and distributions that can be drawn."""

from collections.abc import Iterator
from math import erf, sqrt

import numpy as np

from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.dispersions import Distribution, MonteCarlo, TruncatedNormal
from fddbench.campaign.rules.model import CampaignFile
from fddbench.campaign.rules.wording import unit_of
from fddbench.campaign.shares import correlation_matrix
from fddbench.errors import Mistake
from fddbench.interfaces import Parameter, Plant

__all__ = ["ranges"]

_LEAST_EIGENVALUE = 1e-9
_LEAST_PROBABILITY = 0.1
"""Of a truncated normal's window: what is drawn again more than ten times on average was meant otherwise."""


def ranges(document: Document, written: CampaignFile, plant: Plant) -> Iterator[Mistake]:
    """Every dispersed value that the benchmark does not fly, and every distribution that cannot be drawn."""
    known = {entry.name: entry for entry in plant.parameters}
    dispersions = written.dispersions
    for block, lists in (("grid", dispersions.grid), ("sequence", dispersions.sequence)):
        for name, values in lists.items():
            for number, value in enumerate(values):
                yield from _outside(document, ("dispersions", block, name, number), value, known[name])
    yield from _twice(document, written)
    lengths = {name: len(values) for name, values in dispersions.sequence.items()}
    if len(set(lengths.values())) > 1:
        counts = ", ".join(f"{name} has {n}" for name, n in lengths.items())
        message = f"the lists of a sequence are walked together and need one length: {counts}"
        yield document.mistake(("dispersions", "sequence"), message, key=True)
    if dispersions.monte_carlo:
        for name, distribution in dispersions.monte_carlo.parameters.items():
            yield from _distribution(document, ("dispersions", "monte_carlo", name), distribution, known[name])
        yield from _correlations(document, dispersions.monte_carlo)
        yield from _fixed_runs(document, written)


def _correlations(document: Document, drawn: MonteCarlo) -> Iterator[Mistake]:
    """Correlations of what is not drawn, that no two numbers have, or that no set of numbers has together."""
    at: Address = ("dispersions", "monte_carlo", "correlation")
    pairs: list[frozenset[str]] = []
    for number, (*pair, value) in enumerate(drawn.correlation):
        for place, name in enumerate(pair):
            if name not in drawn.parameters:
                known = ", ".join(drawn.parameters) or "none"
                yield document.mistake((*at, number, place), f"{name!r} is not drawn here; drawn are: {known}")
        if len(set(pair)) < 2 or frozenset(pair) in pairs:
            text = "a parameter is correlated with another one" if len(set(pair)) < 2 else "this pair is there already"
            yield document.mistake((*at, number), f"{text}; name each pair once")
        if not -1.0 < value < 1.0:
            yield document.mistake((*at, number, 2), f"a correlation lies between -1 and 1, got {value:g}")
        pairs.append(frozenset(pair))
    names = sorted(set().union(*pairs)) if pairs else []
    sound = all(len(pair) == 2 for pair in pairs) and all(-1.0 < value < 1.0 for *_, value in drawn.correlation)
    if names and sound and np.linalg.eigvalsh(correlation_matrix(names, drawn.correlation)).min() < _LEAST_EIGENVALUE:
        message = (
            "no numbers have all these correlations at once (the matrix is not positive definite); make them smaller"
        )
        yield document.mistake(at, message, key=True)


def _fixed_runs(document: Document, written: CampaignFile) -> Iterator[Mistake]:
    """Scenarios with runs of their own where a sample is one whole, or longer than a table."""
    drawn = written.dispersions.monte_carlo
    if drawn is None or (drawn.sampling != "lhs" and drawn.table is None):
        return
    for number, entry in enumerate(written.scenarios):
        if entry.runs is not None and (
            entry.runs > drawn.runs or (drawn.sampling == "lhs" and entry.runs < drawn.runs)
        ):
            what = (
                "a Latin hypercube is one sample of all runs"
                if drawn.sampling == "lhs"
                else "the table has no more rows"
            )
            message = f"{what}: dispersions.monte_carlo.runs is {drawn.runs}, got {entry.runs}; remove this key"
            yield document.mistake(("scenarios", number, "runs"), message)


def _twice(document: Document, written: CampaignFile) -> Iterator[Mistake]:
    """Points that are there twice: values of a grid, and steps of a sequence."""
    for name, values in written.dispersions.grid.items():
        for number, value in enumerate(values):
            if value in values[:number]:
                message = f"{name} lists {value:g} twice; every value of a grid is flown once, list it once"
                yield document.mistake(("dispersions", "grid", name, number), message)
    steps = list(zip(*written.dispersions.sequence.values(), strict=False))
    for number, step in enumerate(steps):
        if step in steps[:number]:
            message = f"steps {steps.index(step) + 1} and {number + 1} of the sequence are the same point; list it once"
            yield document.mistake(("dispersions", "sequence"), message, key=True)


def _outside(document: Document, address: Address, value: float, parameter: Parameter) -> Iterator[Mistake]:
    if parameter.whole and value != round(value):
        yield document.mistake(address, f"{parameter.name} is a whole number ({parameter.about}), got {value:g}")
        return
    if not parameter.low <= value <= parameter.high:
        unit = unit_of((parameter.name,))
        message = f"{parameter.name} must be within {parameter.low:g} to {parameter.high:g}{unit}, got {value:g}"
        yield document.mistake(address, message)


def _distribution(
    document: Document, address: Address, distribution: Distribution, parameter: Parameter
) -> Iterator[Mistake]:
    if parameter.whole:
        message = f"{parameter.name} counts and is not drawn; list the numbers in a grid or a sequence"
        yield document.mistake(address, message, key=True)
        return
    given = sorted(distribution.model_fields_set)
    if len(given) != 1 or getattr(distribution, given[0]) is None:
        got = " and ".join(given) or "none"
        yield document.mistake(
            address, f"need one of uniform, normal, truncated_normal for {parameter.name}, got {got}"
        )
        return
    at = (*address, given[0])
    window = distribution.truncated_normal
    if distribution.normal is not None:
        yield from _outside(document, (*at, "mean"), distribution.normal.mean, parameter)
        return
    low, high = (window.low, window.high) if window else distribution.uniform or (parameter.low, parameter.high)
    names: tuple[str | int, str | int] = ("low", "high") if window else (0, 1)
    yield from _outside(document, (*at, names[0]), low, parameter)
    yield from _outside(document, (*at, names[1]), high, parameter)
    if not low < high:
        yield document.mistake(at, f"low must lie below high, got low {low:g} and high {high:g}")
    elif window is not None:
        yield from _improbable(document, at, window)


def _improbable(document: Document, address: Address, window: TruncatedNormal) -> Iterator[Mistake]:
    below = [0.5 + 0.5 * erf((edge - window.mean) / (window.std * sqrt(2.0))) for edge in (window.low, window.high)]
    probability = below[1] - below[0]
    if probability < _LEAST_PROBABILITY:
        message = (
            f"the window {window.low:g} to {window.high:g} holds {100.0 * probability:.2g} % of the normal "
            f"distribution, needs at least {100.0 * _LEAST_PROBABILITY:g} %; widen it, move the mean into it or draw "
            "uniform: [low, high]"
        )
        yield document.mistake(address, message)
