"""Operating curves of a campaign that sweeps gains of its detectors."""

from collections.abc import Iterator
from pathlib import Path

import pandas as pd

from fddbench.campaign.meaning import Campaign
from fddbench.designs.design import Design
from fddbench.designs.sweeps import gain_of
from fddbench.errors import FddbenchError
from fddbench.metrics import operating
from fddbench.metrics.operating import OperatingPoint
from fddbench.results import table
from fddbench.runner.fingerprint import frozen

__all__ = ["operating_curve", "operating_of"]


def operating_curve(folder: str | Path, *, design: str | None = None, gain: str | None = None) -> pd.DataFrame:
    """False alarms per hour against missed share and detection time, for every value of the swept gains and each scenario.

    The design itself is a point of each of its curves where the campaign lists it too. The columns are those of
    `fddbench.metrics.operating.OPERATING`.

    Parameters
    ----------
    folder : str or Path
        Folder of results of a campaign with ``detectors: [{design: NAME, sweep: {GAIN: [...]}}]``.
    design, gain : str, optional
        Only the curves of this design, of this gain.

    Raises
    ------
    FddbenchError
        Nothing is swept there, or no such curve.
    """
    campaign = frozen(Path(folder))
    curves = {
        each: None for each in _curves(campaign) if each[0] == (design or each[0]) and each[1] == (gain or each[1])
    }
    if not curves:
        known = [f"{base} {key}" for base, key, _ in dict.fromkeys(_curves(campaign))]
        raise FddbenchError(
            f"{folder} has no {'such ' if known else ''}operating curve. "
            + (
                f"It has those of {', '.join(known)}"
                if known
                else "A campaign sweeps a gain as detectors: [{design: NAME, sweep: {GAIN: [1, 2]}}]"
            )
        )
    points = [point for curve in curves for point in sorted(_points(campaign, *curve), key=_place)]
    return operating.operating_curve(table.load(folder, ["case", *operating.NEEDS], fair=True), points)


def operating_of(rows: pd.DataFrame, campaign: Campaign) -> pd.DataFrame | None:
    """Curves of every gain that a campaign sweeps, from its rows; None where it sweeps none."""
    points = [
        point for curve in dict.fromkeys(_curves(campaign)) for point in sorted(_points(campaign, *curve), key=_place)
    ]
    return operating.operating_curve(rows, points) if points else None


def _curves(campaign: Campaign) -> Iterator[tuple[str, str, bool]]:
    """Design, gain, and whether values are factors, of every swept detector."""
    for each in campaign.designs:
        if each.swept:
            yield each.base, each.swept.key, each.swept.factor


def _points(campaign: Campaign, base: str, key: str, factor: bool) -> Iterator[OperatingPoint]:
    """Points of a curve, that of the design itself among them."""
    for each in campaign.designs:
        swept = each.swept
        if each.base != base or (swept and (swept.key, swept.factor) != (key, factor)):
            continue
        yield OperatingPoint(
            design=base, gain=key, factor=factor, value=swept.value if swept else _as_designed(each, key, factor),
            as_designed=swept is None, detector=each.name,
        )  # fmt: skip


def _as_designed(design: Design, key: str, factor: bool) -> float | None:
    """Where the design itself stands on a curve; None for a list of numbers."""
    value = gain_of(design, key)
    return 1.0 if factor else float(value) if isinstance(value, int | float) else None


def _place(point: OperatingPoint) -> tuple[bool, float]:
    return point.value is None, point.value or 0.0
