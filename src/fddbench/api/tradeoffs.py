"""Trade-offs of a recipe: what each of its numbers buys and costs, guaranteed and flown."""

import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from fddbench.api.campaigns import read
from fddbench.campaign.finding import find_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.reading.overrides import ALONE
from fddbench.design.changed import changed_design
from fddbench.design.recipe import recipe_of
from fddbench.design.tuning.checks import require_tuning
from fddbench.designs.finding import find_design
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.results.table import load
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly
from fddbench.runner.load import detector_load
from fddbench.runner.replay import replay_campaign
from fddbench.runner.run import run_campaign

__all__ = ["tradeoff"]

_SETTLED_S = 2.0
"""Seconds at the beginning of a healthy flight that no noise is measured in."""


def tradeoff(
    design: str | Path,
    campaign: str | Path,
    keys: Mapping[str, Sequence[Any]],
    *,
    overrides: Sequence[str] = (),
    others: Sequence[str] = (),
    jobs: int = 2,
) -> pd.DataFrame:
    """Table of designs that differ from one by one key of its recipe, each made anew, and flown on tuning flights.

    Parameters
    ----------
    design : str or Path
        File or name of a design with a recipe, whose detector shows an estimate as the first of its signals.
    campaign : str or Path
        With ``purpose: tuning``; its own detectors do not fly.
    keys : mapping of str to sequence
        By key of the recipe (dots between levels), the values it takes, one at a time.
    overrides : sequence of str
        Changes of the campaign, as of ``fddbench run --set``.
    others : sequence of str
        Names of further designs to fly beside them.
    jobs : int
        Workers.

    Returns
    -------
    DataFrame
        A row per design: ``design``, ``key``, ``value`` (text), ``gamma``, ``gamma_lower_bound`` (in the problem of its own
        recipe; those of other weights are no smaller or larger for it), ``gamma_here`` (in the problem of `design`), and flown:
        ``rms_K`` and ``largest_margin_K`` of healthy flights at point K of the campaign's grid, ``chatter_1_s``, what the
        estimate changes in a second at point 0, ``right_SCENARIO_percent`` and ``median_SCENARIO_s``, ``operations`` a step.

    Raises
    ------
    FddbenchError
        The campaign is no tuning campaign, or a recipe gives no design.

    Examples
    --------
    >>> table = tradeoff("sliding_mode_lmi", "yaw_rate_smo_tuning", {"delta": [0.001, 0.1]})  # doctest: +SKIP
    """
    found = find_campaign(Path(campaign))
    asked = read(found, overrides)
    require_tuning(asked)
    path = Path(design) if Path(design).is_file() else find_design(str(design), found.parent)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        made = _made(path, keys, others, found.parent, folder / "detectors")
        (folder / "campaign.yaml").write_text(asked.text, encoding="utf-8")
        for own, content in asked.beside.items():
            (folder / own).write_bytes(content)
        flown = read(folder / "campaign.yaml", [f"detectors=[{', '.join(made)}]", *ALONE])
        run_campaign(flown, folder / "results", jobs=jobs)
        rows = load(folder / "results")
        assembly = assemble(flown)
        healthy = _healthy(flown, assembly)
    lines = [about | healthy[own] | _scores(rows, own) | _cost(assembly, own) for own, about in made.items()]
    return pd.DataFrame(lines)


def _made(
    path: Path, keys: Mapping[str, Sequence[Any]], others: Sequence[str], beside: Path, folder: Path
) -> dict[str, dict[str, Any]]:
    """Files of all designs in a folder; by name what the recipe of each says."""
    folder.mkdir()
    for plugin in path.parent.glob("*.py"):
        shutil.copy(plugin, folder)
    made, recipe = {}, recipe_of(path)
    for own in (path, *(find_design(other, beside) for other in others)):
        shutil.copy(own, folder / f"{own.stem}.yaml")
        data = yaml.safe_load(own.read_text(encoding="utf-8"))
        written = data.get("recipe") or {}
        made[own.stem] = _line(own.stem, "", "", written.get("found", {}), recipe.gamma_of(data["gains"]))
    for key, values in keys.items():
        for number, value in enumerate(values):
            name = f"{path.stem}.{key.rpartition('.')[2]}.{number + 1}"
            if name in made:
                raise DesignError(f"two keys end in {key.rpartition('.')[2]!r}: ask for them in two tables")
            cooked = changed_design(path, key, value, folder / f"{name}.yaml")
            text = yaml.safe_dump(value, default_flow_style=True, width=10_000).strip().removesuffix("...").strip()
            made[name] = _line(name, key, text, cooked.found, recipe.gamma_of(cooked.gains))
    return made


def _line(name: str, key: str, value: str, found: Mapping[str, Any], gamma_here: float | None) -> dict[str, Any]:
    bounds = {column: found.get(column) for column in ("gamma", "gamma_lower_bound")}
    return {"design": name, "key": key, "value": value, **bounds, "gamma_here": gamma_here}


def _healthy(campaign: Campaign, assembly: Assembly) -> dict[str, dict[str, float]]:
    """Root mean square, largest margin and chatter of every detector's estimate on healthy flights, by point."""
    kept: dict[str, dict[int, list[Floats]]] = {name: {} for name in assembly.detectors}
    names = [scenario.name for scenario in campaign.scenarios if not scenario.faults]
    first = round(_SETTLED_S / campaign.sample_s)
    for recording in replay_campaign(campaign, scenarios=names, signals=()):
        points = np.array([int(case.split("/")[1]) for case in recording.cases])
        for name, signals in recording.detectors.items():
            estimate = signals[assembly.detectors[name].recorded[0]][first:]
            for point in np.unique(points):
                kept[name].setdefault(int(point), []).append(estimate[:, points == point])
    return {name: _sizes(of_points, campaign.sample_s) for name, of_points in kept.items()}


def _sizes(of_points: Mapping[int, Sequence[Floats]], sample_s: float) -> dict[str, float]:
    found: dict[str, float] = {}
    for point, estimates in sorted(of_points.items()):
        squares = np.concatenate([(e**2).ravel() for e in estimates])
        found[f"rms_{point}"] = float(np.sqrt(np.nanmean(squares)))
    calm = np.concatenate([np.abs(np.diff(e, axis=0)).ravel() for e in of_points[min(of_points)]])
    return found | {"chatter_1_s": float(np.nanmean(calm)) / sample_s}


def _scores(rows: pd.DataFrame, detector: str) -> dict[str, float]:
    """Shares of right flights and median detection times by scenario, and largest margins of healthy flights by point."""
    own = rows[np.asarray((rows["detector"] == detector) & (rows["status"] == "ok"), dtype=bool)]
    found: dict[str, float] = {}
    for scenario, flights in own.groupby("scenario", sort=False):
        if (flights["n_faulty"] > 0).all():
            found[f"right_{scenario}_percent"] = 100.0 * float((flights["outcome"] == "right").mean())
            found[f"median_{scenario}_s"] = float(np.nanmedian(_numbers(flights["detection_time_s"])))
    for point, flights in own[np.asarray(own["n_faulty"] == 0, dtype=bool)].groupby("point"):
        found[f"largest_margin_{point}"] = float(np.nanmax(_numbers(flights["margin_healthy"])))
    return found


def _numbers(column: Any) -> Floats:
    numbers: Floats = column.to_numpy(dtype=np.float64, na_value=np.nan)
    return numbers


def _cost(assembly: Assembly, name: str) -> dict[str, float]:
    cost = detector_load(assembly.detectors[name], assembly.loop.bus, timed=False).cost
    return {} if cost is None else {"operations": float(cost.flops)}
