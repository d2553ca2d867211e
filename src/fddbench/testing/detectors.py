"""Whether a detector keeps the contract."""

from pathlib import Path

from fddbench.campaign.reading.overrides import ALONE
from fddbench.errors import DesignError
from fddbench.runner.flight import Flyer
from fddbench.runner.rehearsal import rehearse
from fddbench.runner.rows import rows_and_events
from fddbench.testing.campaigns import different_bits, require, some_flights

__all__ = ["check_detector"]


def check_detector(design: str, *, campaign: str | Path = "smoke") -> None:
    """Fly a detector on a few flights of a campaign that feeds it.

    Its step gives the same bits in any company and, where it can be compiled, in compiled code; it raises nothing, decides
    0 or 1, and keeps to the sites that it watches. One that cannot be compiled is put through what `fddbench run` puts it
    through: its verdicts on a flight do not depend on what it flew before, on other flights or on how long the flight lasts.

    Parameters
    ----------
    design : str
        Name of a design in ``detectors/`` beside the campaign, where one works, or as shipped.
    campaign : str or Path
        File or name of a campaign.

    Raises
    ------
    AssertionError
        With what is wrong.
    FddbenchError
        The design or the campaign cannot be read, or the numbers make no detector.

    Examples
    --------
    >>> check_detector("voting_monitor")
    """
    assembly, batch = some_flights(campaign, [f"detectors=[{design}]", *ALONE])
    detector = assembly.detectors[design]
    unknown = set(detector.watches) - set(assembly.loop.bus.names)
    require(not unknown, f"{design} watches {sorted(unknown)}, which are no sites of this benchmark")
    _rehearse(Flyer(assembly), design)
    rows, _ = rows_and_events(Flyer(assembly), batch.cases)
    for status, reason in zip(rows["status"].to_pylist(), rows["reason"].to_pylist(), strict=True):
        require(status in {"ok", "infeasible"}, f"{design} ends a flight with {status}: {reason}")
    wrong = different_bits(assembly, batch, [f"{design}:{name}" for name in detector.recorded])
    require(not wrong, f"{design}: {wrong}")


def _rehearse(flyer: Flyer, design: str) -> None:
    try:
        given_up = rehearse(flyer)
    except DesignError as error:
        raise AssertionError(str(error)) from error
    require(not given_up, f"{design} is {given_up[design].said if given_up else ''}")
