"""Recorded flights: detectors fly on logs instead of an aircraft."""

from fddbench.benchmarks.recorded.benchmark import Recorded

__all__ = ["Recorded"]
