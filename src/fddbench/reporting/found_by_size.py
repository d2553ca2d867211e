"""How the share found rises with the size of a fault: the fitted curve where flights give one, and what it says in words."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.interfaces import Floats
from fddbench.metrics.detection_curve import LEAST, DetectionCurve, detection_curve
from fddbench.reporting.labels import of_a_fault
from fddbench.units import unit_of_name

__all__ = ["curve_of", "in_words", "no_curve", "sizes_among"]

_RATES = ("deg_s", "percent_s", "rad_s", "m_s", "n_s", "g_s")

_FAR = 2.0
"""Times the largest size flown, beyond which a fitted curve is a guess and no number is told."""


def sizes_among(columns: Iterable[str]) -> list[str]:
    """Columns of the numbers of faults; times are no sizes.

    >>> sizes_among(["run", "f1_amplitude_deg", "f1_onset_s", "f2_rate_deg_s"])
    ['f1_amplitude_deg', 'f2_rate_deg_s']
    """
    numbers = [name for name in columns if of_a_fault(name)]
    return [name for name in numbers if not name.endswith("_s") or name.endswith(_RATES)]


def no_curve(size: Floats, right: npt.NDArray[np.bool_]) -> str:
    """Why flights give no curve; "" where they do."""
    if len(size) < LEAST or len(np.unique(size)) < 3 or size.min() <= 0.0:
        return f"no curve: it needs {LEAST} or more decided flights of three or more sizes above 0"
    if right.all():
        return "no curve: all are found, down to the smallest"
    return "" if right.any() else "no curve: none is found"


def curve_of(size: Floats, right: npt.NDArray[np.bool_], run: Any, name: str) -> tuple[DetectionCurve | None, str]:
    """Curve of decided flights, None where they give none, and what is said of it.

    Parameters
    ----------
    size : (n,) array
        Size of the fault in each, without its sign.
    right : (n,) array of bool
        Whether it was found in time.
    run : (n,) array
        Run of each.
    name : str
        Column of the size: its unit is part of what is said.
    """
    why = no_curve(size, right)
    if why:
        return None, why
    curve = detection_curve(size, right, run)
    return curve, in_words(curve, float(size.max()), unit_of_name(name))


def in_words(curve: DetectionCurve, largest: float, unit: str = "") -> str:
    """``90 % found at 0.71 %, at most 0.83 % at 95 % confidence``; largest: of the sizes flown."""
    if curve.size_90 is None:
        return f"90 % are never found: the curve ends at {100.0 * curve.ceiling:.0f} %"
    of = f" {unit}" if unit not in {"", "-"} else ""
    if curve.size_90 > _FAR * largest:
        return f"these flights do not show where 90 % are found: not up to {_FAR:g} times the largest flown, {largest:.3g}{of}"
    beyond = ", beyond the largest flown" if curve.size_90 > largest else ""
    if curve.size_90_95 is None or curve.size_90_95 > _FAR * largest:
        return f"90 % found at {curve.size_90:.3g}{of}{beyond}; these flights give it no upper end at 95 % confidence"
    return f"90 % found at {curve.size_90:.3g}{of}{beyond}, at most {curve.size_90_95:.3g}{of} at 95 % confidence"
