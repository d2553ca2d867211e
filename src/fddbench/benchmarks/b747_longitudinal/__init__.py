"""The longitudinal Boeing 747 in closed loop, with faults of elevator and thrust."""

from fddbench.benchmarks.b747_longitudinal.benchmark import B747Longitudinal

__all__ = ["B747Longitudinal"]
