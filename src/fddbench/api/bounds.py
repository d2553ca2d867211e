"""The bound beside every score: how well the ideal test does, which knows the model, the fault and its time."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fddbench.api.flights import campaign_of
from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError, place_of, reason_of
from fddbench.interfaces import Floats, IdealModel
from fddbench.metrics.bound import P_FA, bound_line, bounds_table, detectability
from fddbench.runner.signatures import MOST_FLIGHTS, Signature, signatures

__all__ = ["bounds", "bounds_of"]

_UNSTATED = "the benchmark states no ideal model"


def bounds(source: Campaign | str | Path, *, p_fa: float = P_FA, flights: int = MOST_FLIGHTS) -> pd.DataFrame:
    """Detectability and probability of detection of the ideal test, a line per faulty scenario and model.

    Some flights of each scenario are flown without detectors for what their faults really add. Columns as in
    ``fddbench.columns("bounds")``. Where no bound is stated `model` is null and `about` says why.

    Parameters
    ----------
    source : Campaign, str or Path
        A campaign, its file or name, or a folder of results.
    p_fa : float
        Probability of a false alarm of the one decision [-].
    flights : int
        Flights of a scenario, evenly spaced among all of them.

    Raises
    ------
    FddbenchError
        The benchmark fails, or a number above makes no sense.

    Examples
    --------
    >>> table = bounds("yaw_rate_table8", flights=2)
    >>> table[table["model"] == "walk 0.5"].iloc[1][["scenario", "d", "p_d"]].tolist()
    ['oscill_b', 100.0, 1.0]
    """
    if flights < 1:
        raise FddbenchError(f"need at least one flight, got {flights=}")
    return bounds_of(campaign_of(source), p_fa=p_fa, flights=flights)


def bounds_of(campaign: Campaign, *, p_fa: float = P_FA, flights: int = MOST_FLIGHTS) -> pd.DataFrame:
    """`bounds` of a campaign."""
    why = _unstated(campaign)
    if why:
        names = [scenario.name for scenario in campaign.scenarios if scenario.faults]
        return bounds_table([{"scenario": name, "about": why} for name in names])
    known: Known = {}
    return bounds_table([line for one in signatures(campaign, flights) for line in _lines(campaign, one, p_fa, known)])


Known = dict[tuple[bytes, ...], "Mapping[str, IdealModel] | str"]
"""Models that are stated already, by the parameters of the flights: scenarios fly the same aircraft."""


def _unstated(campaign: Campaign) -> str:
    """Why there is no bound, before anything is flown for one; "" where there is."""
    if not hasattr(campaign.bench, "ideal"):
        return _UNSTATED
    usual = _models(campaign, {each.name: np.array([each.default]) for each in campaign.plant.parameters})
    return usual if isinstance(usual, str) else ""


def _lines(campaign: Campaign, signature: Signature, p_fa: float, known: Known) -> Iterator[dict[str, Any]]:
    """Lines of a scenario, model by model."""
    where = {"scenario": signature.scenario, "window_s": signature.window_s}
    key = tuple(values.tobytes() for values in signature.batch.parameters.values())
    if key not in known:
        known[key] = _models(campaign, signature.batch.parameters)
    models = known[key]
    if isinstance(models, str):
        yield where | {"about": models}
        return
    for name, model in models.items():
        blind = [site for site in signature.faults.added if site not in (*model.outputs, *model.states)]
        if blind:
            yield where | {"about": f"no model says where a fault of {', '.join(blind)} enters"}
            return
        yield where | {"model": name, "about": model.about} | bound_line(*detectability(model, signature.faults), p_fa)


def _models(campaign: Campaign, parameters: Mapping[str, Floats]) -> Mapping[str, IdealModel] | str:
    """What the benchmark states for flights with these parameters."""
    try:
        with np.errstate(all="ignore"):
            found: Mapping[str, IdealModel] | str = campaign.bench.ideal(  # type: ignore[attr-defined]
                campaign.chosen, parameters, campaign.sample_s
            )
    except (Exception, SystemExit) as error:  # a benchmark may be somebody else's
        raise FddbenchError(
            f"benchmark {campaign.benchmark!r} cannot state its ideal model: {reason_of(error)}{place_of(error)}"
        ) from error
    return found
