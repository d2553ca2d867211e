"""Picture of one flight: what flew, what each detector saw, and when it declared what."""

import base64
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from markupsafe import escape

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats, Recording
from fddbench.reporting.declarations import declarations
from fddbench.reporting.labels import label
from fddbench.reporting.pictures import INK, MUTED, colour, drawn
from fddbench.reporting.signals import signal_panels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["PICTURES", "require_picture", "write_picture"]

PICTURES = (".html", ".png", ".svg", ".pdf")
"""What a picture can be written as, by the end of the file's name."""

_MOST_SIGNALS, _WIDTH_IN, _HEIGHT_IN = 6, 9.0, 1.45


def write_picture(recording: Recording, path: Path, shown: Sequence[str] = ()) -> None:
    """Write the picture of the first flight of a recording; the end of the file's name says as what.

    Parameters
    ----------
    shown : sequence of str
        Signals to draw, one panel each, numbered rows of one together; the first ones by default.

    Raises
    ------
    FddbenchError
        Another ending, or the file cannot be written.
    """
    require_picture(path)
    groups = _groups(recording, shown)
    panels = sum(len(signal_panels(of)) - 1 for of in recording.detectors.values())
    size = {"width_in": _WIDTH_IN, "height_in": _HEIGHT_IN * (len(groups) + panels) + 0.9}
    kind = "png" if path.suffix == ".html" else path.suffix[1:]
    content = drawn(lambda figure: _draw(figure, recording, groups), kind=kind, **size)
    try:
        path.write_bytes(_page(recording, content) if path.suffix == ".html" else content)
    except OSError as error:
        raise FddbenchError(f"cannot write {path}: {error.strerror}; name another file with --plot") from error


def require_picture(path: Path) -> None:
    """Refuse a file whose name does not end as one of `PICTURES`."""
    if path.suffix not in PICTURES:
        raise FddbenchError(f"{path}: cannot tell the format from the name; let it end in {', '.join(PICTURES)}")


def _groups(recording: Recording, shown: Sequence[str]) -> list[list[str]]:
    """Signals panel by panel: rows of one signal lie together."""
    of: dict[str, list[str]] = {}
    for name in recording.signals:
        stem, _, number = name.rpartition("_")
        of.setdefault(stem if stem and number.isdigit() else name, []).append(name)
    unknown = [wanted for wanted in shown if not any(wanted in (stem, *names) for stem, names in of.items())]
    if unknown:
        raise FddbenchError(f"there is no signal {unknown[0]!r}; known: {', '.join(of)}")
    first = [stem for wanted in shown for stem in of if wanted in (stem, *of[stem])]
    few = [stem for stem in of if len(of[stem]) <= 4]
    chosen = list(dict.fromkeys([*first, *few]))[: max(_MOST_SIGNALS, len(first))]
    return [of[stem] for stem in chosen]


def _draw(figure: "Figure", recording: Recording, groups: Sequence[Sequence[str]]) -> None:
    panels = [(name, of) for name, own in recording.detectors.items() for of in signal_panels(own)[:-1]]
    axes = np.atleast_1d(figure.subplots(len(groups) + len(panels), 1, sharex=True))
    figure.suptitle(f"flight {recording.cases[0]}", x=0.01, ha="left", size=10, weight="bold")
    for one, names in zip(axes, groups, strict=False):
        _lines(one, recording.time_s, {name: recording.signals[name][:, 0] for name in names})
        # a signal called p is the roll rate; only of columns "p_" is a prefix
        one.set_ylabel(label("p_" + (names[0] if len(names) == 1 else names[0].rpartition("_")[0])))
    for one, (detector, names) in zip(axes[len(groups) :], panels, strict=True):
        _detector(one, recording, detector, names)
    changes = declarations(recording)
    order = list(recording.detectors)
    for one in axes:
        if recording.onset_s is not None:
            one.axvline(float(recording.onset_s[0]), color=INK, lw=1.0, ls=":")
        for name, time_s, *_ in changes:
            one.axvline(time_s, color=colour(order.index(name)), lw=1.0, ls=(0, (4, 2)))
    _told(axes[0], recording, changes, order)
    axes[-1].set_xlabel("time [s]")
    axes[-1].set_xlim(float(recording.time_s[0]), float(recording.time_s[-1]))


