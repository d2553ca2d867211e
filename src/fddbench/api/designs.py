"""Designs: the smallest thresholds that keep a false-alarm target, from the healthy flights of a tuning campaign."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from fddbench.campaign.finding import find_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.design.tuning.checks import require_enough, require_tuning
from fddbench.design.tuning.factor import smallest_factor
from fddbench.design.tuning.promise import Healthy, Promise, Target, promise
from fddbench.design.tuning.residuals import held_peaks, tuned
from fddbench.designs.adapted import Adapted
from fddbench.designs.building import build_detectors
from fddbench.designs.design import Design, read_design
from fddbench.designs.design_file import design_text
from fddbench.designs.finding import find_design
from fddbench.designs.sweeps import changed_gains, gain_of, with_gains
from fddbench.designs.thresholds import at_factor, thresholds_of
from fddbench.errors import CampaignError, DesignError
from fddbench.interfaces import Bus, Tunable
from fddbench.metrics.distinct import DistinctFlights
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly
from fddbench.runner.observe import healthy_flights, healthy_signals

__all__ = ["TunedDesign", "tune"]


@dataclass(frozen=True, kw_only=True)
class TunedDesign:
    """A design with new thresholds.

    Attributes
    ----------
    name, text : str
        Of the design, and of its new file.
    thresholds : dict of str to number or list
        What was chosen, by the key of the gain.
    factor, resolution : float or None
        Factor on the thresholds of the design, and to which share it was found [-]; None where each was chosen by itself.
    target : Target
        What was asked.
    promise : Promise
        False alarms of these thresholds here, and what they promise on other flights.
    tried : int
        Sets of thresholds that have flown all flights of the promise.
    """

    name: str
    text: str
    thresholds: dict[str, Any]
    factor: float | None
    resolution: float | None
    target: Target
    promise: Promise
    tried: int


def tune(
    design: str | Path,
    campaign: Campaign,
    *,
    false_alarm_rate: float | None = None,
    per_flight: float | None = None,
    per_hour: float | None = None,
    confidence: float | None = None,
    by: str | None = None,
    only: Sequence[str] = (),
    resolution: float = 0.005,
) -> TunedDesign:
    """The smallest thresholds of a design that keep a false-alarm target, from the healthy flights of a tuning campaign.

    Parameters
    ----------
    design : str or Path
        File or name of the design.
    campaign : Campaign
        With ``purpose: tuning``.
    false_alarm_rate : float
        Largest share of these very flights that alarms [-]; 0.01 where no target is given. Others alarm more often.
    per_flight, per_hour : float
        Largest share of other flights [-], or alarms per hour of other flights [1/h]; one of the three.
    confidence : float, optional
        With which `per_flight` or `per_hour` shall hold [-]; on average by default.
    by : {"factor", "residual"}, optional
        One factor on all thresholds of the kind; or an equal number of flights beyond each residual, for kinds that name
        signals with a threshold each (``evaluated``), where it is the default.
    only : sequence of str
        Thresholds to tune; all by default.
    resolution : float
        How close the factor is found [-].

    Raises
    ------
    FddbenchError
        The campaign is no tuning campaign, the kind does not say which gains are thresholds, no thresholds keep the target,
        or the flights are too few to promise it.
    """
    target = _target(false_alarm_rate, per_flight, per_hour, confidence)
    require_tuning(campaign)
    path = Path(design)
    if not path.is_file():
        path = find_design(str(design), find_campaign(campaign.path).parent)
    chosen = read_design(path)
    assembly = assemble(replace(campaign, designs=(chosen,)))
    signals = isinstance(assembly.detectors[chosen.name].detector, Tunable)
    how = by or ("residual" if signals and not only else "factor")
    if how == "factor":
        return _by_factor(assembly, chosen, thresholds_of(chosen, only), target, resolution)
    if how == "residual" and signals:
        return _by_residual(assembly, chosen, target)
    ways = "factor or by residual" if signals else "factor: they show no signals with a threshold each"
    raise DesignError(f"{chosen.kind.name} designs are tuned by {ways}; got {how!r}")


def _target(
    false_alarm_rate: float | None, per_flight: float | None, per_hour: float | None, confidence: float | None
) -> Target:
    """The one target that is given."""
    given = [
        name
        for name, value in (("false_alarm_rate", false_alarm_rate), ("per_flight", per_flight), ("per_hour", per_hour))
        if value is not None
    ]
    if len(given) > 1:
        raise DesignError(f"{' and '.join(given)} are two targets; give one")
    if confidence is not None and (not given or false_alarm_rate is not None):
        raise DesignError("a confidence is about other flights; give it with per_flight or per_hour")
    if per_hour is not None:
        return Target(most=per_hour, per="hour", confidence=confidence)
    if per_flight is not None:
        return Target(most=per_flight, confidence=confidence)
    return Target(most=0.01 if false_alarm_rate is None else false_alarm_rate, on="these")


def _by_factor(
    assembly: Assembly, design: Design, directions: Mapping[str, str], target: Target, resolution: float
) -> TunedDesign:
    """One factor on all thresholds, by sweeps of variants that fly together."""
    campaign = assembly.plan.campaign
    require_enough(_healthy(healthy_flights(assembly)[design.name]), target, campaign)

    def promised(factors: Sequence[float]) -> dict[float, Promise]:
        variants = {f"{design.name}.tune.{n}": factor for n, factor in enumerate(factors)}
        detectors = dict(_possible(assembly.loop.bus, design, directions, variants))
        flown = healthy_flights(replace(assembly, detectors=detectors)) if detectors else {}
        return {variants[name]: promise(_healthy(flights), target) for name, flights in flown.items()}

    found = smallest_factor(promised, target, resolution=resolution)
    new = at_factor(design, directions, found.factor, design.name)
    return TunedDesign(
        name=design.name, text=_text(new, campaign), thresholds={key: gain_of(new, key) for key in directions},
        factor=found.factor, resolution=found.resolution, target=target, promise=found.promise, tried=found.tried + 1,
    )  # fmt: skip


def _healthy(flights: DistinctFlights) -> Healthy:
    return Healthy(alarm=flights.alarm, time_s=flights.time_s, run=flights.run)


def _possible(
    bus: Bus, design: Design, directions: Mapping[str, str], variants: Mapping[str, float]
) -> Iterator[tuple[str, Adapted]]:
    """Detectors of those variants that the kind takes, by their names."""
    for name, factor in variants.items():
        with suppress(ValidationError, CampaignError):
            yield from build_detectors([at_factor(design, directions, factor, name)], bus).items()


def _by_residual(assembly: Assembly, design: Design, target: Target) -> TunedDesign:
    """An equal number of flights beyond each residual."""
    campaign, detector = assembly.plan.campaign, assembly.detectors[design.name].detector
    names, fitted = detector.evaluated, len(detector.evaluated)
    parts = list(healthy_signals(assembly, design.name, names))
    if not parts:
        raise DesignError(f"none of the healthy flights of {campaign.path} can be flown")
    held, every = round(detector.confirm_samples), design.every
    # on its own clock: a decision that is held for n samples is one
    peaks = [np.stack([held_peaks(part.signals[name][::every], held) for name in names], axis=1) for part in parts]
    all_peaks = np.concatenate(peaks)
    time_s, run = np.concatenate([part.time_s for part in parts]), np.concatenate([part.run for part in parts])

    def said(alarm: Any) -> Promise:
        return promise(Healthy(alarm=alarm, time_s=time_s, run=run), target, fitted=fitted)

    require_enough(Healthy(alarm=time_s < 0.0, time_s=time_s, run=run), target, campaign, fitted=fitted)
    found = tuned(all_peaks, lambda alarm: target.kept(said(alarm)))
    written = changed_gains(design, "thresholds", lambda _: list(found.thresholds))
    return TunedDesign(
        name=design.name, text=_text(with_gains(design, written, design.name), campaign),
        thresholds={"thresholds": list(found.thresholds)}, factor=None, resolution=None, target=target,
        promise=said(np.any(all_peaks > np.array(found.thresholds), axis=1)), tried=1,
    )  # fmt: skip


def _text(design: Design, campaign: Campaign) -> str:
    """File of a design with its new gains, listing the campaign among those it was tuned on."""
    seen = [entry.model_dump() for entry in design.tuned_on]
    new = {"campaign": campaign.name, "seed": campaign.seed}
    tuned_on = [*(entry for entry in seen if entry != new), new]
    return design_text({**read_yaml(design.path).data, "tuned_on": tuned_on, "gains": dict(design.written)})
