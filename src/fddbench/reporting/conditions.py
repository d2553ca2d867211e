"""Whether a scenario was flown under the conditions of a printed row, and in words what differs."""

from collections.abc import Mapping
from typing import Any

from fddbench.reporting.formats import present
from fddbench.reporting.published import PublishedRow

__all__ = ["differences"]

_SIZES = {"amplitude_percent": "%", "rate_percent_s": "%/s", "variance_percent": "%"}


def differences(campaign: Mapping[str, Any], line: Mapping[Any, Any], row: PublishedRow) -> list[str]:
    """What of a scenario differs from a printed row: wind, sites, onset, sizes, limit; empty where all known is the same.

    Parameters
    ----------
    campaign : mapping
        Effective content of the campaign.
    line : mapping
        Line of its summary.
    row : PublishedRow
        What is in print, flown without wind.
    """
    found = []
    if campaign.get("wind") not in (None, "", "none"):
        found.append(f"wind {campaign['wind']}, in print none")
    entries = [each for each in campaign.get("scenarios", ()) if each.get("name") == line["scenario"]]
    faults = list(entries[0].get("faults") or ()) if entries else []
    if faults:
        found += _of_faults(faults, row)
    limit, printed = line["detection_time_limit_s"], row.detection_time_limit_s
    if present(limit) and printed is not None and abs(float(limit) - printed) > 1e-9:
        found.append(f"limit {limit:g} s, in print {printed:g} s")
    return found


def _of_faults(faults: list[Mapping[str, Any]], row: PublishedRow) -> list[str]:
    found = []
    sites = {site for fault in faults for site in fault.get("sites", ())}
    if len(sites) != row.n_faulty:
        found.append(f"{len(sites)} faulty sites, in print {row.n_faulty}")
    first = faults[0]
    found += _differs("onset", first.get("onset_s"), row.onset_s, " s")
    for key, unit in _SIZES.items():
        found += _differs(key.split("_", 1)[0], first.get(key), getattr(row, key), f" {unit}")
    return found


def _differs(name: str, ours: Any, printed: float | None, unit: str) -> list[str]:
    if ours is None or printed is None:
        return []
    if not isinstance(ours, int | float):
        return [f"{name} drawn or swept, in print {printed:g}{unit}"]
    return [] if abs(ours - printed) < 1e-9 else [f"{name} {ours:g}{unit}, in print {printed:g}{unit}"]
