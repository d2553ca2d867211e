"""Yaw-rate sensor monitoring of a transport aircraft: three sensors, a voter, ten published faults."""

from fddbench.benchmarks.yaw_rate.benchmark import YawRate

__all__ = ["YawRate"]
