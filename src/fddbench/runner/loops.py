"""The closed loop of a campaign, looked at before anything is flown with it: its parts may be anybody's."""

import inspect
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan
from fddbench.errors import FddbenchError, place_of, reason_of
from fddbench.interfaces import Loop, Options
from fddbench.plugin_files import noticed_reads
from fddbench.runner.assembly import Assembly

__all__ = ["loop_of", "try_loop"]

_NEEDS = ("bus", "states", "constants", "draws", "before", "truth", "prepare", "start", "step")


def loop_of(planned: Plan) -> Loop:
    """Closed loop of a campaign's benchmark with its options.

    Raises
    ------
    FddbenchError
        It cannot be made, lacks something, or reads a file that would not travel with the results.
    """
    campaign = planned.campaign
    options = Options(
        chosen=campaign.chosen,
        sample_s=campaign.sample_s,
        substeps=campaign.substeps,
        faults=tuple(scenario.faults for scenario in planned.scenarios),
    )
    with noticed_reads(campaign.path.parent) as read, _told(campaign, campaign.bench, "its loop cannot be made"):
        loop = campaign.bench.loop(options)
    missing = [name for name in _NEEDS if name not in dir(loop)]
    if missing:
        raise FddbenchError(
            f"{_who(campaign)}: its loop has no {' and no '.join(missing)}; see fddbench.interfaces.Loop for what it needs"
        )
    stray = sorted(set(read) - set(campaign.beside))
    if stray and campaign.beside:
        raise FddbenchError(
            f"{_who(campaign)} reads {', '.join(stray)} beside the campaign, which would not travel with the results; declare "
            f"it in its Python file: FILES = ({', '.join(map(repr, stray))},)"
        )
    return loop


def try_loop(assembly: Assembly) -> None:
    """Prepare the first and the last flight of a campaign and fly one sample of them.

    Raises
    ------
    FddbenchError
        What went wrong, with the line of the author's code.
    """
    campaign, loop = assembly.plan.campaign, assembly.loop
    cases = np.unique([0, assembly.plan.n_cases - 1]).astype(np.int64)
    with _told(campaign, loop, "its flights cannot be prepared"):
        batch = assembly.batch(cases)
    drawn = assembly.normals(loop.draws, batch, 0, 1)[0]
    x, c = loop.states.unpack(batch.state), loop.constants.unpack(batch.constants)
    with np.errstate(all="ignore"), _told(campaign, loop, "its step cannot be flown"):
        after, seen = loop.step(x, c, loop.draws.unpack(drawn), np.float64(0.0))
        loop.states.check(after, len(cases))
        _require(seen, loop, len(cases))


def _require(seen: Any, loop: Loop, n_cases: int) -> None:
    """Refuse a sample that is not what the loop announces.

    Raises
    ------
    TypeError
        With what is missing or of another shape.
    """
    measured = vars(seen.measured)
    if measured.keys() != set(loop.bus.signals):
        raise TypeError(f"the bus announces {sorted(loop.bus.signals)}, the sample measures {sorted(measured)}")
    if seen.truth.keys() != set(loop.truth):
        raise TypeError(f"the loop announces the truths {sorted(loop.truth)}, the sample shows {sorted(seen.truth)}")
    shapes = {
        name: (measured[name], (rows, n_cases) if rows else (n_cases,)) for name, rows in loop.bus.signals.items()
    }
    shapes |= {name: (value, (n_cases,)) for name, value in (*seen.truth.items(), ("departed", seen.departed))}
    wrong = [
        f"{name} of shape {need}, got {np.shape(value)}"
        for name, (value, need) in shapes.items()
        if np.shape(value) != need
    ]
    if wrong:
        raise TypeError(f"a sample needs {'; '.join(wrong)}")


def _who(campaign: Campaign) -> str:
    return f"{campaign.path}: the benchmark {campaign.benchmark!r}"


@contextmanager
def _told(campaign: Campaign, thing: Any, what: str) -> Iterator[None]:
    """Turn whatever foreign code raises into a message with the line that raised."""
    try:
        yield
    except FddbenchError as error:
        raise FddbenchError(f"{_who(campaign)}: {error}") from error
    except (Exception, SystemExit) as error:
        folders = [Path(inspect.getfile(type(thing))).parent, campaign.path.parent]
        raise FddbenchError(f"{_who(campaign)}: {what}: {reason_of(error)}{place_of(error, folders)}") from error
