"""One flight as the yaw-rate paper shows it in Figs 4 and 5: parameters, states, sensors, the fault and its reconstruction."""

import base64
from typing import TYPE_CHECKING

from fddbench.interfaces import Floats, Recording
from fddbench.reporting.pictures import INK, MUTED, WARNING, colour, dashes, to_png

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["reconstruction_png"]

_RHO = {"rho_mass": "mass", "rho_x_cg": "X_cg", "rho_altitude": "altitude", "rho_v_cas": "airspeed"}
_STATES = {"phi_deg": "bank angle [deg]", "beta_deg": "sideslip [deg]", "p_deg_s": "roll rate [deg/s]"}


def reconstruction_png(recording: Recording, detector: str, case: int, *, title: str) -> bytes:
    """PNG of one flight.

    Parameters
    ----------
    recording : Recording
        Of the yaw-rate benchmark, all its signals kept.
    detector : str
        A `sliding_mode` with ``record_observer: true``.
    case : int
        Position of the flight in the recording.
    title : str
        Over the picture.
    """

    def draw(figure: "Figure") -> None:
        figure.suptitle(title, x=0.01, ha="left", fontsize=9.5, fontweight="bold")
        parameters, states, sensors, fault, sliding, spare = figure.subplots(3, 2).ravel()
        spare.remove()
        shown = recording.detectors[detector]
        _lines(parameters, recording, {name: shown[key][:, case] for key, name in _RHO.items()})
        parameters.set_title("(a) scheduling parameters as measured [-]")
        _lines(states, recording, {name: recording.signals[key][:, case] for key, name in _STATES.items()})
        states.set_title("(b) states")
        _sensors(sensors, recording, case)
        _fault(fault, recording, detector, case)
        _sliding(sliding, recording, detector, case)
        for axes in (parameters, states, sensors, fault, sliding):
            axes.set_xlabel("time [s]")
            axes.axvline(
                float((recording.onset_s if recording.onset_s is not None else [0.0])[case]), color=MUTED, lw=0.7
            )

    return base64.b64decode(to_png(draw, width_in=10.6, height_in=8.2) or "")


def _lines(axes: "Axes", recording: Recording, values: dict[str, Floats]) -> None:
    for i, (name, value) in enumerate(values.items()):
        axes.plot(recording.time_s, value, color=colour(i), ls=dashes(i), lw=1.1, label=name)
    axes.legend(loc="upper left", ncols=2)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.25 * (high - low))


def _sensors(axes: "Axes", recording: Recording, case: int) -> None:
    for i in range(3):
        value = recording.signals[f"r_deg_s_{i + 1}"][:, case]
        axes.plot(recording.time_s, value, color=colour(i), ls=dashes(i), lw=1.1, label=f"r{i + 1}")
    axes.plot(recording.time_s, recording.signals["r_voted_deg_s"][:, case], color=INK, lw=0.7, label="voted")
    axes.legend(loc="upper left", ncols=4)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.2 * (high - low))
    axes.set_title("(c) yaw rates [deg/s]")


def _fault(axes: "Axes", recording: Recording, detector: str, case: int) -> None:
    shown, signals = recording.detectors[detector], recording.signals
    fault = signals["r_voted_deg_s"][:, case] - signals["r_true_deg_s"][:, case]
    axes.plot(recording.time_s, fault, color=MUTED, lw=1.8, label="fault of the voted rate")
    axes.plot(recording.time_s, shown["reconstruction_deg_s"][:, case], color=WARNING, lw=0.9, label="reconstruction")
    axes.plot(recording.time_s, shown["threshold_deg_s"][:, case], color=INK, lw=0.7, ls=":", label="threshold")
    axes.legend(loc="upper left", ncols=3)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.2 * (high - low))
    axes.set_title("(d) fault and its reconstruction [deg/s]")


def _sliding(axes: "Axes", recording: Recording, detector: str, case: int) -> None:
    shown = recording.detectors[detector]
    axes.set_yscale("log")
    axes.plot(recording.time_s, shown["modulation_used"][:, case], color=colour(2), lw=0.6, label="share of K in use")
    axes.plot(recording.time_s, shown["output_error"][:, case], color=colour(0), lw=0.6, label="|e_y|, rad and m/s")
    axes.set_ylim(1e-5, 1e2)
    axes.set_yticks([1e-4, 1e-2, 1.0], ["1e-4", "0.01", "1"])
    axes.legend(loc="upper left", ncols=2)
    axes.set_title("(e) it slides: |e_y| small, less than all of K in use")
