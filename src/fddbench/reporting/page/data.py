"""Everything that a page shows."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from fddbench.interfaces import Bands, Consequence, Recording, Response
from fddbench.reporting.published import Iterations, Published
from fddbench.reporting.tables import Cell

__all__ = ["ReportData"]


@dataclass(frozen=True, kw_only=True)
class ReportData:
    """Everything that a page shows.

    Attributes
    ----------
    campaign : mapping
        Effective content of the campaign: name, about, seed, benchmark, what was chosen, purpose, sample_s, scenarios,
        detectors, and reconfigure where the aircraft acts on one of them.
    rows, events : DataFrame
        Tables as ``fddbench.load`` gives them.
    provenance : mapping of str to str
        Versions, machine, date, wall time, hashes: shown as it is.
    designs : sequence of mapping
        Per detector name, kind, source, about, sees ("sensors" or "voted"), sha256, and what `fddbench.reporting.loads` shows.
    recordings : sequence of Recording
        Re-flown cases, one recording per scenario.
    unflown : str
        Why nothing was flown again, as a sentence in the place of the pictures; "" where it was.
    published : sequence of Published
        Printed tables to stand beside ours.
    iterations : Iterations or None
        Printed course of an optimisation, and ours.
    limits_from : str
        Where the benchmark's detection time limits come from.
    choices : sequence of str
        Keys of what the campaign chose on the benchmark.
    envelope_axes : sequence of pairs of str
        Parameters that belong on the two axes of a picture of the envelope.
    in_sample : sequence of str
        Detectors that were tuned on these flights.
    partial : str
        How many flights of how many the folder holds, "" when all.
    kept : str
        Which rows these are where the campaign does not keep all, "" where it does.
    counted : DataFrame or None
        Then what is counted of all, lines of `fddbench.metrics.summary.SUMMARY`.
    detectable : DataFrame or None
        Maps of detectability, lines of `fddbench.metrics.detectable.DETECTABLE`.
    consequences : sequence of Consequence
        What the loop says of what faults do to the aircraft.
    bounds : DataFrame or None
        What the ideal test finds, lines of `fddbench.metrics.bound.BOUNDS`.
    bands : sequence of Bands
        All flights of scenarios as quantiles over time, where the campaign asks for them.
    responses, shown : sequences
        Panels of healthy flights, as the plant says, and signals of the others, as the benchmark does.
    folder : str
        The folder of results as a reader would write it.
    reasons : sequence of lines of cells
        What was found behind the failures of a shipped campaign.
    requirements : sequence of mapping
        What the campaign requires and whether it holds, see `fddbench.reporting.page.requirements`.
    operating : DataFrame or None
        Operating curves, lines of `fddbench.metrics.operating.OPERATING`.
    swept : sequence of str
        Columns of what the grid or a sweep varies: the first sentence tells how the right share goes along them.
    """

    campaign: Mapping[str, Any]
    rows: pd.DataFrame
    events: pd.DataFrame
    provenance: Mapping[str, str]
    designs: Sequence[Mapping[str, Any]]
    recordings: Sequence[Recording]
    unflown: str = ""
    published: Sequence[Published] = ()
    iterations: Iterations | None = None
    limits_from: str = ""
    choices: Sequence[str] = ()
    envelope_axes: Sequence[tuple[str, str]] = ()
    in_sample: Sequence[str] = ()
    partial: str = ""
    kept: str = ""
    counted: pd.DataFrame | None = None
    detectable: pd.DataFrame | None = None
    bounds: pd.DataFrame | None = None
    consequences: Sequence[Consequence] = ()
    bands: Sequence[Bands] = ()
    responses: Sequence[Response] = ()
    shown: Sequence[str] = ()
    folder: str = "results"
    reasons: Sequence[Sequence[Cell]] = ()
    requirements: Sequence[Mapping[str, Any]] = ()
    operating: pd.DataFrame | None = None
    swept: Sequence[str] = ()
