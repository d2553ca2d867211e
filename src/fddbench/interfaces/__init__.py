"""The plug-in protocols, a page each: what a benchmark, a loop, a voter and a detector must offer.

A step is a function of one sample in plain NumPy on rows of numbers, (n_cases,) or (n_rows, n_cases), without a
data-dependent ``if``; see ``blocks`` for the operations it may use. It runs on many flights at once and sees one sample, so
it cannot look ahead.
"""

from fddbench.interfaces.benchmark import (
    Benchmark,
    Choice,
    Detectability,
    Options,
    Parameter,
    Plant,
    Response,
    SinglePlant,
)
from fddbench.interfaces.bus import Bus
from fddbench.interfaces.consequence import Consequence
from fddbench.interfaces.detector import Detector, Tunable, Verdict, Voter
from fddbench.interfaces.fault import Fault, FaultBlock, Instant
from fddbench.interfaces.floats import NEVER, Floats
from fddbench.interfaces.ideal import IdealModel
from fddbench.interfaces.logged_faults import IN_LOG, LoggedFaults
from fddbench.interfaces.loop import FlightFaults, Flights, Loop, Prepared, Sample
from fddbench.interfaces.recording import QUANTILES, Bands, Recording
from fddbench.interfaces.scheduling import AffineModel, Channel, Scheduling
from fddbench.interfaces.site import Site

__all__ = [
    "IN_LOG",
    "NEVER",
    "QUANTILES",
    "AffineModel",
    "Bands",
    "Benchmark",
    "Bus",
    "Channel",
    "Choice",
    "Consequence",
    "Detectability",
    "Detector",
    "Fault",
    "FaultBlock",
    "FlightFaults",
    "Flights",
    "Floats",
    "IdealModel",
    "Instant",
    "LoggedFaults",
    "Loop",
    "Options",
    "Parameter",
    "Plant",
    "Prepared",
    "Recording",
    "Response",
    "Sample",
    "Scheduling",
    "SinglePlant",
    "Site",
    "Tunable",
    "Verdict",
    "Voter",
]
