"""Pictures of re-flown cases: sensors, residual against threshold, and the verdict, over time."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from fddbench.interfaces import Floats, Recording
from fddbench.reporting.figures import label
from fddbench.reporting.pictures import INK, MUTED, colour, thinned, to_png

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["recording_picture", "signal_panels", "window", "worst_case"]

_MOST_PANELS = 3


def recording_picture(recording: Recording, rows: pd.DataFrame) -> str | None:
    """Picture of one scenario: a line of panels per detector, thin lines for all cases, the worst one highlighted."""
    detectors = list(recording.detectors)
    panels = {name: signal_panels(recording.detectors[name]) for name in detectors}
    sensors = _sensors(recording.signals)
    widest = max((len(of) for of in panels.values()), default=0)
    first, last = window(recording)
    kept = slice(first, last)

    def draw(figure: "Figure") -> None:
        grid = figure.add_gridspec(max(len(detectors), 1), widest + bool(sensors))
        worst = [worst_case(recording, rows, name) for name in detectors]
        if sensors:
            _draw_sensors(figure.add_subplot(grid[:, 0]), recording, sensors, worst[0] if worst else 0, kept)
        for i, name in enumerate(detectors):
            for j, signals in enumerate(panels[name]):
                axes = figure.add_subplot(grid[i, -1 if signals == ["n_declared"] else j + bool(sensors)])
                _draw_panel(axes, recording, name, signals, worst[i], kept)
                axes.set_title(name if j == 0 else "", color=colour(i))

    return to_png(draw, width_in=11.4, height_in=max(1.8 * len(detectors), 2.4))


def worst_case(recording: Recording, rows: pd.DataFrame, detector: str) -> int:
    """Position in the recording of the case that went worst: a healthy site declared, not found, slowest; else the margin."""
    chosen = rows[np.asarray((rows["scenario"] == recording.scenario) & (rows["detector"] == detector), dtype=bool)]
    order = chosen[np.asarray(chosen["status"] == "ok", dtype=bool)].set_index("case").reindex(list(recording.cases))
    faulty = recording.onset_s is not None
    score = order["detection_time_s" if faulty else "margin_healthy"].to_numpy(dtype=np.float64, na_value=np.nan)
    flown = np.asarray(order["status"].notna(), dtype=bool)
    badness = np.where(flown, np.nan_to_num(score, nan=1e9 if faulty else 0.0), -np.inf)
    wrong = np.asarray(order["wrong_site_time_s"].notna(), dtype=bool)
    badness = np.where(wrong, np.inf, badness)
    return int(np.argmax(badness)) if len(badness) else 0


def window(recording: Recording) -> tuple[int, int]:
    """First and last sample shown: from 1 s before the onset to shortly after the last declaration; healthy: all."""
    time_s, n_time = recording.time_s, len(recording.time_s)
    if recording.onset_s is None:
        return 0, n_time
    onset = float(np.min(recording.onset_s))
    changes = [_changes(of["n_declared"]) for of in recording.detectors.values()]
    last = max(
        (float(time_s[change[-1] + 1]) for change in changes if len(change)),
        default=float(np.max(recording.onset_s)) + 3.0,
    )
    last = max(last, onset) + max(0.4, 0.2 * (last - onset))
    return int(np.searchsorted(time_s, onset - 1.0)), int(np.searchsorted(time_s, last, side="right"))


def _changes(n_declared: Floats) -> Any:
    """Return the samples before which some flight changed its verdict; a flight's end (NaN) is no change."""
    steps = np.diff(n_declared, axis=0)
    return np.flatnonzero(np.any(np.abs(np.nan_to_num(steps)) > 0, axis=1))


def signal_panels(signals: Mapping[str, Floats]) -> list[list[str]]:
    """Return the signals of each panel: a threshold lies with the signal recorded before it, the verdict comes last."""
    panels: list[list[str]] = []
    for name in signals:
        if "threshold" in name and panels:
            panels[-1].append(name)
        elif "threshold" not in name and name not in ("n_declared", "alarm", "residual"):
            panels.append([name])
    if not any(len(panel) > 1 for panel in panels):
        panels.insert(0, ["residual"])
    return [*panels[:_MOST_PANELS], ["n_declared"]]


def _sensors(signals: Mapping[str, Floats]) -> list[str]:
    """Names of the first group of two to four numbered signals: the redundant sensors."""
    groups: dict[str, list[str]] = {}
    for name in signals:
        stem, _, number = name.rpartition("_")
        if stem and number.isdigit():
            groups.setdefault(stem, []).append(name)
    return next((names for names in groups.values() if 2 <= len(names) <= 4), [])


def _draw_sensors(axes: "Axes", recording: Recording, names: list[str], case: int, kept: slice) -> None:
    for i, name in enumerate(names):
        time_s, value = thinned(recording.time_s[kept], recording.signals[name][kept, case : case + 1])
        style: Any = ("-", (0, (4, 1.5)), (0, (1, 1)), "-.")[i]
        axes.plot(time_s, value, color=(INK, "#c58b00", "#7b5ea7", MUTED)[i], ls=style, lw=1.2, label=str(i + 1))
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.18 * (high - low))
    axes.legend(loc="upper left", ncols=len(names), handlelength=1.6, columnspacing=1.0, borderaxespad=0.1)
    number = recording.cases[case] if recording.cases else "none"
    axes.set(title=f"signals, case {number}", ylabel=label(names[0].rpartition("_")[0]), xlabel="time [s]")
    _mark_onset(axes, recording, case, kept)


def _draw_panel(axes: "Axes", recording: Recording, detector: str, names: list[str], case: int, kept: slice) -> None:
    signals = recording.detectors[detector]
    tone = colour(list(recording.detectors).index(detector))
    for name in names:
        time_s, values = thinned(recording.time_s[kept], signals[name][kept])
        threshold = "threshold" in name
        style: dict[str, Any] = {"ls": (0, (4, 2)), "color": INK} if threshold else {"color": tone}
        axes.plot(time_s, values, lw=0.6, alpha=0.18, **style)
        axes.plot(time_s, values[:, case : case + 1], lw=1.5, **style)
        if threshold and np.nanmin(signals[names[0]][kept], initial=0.0) < 0.0:
            axes.plot(time_s, -values[:, case : case + 1], lw=1.5, **style)
    if names == ["residual"]:
        axes.axhline(1.0, color=INK, ls=(0, (4, 2)), lw=1.2)
    if names == ["n_declared"]:
        top = np.nanmax(signals["n_declared"], initial=1.0)
        axes.set(ylim=(-0.15, max(top, 2.0) + 0.15), yticks=range(int(max(top, 2.0)) + 1))
    axes.set(ylabel=label(names[0]), xlabel="time [s]")
    _mark_onset(axes, recording, case, kept)


def _mark_onset(axes: "Axes", recording: Recording, case: int, kept: slice) -> None:
    shown = recording.time_s[kept]
    if len(shown) > 1:
        axes.set_xlim(float(shown[0]), float(shown[-1]))
    if recording.onset_s is not None:
        axes.axvline(float(recording.onset_s[case]), color=MUTED, lw=0.9, ls=":")
