"""The sentence at the top of every report: what was flown."""

import numpy as np
import pandas as pd

from fddbench.reporting.formats import count, rate

__all__ = ["flown_sentence"]


def flown_sentence(rows: pd.DataFrame) -> str:
    """How many flights, hours, detectors and failures."""
    if rows.empty:
        return "No flight: the table of results is empty."
    # plain truth values first: pandas 2 casts what a function makes of text back to text
    fates = {fate: np.asarray(rows["status"] == fate, dtype=bool) for fate in ("ok", "infeasible")}
    flights = (
        rows[["case", "flight_s"]]
        .assign(**fates)
        .groupby("case", sort=False)
        .agg(ok=("ok", "all"), infeasible=("infeasible", "any"), flight_s=("flight_s", "max"))
    )
    hours = float(flights["flight_s"].sum()) / 3600.0
    flown, infeasible = int(flights["ok"].sum()), int(flights["infeasible"].sum())
    number = {"flight": len(flights), "scenario": rows["scenario"].nunique(), "detector": rows["detector"].nunique()}
    many = {name: f"{count(n)} {name}{'' if n == 1 else 's'}" for name, n in number.items()}
    return (
        f"{many['flight']} in {many['scenario']}, {rate(hours)} flight hours scored by {many['detector']}: "
        f"{count(flown)} flown, {count(infeasible)} infeasible, "
        f"{count(len(flights) - flown - infeasible)} failed in at least one detector."
    )