def _told(one: "Axes", recording: Recording, changes: list[tuple[str, float, str, bool]], order: list[str]) -> None:
    """Say above the panels what the lines are."""
    from matplotlib.lines import Line2D

    onset = recording.onset_s
    handles = [Line2D([], [], color=INK, lw=1.0, ls=":")] if onset is not None else []
    names = [f"onset {float(onset[0]):g} s"] if onset is not None else []
    for name in order:
        own = [
            f"{sites or ('alarm' if alarm else 'nothing')} at {t:g} s" for n, t, sites, alarm in changes if n == name
        ]
        handles.append(Line2D([], [], color=colour(order.index(name)), lw=1.0, ls=(0, (4, 2))))
        more = f" and {len(own) - 3} more" if len(own) > 3 else ""
        names.append(f"{name}: {', '.join(own[:3]) + more if own else 'declares nothing'}")
    one.figure.legend(handles, names, loc="outside lower left", ncols=1)


def _lines(one: "Axes", time_s: Floats, values: dict[str, Floats]) -> None:
    looks: Any = ("-", (0, (4, 1.5)), (0, (1, 1)), "-.")
    for i, (name, value) in enumerate(values.items()):
        tone = (INK, "#c58b00", "#7b5ea7", MUTED)[i % 4]
        one.plot(time_s, value, lw=0.9, color=tone, ls=looks[i % 4], label=name.rpartition("_")[2])
    if 1 < len(values) <= 4:
        one.legend(loc="upper right", ncols=len(values), handlelength=1.6)


def _detector(one: "Axes", recording: Recording, detector: str, names: Sequence[str]) -> None:
    tone = colour(list(recording.detectors).index(detector))
    for name in names:
        value, threshold = recording.detectors[detector][name][:, 0], "threshold" in name
        one.plot(
            recording.time_s, value, lw=1.0, color=INK if threshold else tone, ls=(0, (4, 2)) if threshold else "-"
        )
        if threshold and np.nanmin(recording.detectors[detector][names[0]][:, 0], initial=0.0) < 0.0:
            one.plot(recording.time_s, -value, lw=1.0, color=INK, ls=(0, (4, 2)))
    if list(names) == ["residual"]:
        one.axhline(1.0, color=INK, lw=1.0, ls=(0, (4, 2)))
    one.set_ylabel(label(names[0]))
    one.set_title(detector, color=tone)


def _page(recording: Recording, png: bytes) -> bytes:
    """One HTML file with the picture, and every declaration in a table."""
    lines = "".join(
        f"<tr><td>{escape(name)}</td><td>{time_s:.2f}</td><td>{escape(sites or ('alarm' if alarm else 'nothing'))}</td></tr>"
        for name, time_s, sites, alarm in declarations(recording)
    )
    onset = "healthy" if recording.onset_s is None else f"onset {float(recording.onset_s[0]):g} s"
    case, image = escape(recording.cases[0]), base64.b64encode(png).decode()
    text = f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>flight {case}</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<style>body{{font:15px/1.5 system-ui,sans-serif;max-width:62rem;margin:1.5rem auto;padding:0 1rem}}
:root{{color:#1f2933;background:#fff}}
img{{max-width:100%;height:auto}}td,th{{text-align:left;padding:.15rem 1.2rem .15rem 0}}</style></head>
<body><h1>Flight {case}</h1><p>{onset}; flown again bit for bit.</p>
<img alt="Signals of flight {case} over time, and what each detector shows" src="data:image/png;base64,{image}">
<h2>Declarations</h2>
<table><thead><tr><th>detector</th><th>time [s]</th><th>declares</th></tr></thead><tbody>{lines}</tbody></table>
</body></html>
"""
    return text.encode()
