"""The smallest thresholds that keep a false-alarm rate on healthy flights."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor
from typing import Any

import numpy as np

from fddbench.campaign.meaning import Campaign
from fddbench.designs.design import Design
from fddbench.designs.design_file import design_text
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["Tuned", "held_peaks", "require_tuning", "tuned", "tuned_text"]


@dataclass(frozen=True)
class Tuned:
    """Thresholds, and how many of the flights they were chosen on alarm with them."""

    thresholds: tuple[float, ...]
    alarms: int
    flights: int


def held_peaks(signal: Floats, confirm_samples: int) -> Floats:
    """Largest threshold, (n_cases,), at which |signal|, (n_time, n_cases), would still alarm.

    That is the maximum over time of the minimum over ``confirm_samples + 1`` samples: a level that is exceeded for the
    whole confirmation time. Zero for a signal too short to alarm.
    """
    if len(signal) <= confirm_samples:
        return np.zeros(signal.shape[1])
    held = np.lib.stride_tricks.sliding_window_view(np.abs(signal), confirm_samples + 1, axis=0).min(axis=-1)
    peaks: Floats = np.fmax.reduce(held, axis=0)  # a flight that has ended shows no number
    return peaks


def tuned(peaks: Floats, false_alarm_rate: float) -> Tuned:
    """Thresholds with which at most the share `false_alarm_rate` of the flights alarms in any residual.

    Every residual gets the same number of flights beyond its threshold, so that no residual pays for another; of these
    numbers the largest is taken that keeps the rate. Each threshold is the peak of a flight, which itself does not alarm.

    Parameters
    ----------
    peaks : (n_flights, n_residuals) array
        As `held_peaks` gives them.
    false_alarm_rate : float
        Share of flights, 0 to below 1 [-].

    Examples
    --------
    >>> tuned(np.array([[1.0], [4.0], [3.0], [2.0]]), 0.25)
    Tuned(thresholds=(3.0,), alarms=1, flights=4)
    """
    n = len(peaks)
    allowed = floor(false_alarm_rate * n + 1e-9)
    descending = -np.sort(-peaks, axis=0)
    best = Tuned(tuple(descending[0].tolist()), 0, n)
    for beyond in range(1, min(allowed, n - 1) + 1):
        thresholds = descending[beyond]
        alarms = int(np.sum(np.any(peaks > thresholds, axis=1)))
        if alarms > allowed:
            break
        best = Tuned(tuple(thresholds.tolist()), alarms, n)
    if min(best.thresholds) <= 0.0:
        raise DesignError("a residual stays at zero in every flight: there is nothing to choose a threshold from")
    return best


def require_tuning(campaign: Campaign) -> None:
    """Refuse a campaign whose flights are there to be scored."""
    if campaign.purpose != "tuning":
        raise DesignError(
            f"{campaign.path} has purpose: {campaign.purpose}; thresholds chosen on flights that are scored later "
            "flatter the score. Write a campaign with purpose: tuning (its flights are never those of an evaluation)."
        )
    if all(scenario.faults for scenario in campaign.scenarios):
        raise DesignError(f"{campaign.path} has no healthy scenario; thresholds are tuned on healthy flights")


def tuned_text(design: Design, data: dict[str, Any], thresholds: Sequence[float], campaign: Campaign) -> str:
    """File of a design with new thresholds, listing the campaign among those it was tuned on.

    Parameters
    ----------
    data : dict
        What the file of the design says.
    """
    seen = [entry.model_dump() for entry in design.tuned_on]
    new = {"campaign": campaign.name, "seed": campaign.seed}
    gains = {**data["gains"], "thresholds": list(thresholds)}
    return design_text({**data, "tuned_on": [*(entry for entry in seen if entry != new), new], "gains": gains})
