"""Which gains of a design are thresholds, and the design with all of them larger or smaller by one factor."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from fddbench.designs.design import Design
from fddbench.designs.sweeps import changed_gains, gain_of, with_gains
from fddbench.errors import DesignError, FddbenchError, did_you_mean

__all__ = ["at_factor", "thresholds_of"]

_DIRECTIONS = ("up", "down")


def thresholds_of(design: Design, only: Sequence[str] = ()) -> dict[str, str]:
    """Direction in which each threshold of a design quiets it, "up" or "down", by the key of the gain.

    Its kind says so, ``Gains.THRESHOLDS = {"threshold_deg_s": "up"}``: numbers, or lists of them. One that is null is none.

    Parameters
    ----------
    only : sequence of str
        Some of them; all by default.

    Raises
    ------
    DesignError
        The kind does not say it, or says it wrongly, or has no such threshold; or the design flies somebody's C.
    """
    if design.code:
        raise DesignError(
            f"{design.name} flies the C of {design.code}, whose thresholds are in the C; tune a design without code"
        )
    said: Any = getattr(design.kind.member.Gains, "THRESHOLDS", None)
    example = 'THRESHOLDS: ClassVar = {"limit": "up"} in its Gains: gain -> direction that quiets it, up or down'
    if not said:
        raise DesignError(
            f"the thresholds of {design.kind.name} designs cannot be tuned: the kind does not say which gains are thresholds. "
            f"Write {example}"
        )
    if not isinstance(said, Mapping) or not all(direction in _DIRECTIONS for direction in said.values()):
        raise DesignError(f"THRESHOLDS of {design.kind.name} is {said!r}, needs {example}")
    unknown = [key for key in only if key not in said]
    if unknown:
        hint = " ".join(filter(None, [did_you_mean(unknown[0], said), f"Its thresholds: {', '.join(said)}"]))
        raise DesignError(f"{design.kind.name} has no threshold {unknown[0]!r}. {hint}")
    return {key: way for key, way in said.items() if (not only or key in only) and _held(design, key) is not None}


def at_factor(design: Design, directions: Mapping[str, str], factor: float, name: str) -> Design:
    """Design of another name that is quieter by a factor: thresholds times it, or divided by it; to six digits.

    Raises
    ------
    pydantic.ValidationError
        The kind refuses such thresholds.
    """
    changed = design
    for key, direction in directions.items():
        each = factor if direction == "up" else 1.0 / factor
        changed = with_gains(changed, changed_gains(changed, key, _times(each)), name)
    return changed


def _times(factor: float) -> Callable[[Any], Any]:
    def scaled(value: Any) -> Any:
        if isinstance(value, list):
            return [scaled(each) for each in value]
        return value if factor == 1.0 else float(f"{factor * value:.6g}")

    return scaled


def _held(design: Design, key: str) -> Any:
    """What a design has as this gain."""
    try:
        return gain_of(design, key)
    except FddbenchError as error:
        raise DesignError(f"THRESHOLDS of {design.kind.name} names {key!r}: {error}") from error
