"""The shipped logs, read when they are chosen."""

from pathlib import Path

from fddbench.benchmarks.recorded.plant import read_plant

__all__ = ["YAW_RATE_FLIGHTS"]

YAW_RATE_FLIGHTS = read_plant(Path(__file__).parent / "data" / "yaw_rate_flights.yaml")
