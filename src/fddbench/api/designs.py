"""Designs: thresholds from the healthy flights of a tuning campaign."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fddbench.campaign.load import find_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.design.tuning import Tuned, held_peaks, require_tuning, tuned, tuned_text
from fddbench.designs.design import read_design
from fddbench.designs.finding import find_design
from fddbench.errors import DesignError
from fddbench.interfaces import Tunable
from fddbench.runner.assembling import assemble
from fddbench.runner.observe import healthy_signals

__all__ = ["TunedDesign", "tune"]


@dataclass(frozen=True)
class TunedDesign:
    """A design with new thresholds: its name, the text of its file, and what the thresholds do on the tuning flights."""

    name: str
    text: str
    found: Tuned


def tune(design: str | Path, campaign: Campaign, *, false_alarm_rate: float = 0.01) -> TunedDesign:
    """The smallest thresholds of a design that keep a false-alarm rate on the healthy flights of a tuning campaign.

    Parameters
    ----------
    design : str or Path
        File or name of the design.
    campaign : Campaign
        With ``purpose: tuning``.
    false_alarm_rate : float
        Share of flights that may alarm, 0 to below 1 [-].

    Raises
    ------
    FddbenchError
        The campaign is no tuning campaign, or the kind of the design evaluates no signals.
    """
    require_tuning(campaign)
    path = Path(design)
    if not path.is_file():
        path = find_design(str(design), find_campaign(campaign.path).parent)
    chosen = read_design(path)
    assembly = assemble(replace(campaign, designs=(chosen,)))
    detector = assembly.detectors[chosen.name].detector
    if not isinstance(detector, Tunable):
        raise DesignError(
            f"the thresholds of {chosen.kind.name} designs cannot be tuned: the kind evaluates no signals"
        )
    peaks = [
        np.stack([held_peaks(signals[name], round(detector.confirm_samples)) for name in detector.evaluated], axis=1)
        for signals in healthy_signals(assembly, chosen.name, detector.evaluated)
    ]
    if not peaks:
        raise DesignError(f"none of the healthy flights of {campaign.path} can be flown")
    found = tuned(np.concatenate(peaks), false_alarm_rate)
    text = tuned_text(chosen, read_yaml(path).data, found.thresholds, campaign)
    return TunedDesign(chosen.name, text, found)
