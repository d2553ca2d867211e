"""Whether a campaign is another one with more in it: flights of the smaller are then flights of the larger, bit for bit."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from fddbench.campaign.meaning import Campaign, Scenario
from fddbench.campaign.plan import Plan
from fddbench.campaign.rules.dispersions import Dispersions
from fddbench.campaign.sampling import digits, point_radices

__all__ = ["in_the_way", "points_in"]

_EQUAL = {
    "name": "the name",
    "benchmark": "the benchmark",
    "purpose": "the purpose",
    "seed": "the seed",
    "sample_s": "sample_s",
    "substeps": "substeps",
    "duration_s": "duration_s",
    "reconfigure": "reconfigure",
    "keep": "keep",
}


def in_the_way(old: Plan, new: Plan) -> Iterator[str]:
    """Why rows of `old` are no rows of `new`, in words; nothing where `new` only has more.

    What may differ: more runs, more values in the grid, longer sequences, more scenarios, more detectors, and what decides no
    row (`about`, `report`).
    """
    was, now = old.campaign, new.campaign
    for key, word in _EQUAL.items():
        if getattr(was, key) != getattr(now, key):
            yield f"{word} was {getattr(was, key)!r} and is {getattr(now, key)!r}"
    if was.keep != "all" and was.kept_runs != now.kept_runs:
        yield f"kept_runs was {was.kept_runs} and is {now.kept_runs}"
    if dict(was.choices) != dict(now.choices):
        yield f"the choices were {_listed(was.choices)} and are {_listed(now.choices)}"
    yield from _dispersions(was.dispersions, now.dispersions)
    yield from _draws(was, now)
    yield from _scenarios(old, new)
    designs = {design.name: design.sha256 for design in now.designs}
    for design in was.designs:
        if design.name not in designs:
            yield f"the detector {design.name} is gone"
        elif designs[design.name] != design.sha256:
            yield f"the design {design.name} is another one"
    for name, content in was.beside.items():
        if now.beside.get(name) != content:
            yield f"the file {name} beside the campaign is another one or gone"


def _listed(choices: object) -> str:
    return ", ".join(f"{key} {value}" for key, value in dict(choices).items())  # type: ignore[call-overload]


def _dispersions(was: Dispersions, now: Dispersions) -> Iterator[str]:
    """What differs in the points."""
    if set(was.grid) != set(now.grid):
        yield f"the grid was of {', '.join(sorted(was.grid)) or 'nothing'} and is of {', '.join(sorted(now.grid)) or 'nothing'}"
    else:
        for name, values in was.grid.items():
            lost = sorted(set(values) - set(now.grid[name]))
            if lost:
                yield f"the grid of {name} has {', '.join(map(repr, lost))} no more"
    if set(was.sequence) != set(now.sequence):
        yield "the sequence is of other parameters"
    else:
        for name, values in was.sequence.items():
            if tuple(now.sequence[name][: len(values)]) != tuple(values):
                yield f"the sequence of {name} does not begin as it was"


def _draws(was: Campaign, now: Campaign) -> Iterator[str]:
    """What differs in the draws."""
    old, new = was.dispersions.monte_carlo, now.dispersions.monte_carlo
    if (old is None) != (new is None):
        yield "monte_carlo is there in one of the two only"
        return
    if old is None or new is None:
        return
    if old.parameters != new.parameters or old.correlation != new.correlation or old.sampling != new.sampling:
        yield "monte_carlo draws something else"
    if old.runs != new.runs and old.sampling == "lhs":
        yield "a Latin hypercube (sampling: lhs) is one of all its runs: it cannot have more; sobol and halton can"
    if old.table is not None or new.table is not None:
        rows = {name: now.table.get(name) for name in was.table}
        if set(was.table) != set(now.table) or not all(
            r is not None and np.array_equal(r[: len(was.table[name])], was.table[name]) for name, r in rows.items()
        ):
            yield "the table of cases does not begin as it was"


def _scenarios(old: Plan, new: Plan) -> Iterator[str]:
    now = {planned.name: planned for planned in new.scenarios}
    for planned in old.scenarios:
        if planned.name not in now:
            yield f"the scenario {planned.name} is gone"
            continue
        larger = now[planned.name]
        if _meaning(planned.scenario) != _meaning(larger.scenario) or planned.samples != larger.samples:
            yield f"the scenario {planned.name} is another one"
        elif larger.n_runs < planned.n_runs:
            yield f"the scenario {planned.name} had {planned.n_runs} runs and has {larger.n_runs}"


def _meaning(scenario: Scenario) -> tuple[object, ...]:
    faults = [fault.model_dump(mode="json", by_alias=True) for fault in scenario.faults]
    return (scenario.entry.model_dump(mode="json", exclude={"runs"}), faults)


def points_in(old: Plan, new: Plan) -> npt.NDArray[np.int64]:
    """Numbers in `new` of the points of `old`, whose grids have the same parameters, (n_points,)."""
    was, now = old.campaign.dispersions, new.campaign.dispersions
    radices = point_radices(was)
    n_points = int(np.prod(radices, dtype=np.int64))
    *grid, sequence = digits(np.arange(n_points), radices)
    found = np.zeros(n_points, dtype=np.int64)
    for name, digit, radix in zip(sorted(was.grid), grid, point_radices(now), strict=False):
        place = np.array([now.grid[name].index(value) for value in was.grid[name]], dtype=np.int64)
        found = found * radix + place[digit]
    return found * point_radices(now)[-1] + sequence
