"""Whether a kind of fault keeps the contract."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from fddbench import kinds
from fddbench.faults.injection import SignalFaults
from fddbench.interfaces import FlightFaults, Floats, Site
from fddbench.testing.campaigns import require

__all__ = ["check_fault"]

_N, _CASES, _ONSET, _END, _SAMPLE_S = 60, 3, 20, 50, 0.01


def check_fault(name: str, sizes: Mapping[str, Any], *, beside: str | Path = ".", unit: str = "deg/s") -> None:
    """Fly a kind of fault on two of three sites that can float.

    It leaves every bit of the healthy signal before its onset, after its end and on other sites; it does something in between;
    it gives the same bits in any company.

    Parameters
    ----------
    name : str
        A registered kind, or ``mine.py:Mine``.
    sizes : mapping
        Its keys as a campaign writes them, e.g. ``{"amplitude_deg_s": 1.0}``.
    beside : str or Path
        Folder of that file, and of files that its keys name.
    unit : str
        Unit of the sites.

    Raises
    ------
    AssertionError
        With what is wrong.
    FddbenchError
        It cannot be used at all.

    Examples
    --------
    >>> check_fault("jam", {"amplitude_deg_s": 1.0})
    """
    model = kinds.find("fault", name, beside=Path(beside)).member.in_unit(unit)
    common = {"kind": name, "sites": ["s1", "s2"], "onset_s": _ONSET * _SAMPLE_S, "end_s": _END * _SAMPLE_S}
    fault = model.model_validate({**common, **sizes})
    if fault.files:
        fault = fault.with_files({key: (Path(beside) / getattr(fault, key)).read_bytes() for key in fault.files})
    sites = tuple(
        Site(name=f"s{j + 1}", signal="s", row=j, unit_name=unit, admissible=40.0, stops=(-1e3, 1e3), floats=True)
        for j in range(3)
    )
    healthy = np.random.default_rng(7).normal(size=(_N, 3, _CASES))
    normals = np.random.default_rng(8).normal(size=(_N, 4, _CASES))
    together = _fly(sites, fault, healthy, normals)
    changed = np.array([[together[k, j].tobytes() != healthy[k, j].tobytes() for j in range(3)] for k in range(_N)])
    require(not changed[:_ONSET].any(), f"{name} changes the signal before its onset")
    require(not changed[_END:].any(), f"{name} changes the signal after its end")
    require(not changed[:, 2].any(), f"{name} changes a site that it does not name")
    require(changed[_ONSET:_END, :2].any(axis=0).all(), f"{name} does nothing with these sizes: {dict(sizes)}")
    alone = _fly(sites, fault, healthy[:, :, 1:2], normals[:, :, 1:2])
    require(
        np.array_equal(alone[:, :, 0], together[:, :, 1], equal_nan=True), f"{name} depends on the company of flights"
    )


def _fly(sites: tuple[Site, ...], fault: Any, healthy: Floats, normals: Floats) -> Floats:
    """Signal with the fault, (n_time, 3, n_cases)."""
    n_cases = healthy.shape[2]
    block = SignalFaults(sites, "s", [[fault]], _SAMPLE_S)
    uniform = np.full((1, 3, n_cases), 0.25)
    c = block.prepare(FlightFaults(lists=[[fault]], which=np.zeros(n_cases, dtype=np.int64), uniform=uniform))
    x, found = block.states.spread(block.start(c), n_cases), []
    with np.errstate(all="ignore"):  # on sites without the fault its constants are zero, and what it says is not used
        for k in range(len(healthy)):
            drawn = block.draws.unpack(normals[k, : block.draws.size])
            x, signal = block.step(x, c, drawn, healthy[k], np.float64(k), free=-0.3 * healthy[k])
            found.append(signal)
    return np.array(found)
