"""Signals of the scenarios that go worst: density of a sample of flights, the worst five, one flight for all detectors."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from fddbench.interfaces import Floats, Recording
from fddbench.reporting.declarations import declarations
from fddbench.reporting.labels import label
from fddbench.reporting.names import TITLE, shortened
from fddbench.reporting.page.promises import Promise
from fddbench.reporting.signals import rank_of_cases, redundant, signal_panels, window
from fddbench.reporting.svg.palette import SERIES, band
from fddbench.reporting.svg.scene import Scene
from fddbench.reporting.svg.traces import Panel, panel_scene

__all__ = ["MOST_SCENARIOS", "signal_sections"]

MOST_SCENARIOS = 5
"""Scenarios whose signals a page shows; the rest by ``fddbench replay --plot``."""

_MOST_PANELS, _MOST_DETECTORS, _WORST = 48, 10, 5
_SENSORS = ("one", "s4", "s7", "s6")
Line = tuple[str, Floats]


def signal_sections(
    recordings: Sequence[Recording],
    rows: pd.DataFrame,
    order: Sequence[str],
    promises: Mapping[str, Promise] | None = None,
) -> list[dict[str, Any]]:
    """One section a recorded scenario: what its caption says, and pictures.

    Parameters
    ----------
    recordings : sequence of Recording
        Flown again.
    rows : DataFrame
        Rows of the campaign.
    order : sequence of str
        Detectors, best first; of more than ten the first are shown.
    promises : mapping of str to Promise
        By detector what its design promises of its residuals.
    """
    shown = [name for name in order if any(name in each.detectors for each in recordings)][:_MOST_DETECTORS]
    each = max(_MOST_PANELS // max(len(shown) * len(recordings), 1), 1)
    return [_section(one, rows, shown, each, promises or {}) for one in recordings if one.cases]


def _section(
    recording: Recording, rows: pd.DataFrame, order: Sequence[str], most: int, promises: Mapping[str, Promise]
) -> dict[str, Any]:
    ranked = rank_of_cases(recording, rows)
    kept = slice(*window(recording))
    here = rows[np.asarray(rows["scenario"] == recording.scenario, dtype=bool)]
    said = declarations(recording, int(ranked[0])) if recording.declared else []
    numbers = {name: i for i, name in enumerate(recording.detectors)}
    scenes = _sensor_panel(recording, int(ranked[0]), kept)
    notes = []
    for name in (own for own in order if own in recording.detectors):
        promised = promises[name].lines(recording, int(ranked[0])) if name in promises else {}
        scenes += _panels(recording, name, numbers[name], ranked, kept, most, promised)
        changes = [
            f"{sites or ('alarm' if alarm else 'nothing')} at {t:g} s" for n, t, sites, alarm in said if n == name
        ]
        reasons = recording.errors.get(name)
        if reasons and reasons[int(ranked[0])]:
            changes = [*changes[:2], f"did not come to its end, {reasons[int(ranked[0])]}"]
        notes.append((name, ", ".join(changes[:3]) + (" …" if len(changes) > 3 else "") if changes else "nothing"))
        if promised:
            notes[-1] = (name, f"{notes[-1][1]}; {_distance(recording, name, int(ranked[0]), kept, promised)}")
    return {
        "scenario": recording.scenario, "case": recording.cases[int(ranked[0])], "shown": len(recording.cases),
        "cases": here["case"].nunique(), "onset_s": _onsets(recording), "scenes": scenes, "declared": notes,
        "worst": [recording.cases[i] for i in ranked[:_WORST]],
    }  # fmt: skip


def _onsets(recording: Recording) -> str | None:
    """When the faults begin, in words; None in healthy flights."""
    if recording.onset_s is None:
        return None
    first, last = float(np.nanmin(recording.onset_s)), float(np.nanmax(recording.onset_s))
    return f"{first:g} s" if first == last else f"{first:g} to {last:g} s"


def _sensor_panel(recording: Recording, case: int, kept: slice) -> list[Scene]:
    names = redundant(recording.signals)
    if not names:
        return []
    lines = [(_SENSORS[i], recording.signals[name][kept, case]) for i, name in enumerate(names)]
    # the healthy ones come last: they lie on each other
    panel = Panel(
        title=f"{names[0]} to {names[-1].rpartition('_')[2]}", y_name=label("p_" + names[0].rpartition("_")[0]),
        time_s=recording.time_s[kept], lines=lines, onset_s=_onset(recording, case),
    )  # fmt: skip
    return [panel_scene(panel)]


def _onset(recording: Recording, case: int) -> float | None:
    """Of one flight; None for a healthy one."""
    onset_s = np.nan if recording.onset_s is None else float(recording.onset_s[case])
    return None if np.isnan(onset_s) else onset_s


def _panels(
    recording: Recording,
    detector: str,
    number: int,
    ranked: npt.NDArray[np.int64],
    kept: slice,
    most: int,
    promised: Mapping[str, Floats],
) -> list[Scene]:
    signals, title = recording.detectors[detector], shortened(recording.detectors, TITLE)[detector]
    found = []
    for names in _telling(signals, int(ranked[0]), kept)[:most]:
        values = signals[names[0]][kept]
        lines: list[Line] = [("few", values[:, i]) for i in ranked[1:_WORST]]
        lines.append(("one", values[:, ranked[0]]))
        lines += _thresholds(signals, names, kept, int(ranked[0]), negative=bool(np.nanmin(values) < 0.0))
        lines += [("prm", promised[names[0]][kept])] if names[0] in promised else []
        found.append(
            panel_scene(
                Panel(
                    title=title, y_name=label("p_" + names[0]), time_s=recording.time_s[kept], bands=_density(values),
                    lines=lines, onset_s=_onset(recording, int(ranked[0])), look=band(number % SERIES),
                ),
                points=100,
            )
        )  # fmt: skip
    return found


def _telling(signals: Mapping[str, Floats], case: int, kept: slice) -> list[list[str]]:
    """Panels of a detector that have numbers, those first that come nearest to their threshold in this flight."""
    panels = [names for names in signal_panels(signals)[:-1] if np.isfinite(signals[names[0]][kept]).any()]

    def nearness(names: list[str]) -> float:
        limit = signals[names[1]][kept, case] if len(names) > 1 else np.ones(1)
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(np.nanmax(np.abs(signals[names[0]][kept, case]) / limit, initial=0.0))

    return sorted(panels, key=lambda names: -nearness(names))


def _distance(recording: Recording, detector: str, case: int, kept: slice, promised: Mapping[str, Floats]) -> str:
    """Rms distance of residuals from what is promised of them, in this flight as shown."""
    signals = recording.detectors[detector]
    away = [
        float(np.sqrt(np.nanmean((signals[name][kept, case] - values[kept]) ** 2)))
        for name, values in promised.items()
        if name in signals
    ]
    return f"rms from its promise {', '.join(f'{each:.3g}' for each in away)}"


def _thresholds(
    signals: Mapping[str, Floats], names: Sequence[str], kept: slice, case: int, *, negative: bool
) -> list[Line]:
    if list(names) == ["residual"]:
        return [("thr", np.ones(len(signals["residual"][kept])))]
    lines: list[Line] = []
    for name in names[1:]:
        value = signals[name][kept, case]
        lines += [("thr", value), ("thr", -value)] if negative else [("thr", value)]
    return lines


def _density(values: Floats) -> list[tuple[Floats, Floats]]:
    """5 to 95 % and the middle half of the flights at every time; nothing of fewer than five."""
    if values.shape[1] < 5:
        return []
    ordered = np.sort(values, axis=1)  # NaN last
    there = np.maximum(np.sum(~np.isnan(ordered), axis=1), 1)
    ends = [
        np.take_along_axis(ordered, np.clip(np.ceil(q * there) - 1, 0, None).astype(np.int64)[:, np.newaxis], axis=1)[
            :, 0
        ]
        for q in (0.05, 0.25, 0.75, 0.95)
    ]
    return [(ends[0], ends[3]), (ends[1], ends[2])]
