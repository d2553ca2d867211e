"""Numbers as readers see them; an absent one is a dash."""

from collections.abc import Sequence
from typing import Any

import pandas as pd

__all__ = ["DASH", "count", "interval", "percent", "present", "rate", "seconds", "short", "shorts", "signed"]

DASH = "–"


def present(value: Any) -> bool:
    """Whether there is a value: not None, not ``pd.NA``, not NaN."""
    return not bool(pd.isna(value))


def count(value: Any) -> str:
    """Whole number, thousands set apart: ``1 000``."""
    return f"{int(value):,}".replace(",", "\u202f") if present(value) else DASH


def percent(value: Any) -> str:
    """Share with one decimal; never rounded up to 100 or down to 0 when it is neither.

    >>> percent(99.98), percent(100.0), percent(0.01)
    ('>99.9', '100', '<0.1')
    """
    if not present(value):
        return DASH
    if 99.95 <= value < 100.0:
        return ">99.9"
    if 0.0 < value < 0.05:
        return "<0.1"
    return f"{value:.1f}" if 0.0 < value < 100.0 else f"{value:.0f}"


def rate(value: Any) -> str:
    """Rate per hour with three digits: ``0``, ``0.0221``, ``12.3``."""
    if not present(value):
        return DASH
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def seconds(value: Any) -> str:
    """Time [s] to the sample: ``0.11``, ``4.10``."""
    return f"{value:.2f}" if present(value) else DASH


def interval(low: Any, high: Any, form: Any = percent) -> str:
    """Text of both ends, ``96.4 … 100``; empty without them."""
    return f"{form(low)} … {form(high)}" if present(low) and present(high) else ""


def short(value: float) -> str:
    """Value of a parameter as a reader needs it: whole from 1000 on, else three digits.

    >>> short(129062.98), short(0.24481)
    ('129063', '0.245')
    """
    return f"{value:.0f}" if abs(value) >= 1000.0 else f"{value:.3g}"


def shorts(values: Sequence[float]) -> list[str]:
    """Values as `short` writes them, with more digits where different ones would look alike.

    >>> shorts([0.5, 2.0]), shorts([200000.1, 200000.4])
    (['0.5', '2'], ['200000.1', '200000.4'])
    """
    found = [short(value) for value in values]
    for digits in range(4, 10):
        if len(set(found)) == len(set(values)):
            return found
        found = [f"{value:.{digits}g}" for value in values]
    return [short(value) for value in values]  # they differ by rounding


def signed(value: float) -> str:
    """Difference with its sign and without needless decimals: ``+1``, ``−2``, ``0``."""
    text = f"{abs(value):g}"
    return text if value == 0 else ("+" if value > 0 else "−") + text
