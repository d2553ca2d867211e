"""A folder of results becomes one of a larger campaign; what it holds stays as it is, and a run flies the rest."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from fddbench.campaign.growth import in_the_way, points_in
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan
from fddbench.campaign.plan import plan as planned
from fddbench.errors import ResultsError
from fddbench.results.fingerprint import Fingerprint, differences
from fddbench.results.folder import grow, provenance_of, put_back
from fddbench.results.lock import locked
from fddbench.results.stages import Stage, stages_in
from fddbench.runner.assembling import assemble
from fddbench.runner.fingerprint import fingerprint_of, provenance_for
from fddbench.runner.rows import schemas_of

__all__ = ["as_far_as", "grow_to"]


def grow_to(folder: Path, old: Campaign, new: Campaign) -> None:
    """Make a folder of the results of `old` one of `new`.

    Raises
    ------
    ResultsError
        What decides rows that are there differs, which is told.
    """
    was, now, here = planned(old), planned(new), fingerprint_of(new)
    with locked(folder):  # from the first look on: what is written stands on what was read
        there = provenance_of(folder)
        if Fingerprint.of(there).sha256 == here.sha256:  # a crash came before the campaign was frozen
            put_back(folder, new.files())
            return
        _require_growth(folder, there, was, now, here)
        provenance = _grown(there, was, now, provenance_for(now, here), list(schemas_of(assemble(new))[0].names))
        grow(folder, files=new.files(), provenance=provenance)


def _require_growth(folder: Path, there: Mapping[str, Any], was: Plan, now: Plan, here: Fingerprint) -> None:
    """Refuse what would change rows that are there, and a folder that is not of the campaign it grows from.

    Raises
    ------
    ResultsError
        Either of them.
    """
    flown = Fingerprint.of(there)
    told = [*in_the_way(was, now), *differences(flown, as_far_as(flown, here))]
    if told:
        raise ResultsError(
            f"{folder} cannot be extended to this campaign, because rows that are there would not be its rows:\n"
            + "\n".join(f"  {line}" for line in told)
            + "\nFly it into another folder instead: fddbench run ... --out DIR"
        )
    if flown.campaign_sha256 != was.campaign.sha256:  # its stages are numbered for the larger one
        raise ResultsError(
            f"{folder} is being extended to another campaign, or that was cut off; ask for the one that was begun first, then "
            "extend it further"
        )


def as_far_as(there: Fingerprint, here: Fingerprint) -> Fingerprint:
    """What flies now, without what more is in it than there was."""
    return replace(
        here,
        campaign_sha256=there.campaign_sha256,
        files={name: digest for name, digest in here.files.items() if name in there.files},
        libraries={name: version for name, version in here.libraries.items() if name in there.libraries},
        source={name: digest for name, digest in here.source.items() if name in there.source},
    )


def _grown(
    there: Mapping[str, Any], was: Plan, now: Plan, fresh: Mapping[str, Any], columns: list[str]
) -> dict[str, Any]:
    """Provenance of today with what earlier shards need to be read: their fingerprints and stages."""
    points = points_in(was, now)
    same = bool((points == range(len(points))).all())
    earlier = stages_in(there) or (_stage(there, was),)
    stages = [
        each if same else replace(each, points=tuple(points[list(each.points or range(_points(each)))].tolist()))
        for each in earlier
    ]
    return {
        **fresh,
        "fingerprints": [*there["fingerprints"], *fresh["fingerprints"]],
        "stages": [each.plain() for each in (*stages, _stage(fresh, now))],
        "columns": columns,
        "begun": there["begun"],
    }


def _points(stage: Stage) -> int:
    return max((points for points, _, _ in stage.scenarios.values()), default=0)


def _shape(plan: Plan) -> dict[str, tuple[int, int, int]]:
    """Points, levels and runs of every scenario."""
    return {each.name: (each.n_points, each.n_levels, each.n_runs) for each in plan.scenarios}


def _stage(provenance: Mapping[str, Any], plan: Plan) -> Stage:
    return Stage(
        fingerprint=Fingerprint.of(provenance).sha256,
        scenarios=_shape(plan),
        detectors=tuple(provenance["designs_sha256"]),
        points=None,
        campaign_yaml_sha256=str(provenance["campaign_yaml_sha256"]),
    )
