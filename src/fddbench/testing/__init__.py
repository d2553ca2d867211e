"""What authors of plug-ins run: each function raises AssertionError with what is wrong, or returns nothing.

The shipped members are tested with the same functions.
"""

from fddbench.testing.benchmarks import check_benchmark
from fddbench.testing.detectors import check_detector
from fddbench.testing.faults import check_fault
from fddbench.testing.voters import check_voter

__all__ = ["check_benchmark", "check_detector", "check_fault", "check_voter"]
