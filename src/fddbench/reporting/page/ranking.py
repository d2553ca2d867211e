"""The detectors of a campaign, best first: one line each, over all faulty scenarios together."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.clustered import PooledShare, korn_graubard
from fddbench.metrics.paired import PairedShares, paired_shares
from fddbench.reporting.page.columns import Columns

__all__ = ["Rank", "Weakest", "beside_best", "ranking", "second_beside_best"]


@dataclass(frozen=True, kw_only=True)
class Weakest:
    """Scenario in which a detector fails most often, in how many of its decided flights, and how many more are as bad."""

    scenario: str
    failed: int
    decided: int
    also: int = 0


@dataclass(frozen=True, kw_only=True)
class Rank:
    """One detector.

    Attributes
    ----------
    detector : str
        Its name.
    number : int
        Its place in the campaign: the colour of its lines.
    faulty, decided, undecided : int
        Flown flights with faults, and how many of them are decided and not.
    right : PooledShare
        Share of the decided ones that were right in time, by run.
    outcomes : mapping of str to int
        Flights by outcome.
    distinct_flights, alarms : int
        Healthy flights until their onsets, each once, and those with a false alarm.
    runs : int
        Runs that these come from: flights of one run are one witness.
    alarms_high_percent : float or None
        Upper end of the 95 % interval of their share, by run [%].
    weakest : Weakest or None
        None: nothing failed, or nothing was decided.
    lost : int
        Flights without a score, because the detector did not come to their end.
    names_sites : bool
        False: it only detects.
    in_sample, voted : bool
        Tuned on these flights; sees the voted signal alone.
    """

    detector: str
    number: int
    faulty: int
    decided: int
    undecided: int
    right: PooledShare
    outcomes: dict[str, int]
    distinct_flights: int
    alarms: int
    alarms_high_percent: float | None
    weakest: Weakest | None
    runs: int = 0
    lost: int = 0
    names_sites: bool = True
    in_sample: bool = False
    voted: bool = False


def ranking(
    columns: Columns, alarms: pd.DataFrame, *, in_sample: Collection[str] = (), voted: Collection[str] = ()
) -> list[Rank]:
    """Detectors by the share of decided faulty flights that were right, then fewest healthy sites declared and false alarms.

    Those that see the voted signal alone come after all others, for they see less; flights that a detector did not bring to an
    end are none that it was right in.
    """
    of = {str(line["detector"]): line for line in alarms.to_dict("records")}
    lines = []
    for number, name in enumerate(columns.detectors):
        places = columns.of(number)
        own = places[columns.ok[places] & columns.faulty[places]]
        outcome = columns.texts("outcome")[own]
        sure = np.asarray(outcome != "undecided", dtype=bool)
        counts = pd.Series(outcome).value_counts()
        line = of.get(name, {})
        high = line.get("alarms_high_percent")
        lines.append(
            Rank(
                detector=name,
                number=number,
                faulty=len(own),
                decided=int(sure.sum()),
                undecided=int((~sure).sum()),
                right=korn_graubard(outcome[sure] == "right", columns.whole("run", own[sure])),
                outcomes={str(each): int(n) for each, n in counts.items()},
                distinct_flights=int(line.get("distinct_flights", 0)),
                alarms=int(line.get("alarms", 0)),
                alarms_high_percent=None if high is None or pd.isna(high) else float(high),
                weakest=_weakest(columns, own),
                runs=int(line.get("runs", 0)),
                lost=int(columns.lost[places].sum()),
                names_sites=not len(own) or not bool(np.isnan(columns.numbers("isolated")[own]).all()),
                in_sample=name in in_sample,
                voted=name in voted,
            )
        )
    return sorted(lines, key=_order)


def _order(line: Rank) -> tuple[bool, float, float, float, int]:
    share = -1.0 if line.right.share is None else line.right.share * line.decided / (line.decided + line.lost)
    wrong = line.outcomes.get("wrong_site", 0) / max(line.decided, 1)
    return line.voted, -share, wrong, line.alarms / max(line.distinct_flights, 1), line.number


def _weakest(columns: Columns, own: "np.ndarray[Any, Any]") -> Weakest | None:
    """Of scenarios with equal shares that with most failures, then the first."""
    sure = columns.decided[own]
    scenario, n = columns.scenario[own][sure], len(columns.scenarios)
    decided = np.bincount(scenario, minlength=n)
    failed = np.bincount(scenario[columns.failed[own][sure]], minlength=n)
    if not failed.any():
        return None
    share = np.where(decided > 0, failed / np.maximum(decided, 1), -1.0)
    at = max(range(n), key=lambda i: (share[i], failed[i], -i))
    also = int(np.sum(share == share[at])) - 1
    return Weakest(scenario=columns.scenarios[at], failed=int(failed[at]), decided=int(decided[at]), also=also)


def beside_best(columns: Columns, best: int, other: int, scenario: int | None = None) -> PairedShares:
    """Right shares of two detectors on the faulty flights that both have decided; of one scenario or of all.

    The difference is that of `other` less that of `best`.
    """
    names = ("scenario", "point", "level", "run")
    sides = []
    for number in (best, other):
        places = columns.of(number) if scenario is None else columns.cell(scenario, number)
        sure = places[columns.decided[places] & columns.faulty[places]]
        keys = (columns.scenario[sure], *(columns.whole(name, sure) for name in names[1:]))
        side = pd.DataFrame(dict(zip(names, keys, strict=True)))
        sides.append(side.assign(right=columns.texts("outcome")[sure] == "right"))
    both = sides[0].merge(sides[1], on=list(names), suffixes=("_a", "_b"))
    a, b = both["right_a"].to_numpy(dtype=bool), both["right_b"].to_numpy(dtype=bool)
    run = both["run"].to_numpy()
    return paired_shares(a, b, run)


def second_beside_best(columns: Columns, ranks: Sequence[Rank]) -> PairedShares | None:
    """The second of those with a decided flight beside the first; None where there are not two."""
    known = [line.number for line in ranks if line.decided]
    return beside_best(columns, known[0], known[1]) if len(known) > 1 else None
