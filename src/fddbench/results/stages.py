"""A folder of results that grew: how the numbers of its earlier shards translate into the case table of today.

A shard numbers its flights in the plan of the campaign that flew it. When a campaign is extended, old shards keep their bytes;
provenance.json keeps of each earlier stage the shape of its plan, and the shards are read through it. Without stages the folder
never grew and numbers are what they are.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.errors import ResultsError
from fddbench.results.manifest import Shard

__all__ = ["Numbering", "Stage", "stages_in"]

Cases = npt.NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class Stage:
    """What a folder was to hold once.

    Attributes
    ----------
    fingerprint : str
        Of the shards that were flown then.
    scenarios : mapping of str to (points, levels, runs)
        Shape of the plan, in its order.
    detectors : tuple of str
        All of that time.
    points : tuple of int, or None
        Numbers that its points have today; None: the same.
    campaign_yaml_sha256 : str
        Of the frozen campaign of that time.
    """

    fingerprint: str
    scenarios: Mapping[str, tuple[int, int, int]]
    detectors: tuple[str, ...]
    points: tuple[int, ...] | None
    campaign_yaml_sha256: str

    def plain(self) -> dict[str, Any]:
        """Data for provenance.json."""
        return {
            "fingerprint": self.fingerprint,
            "scenarios": {name: list(shape) for name, shape in self.scenarios.items()},
            "detectors": list(self.detectors),
            "points": None if self.points is None else list(self.points),
            "campaign_yaml_sha256": self.campaign_yaml_sha256,
        }


def stages_in(provenance: Mapping[str, Any]) -> tuple[Stage, ...]:
    """Stages of a folder, the one of today last; none of one that never grew.

    Raises
    ------
    ResultsError
        They are not as they were written.
    """
    try:
        return tuple(
            Stage(
                fingerprint=str(each["fingerprint"]),
                scenarios={str(k): (int(p), int(v), int(r)) for k, (p, v, r) in each["scenarios"].items()},
                detectors=tuple(str(name) for name in each["detectors"]),
                points=None if each["points"] is None else tuple(int(p) for p in each["points"]),
                campaign_yaml_sha256=str(each["campaign_yaml_sha256"]),
            )
            for each in provenance.get("stages", ())
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ResultsError(
            f"the stages in provenance.json are not as they were written ({error}); put it back"
        ) from error


class Numbering:
    """Numbers of flights in the case table of today, and which detectors have rows of them.

    Parameters
    ----------
    provenance : mapping
        Of the folder.
    """

    def __init__(self, provenance: Mapping[str, Any]) -> None:
        self.flights: dict[str, int] = {str(name): int(n) for name, n in provenance["flights"].items()}
        self.detectors: tuple[str, ...] = tuple(provenance["designs_sha256"])
        stages = stages_in(provenance)
        self._stages = {stage.fingerprint: stage for stage in stages}
        self._now = stages[-1].scenarios if stages else {}
        starts = np.cumsum([0, *self.flights.values()])
        self._first = dict(zip(self.flights, starts.tolist(), strict=False))
        self.n_cases = int(starts[-1])

    def numbers(self, shard: Shard) -> Cases:
        """Numbers today of the flights of a shard.

        Raises
        ------
        ResultsError
            It has flights beyond the case table.
        """
        cases = np.concatenate([np.arange(first, first + n) for first, n in shard.cases] or [np.empty(0, np.int64)])
        stage = self._stages.get(shard.fingerprint)
        total = self.n_cases if stage is None else sum(int(np.prod(shape)) for shape in stage.scenarios.values())
        if len(cases) and (cases.min() < 0 or cases.max() >= total):
            raise ResultsError(
                f"{shard.rows} holds flights beyond the {total} of its campaign; fly it anew with --fresh"
            )
        return cases if stage is None else self._today(stage, cases)

    def _today(self, stage: Stage, cases: Cases) -> Cases:
        found, first = np.empty_like(cases), 0
        for name, (n_points, n_levels, n_runs) in stage.scenarios.items():
            mine = (cases >= first) & (cases < first + n_points * n_levels * n_runs)
            rest, run = np.divmod(cases[mine] - first, n_runs)
            point, level = np.divmod(rest, n_levels)
            point = point if stage.points is None else np.asarray(stage.points, dtype=np.int64)[point]
            found[mine] = self._first[name] + (point * n_levels + level) * self._now[name][2] + run
            first += n_points * n_levels * n_runs
        return found

    def points_of(self, fingerprint: str) -> Cases | None:
        """Numbers today of the points of shards of a fingerprint; None where they are the same."""
        stage = self._stages.get(fingerprint)
        return None if stage is None or stage.points is None else np.asarray(stage.points, dtype=np.int64)

    def detectors_of(self, shard: Shard) -> Sequence[str]:
        """Detectors that a shard has rows of."""
        stage = self._stages.get(shard.fingerprint)
        return shard.detectors or (self.detectors if stage is None else stage.detectors)

    def held(self, shards: Iterable[Shard]) -> npt.NDArray[np.int8]:
        """How often each detector of today has a row of each flight, (n_detectors, n_cases)."""
        count = np.zeros((len(self.detectors), self.n_cases), dtype=np.int8)
        place = {name: k for k, name in enumerate(self.detectors)}
        for shard in shards:
            rows = [place[name] for name in self.detectors_of(shard) if name in place]
            cases = self.numbers(shard)
            for row in rows:
                count[row, cases] += np.int8(1)
        return count
