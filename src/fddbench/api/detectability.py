"""The maps of detectability that a campaign's benchmark asks for."""

import numpy as np
import pandas as pd

from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError, place_of, reason_of
from fddbench.metrics.detectable import summarize_detectable

__all__ = ["detectable_of"]


def detectable_of(rows: pd.DataFrame, campaign: Campaign) -> pd.DataFrame:
    """Lines of `fddbench.metrics.detectable.DETECTABLE` from all rows of a campaign; none where its benchmark asks for none.

    Raises
    ------
    FddbenchError
        The benchmark cannot say what follows from the parameters of its flights, or a map needs what it does not give.
    """
    maps = getattr(campaign.bench, "detectability", ())
    return summarize_detectable(_with_derived(rows, campaign) if maps else rows, maps)


def _with_derived(rows: pd.DataFrame, campaign: Campaign) -> pd.DataFrame:
    """Rows with what the benchmark derives from the parameters of each flight, as more columns ``p_<name>``."""
    derived = getattr(campaign.bench, "derived", None)
    if derived is None:
        return rows
    flights = rows.drop_duplicates("case").set_index("case")
    parameters = {p.name: flights[f"p_{p.name}"].to_numpy(dtype=float) for p in campaign.plant.parameters}
    try:
        with np.errstate(all="ignore"):
            found = derived(campaign.chosen, parameters)
        more = {f"p_{name}": np.broadcast_to(np.asarray(values, float), len(flights)) for name, values in found.items()}
    except (Exception, SystemExit) as error:  # a benchmark may be somebody else's
        raise FddbenchError(
            f"benchmark {campaign.benchmark!r} cannot derive numbers from the parameters of its flights: "
            f"{reason_of(error)}{place_of(error)}"
        ) from error
    return rows.join(pd.DataFrame(more, index=flights.index), on="case")
