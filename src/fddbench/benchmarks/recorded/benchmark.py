"""The benchmark of recorded flights as campaigns see it."""

from collections.abc import Mapping
from typing import Any

from fddbench.benchmarks.recorded.loop import RecordedLoop
from fddbench.benchmarks.recorded.plant import RecordedPlant, read_plant
from fddbench.interfaces import Choice, Loop, Options
from fddbench.kinds import Named
from fddbench.voting.closest_two import ClosestTwo
from fddbench.voting.median import Median
from fddbench.voting.monitored import Monitored

__all__ = ["Recorded"]


_LOGS = Named({"yaw_rate_flights": "fddbench.benchmarks.recorded.shipped:YAW_RATE_FLIGHTS"})


class Recorded:
    """Logs instead of an aircraft: detectors see what was recorded, with the faults that are in it or are injected.

    A mapping beside the campaign says which channel of a log is which signal, in which unit, and where faults can sit
    (``logs: mine.yaml``). Nothing recorded answers to an injected fault: the loop is open.
    """

    name = "recorded"
    about = "logs of flights (CSV, Parquet, PX4 ULog) instead of an aircraft; open loop"
    choices: Mapping[str, Choice] = {
        "logs": Choice(
            about="which flights: a mapping of logs beside the campaign, mine.yaml",
            options=_LOGS,
            reads=read_plant,
            says={
                "yaw_rate_flights": "two flights of the yaw-rate benchmark: 1 healthy, 2 with a sensor that is wrong"
            },
        ),
        "voter": Choice(
            about="how redundant channels are voted",
            options={"median": Median, "closest_two": ClosestTwo, "monitored": Monitored},
            family="voter",
            needs=("vote",),
        ),
    }
    shown: tuple[str, ...] = ("r_deg_s", "r_voted_deg_s")
    limits_from = "the mapping of the logs"

    def plant(self, chosen: Mapping[str, Any]) -> RecordedPlant:
        """The chosen logs."""
        plant: RecordedPlant = chosen["logs"]
        return plant

    def loop(self, options: Options) -> Loop:
        """The open loop of these logs."""
        return RecordedLoop(self.plant(options.chosen), options.chosen["voter"], options)
