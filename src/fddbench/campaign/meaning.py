"""What a campaign means once everything in it has been checked and every default filled in."""

from dataclasses import dataclass, field
from pathlib import Path

from fddbench.campaign.designs import Design
from fddbench.campaign.document import refuse
from fddbench.campaign.model import Dispersions, Purpose
from fddbench.campaign.soundness import unsound
from fddbench.errors import DesignError, Mistake, reason_of
from fddbench.faults.specification import FaultSpecification
from fddbench.interfaces import Bus, Detector

__all__ = ["Campaign", "Scenario", "build_detectors"]


@dataclass(frozen=True, kw_only=True)
class Scenario:
    """A manoeuvre and the faults injected in it.

    Attributes
    ----------
    runs : int or None
        Monte-Carlo runs instead of the campaign's.
    duration_s, detection_time_limit_s : float or None
        Instead of the campaign's and of the benchmark's [s].
    """

    name: str
    manoeuvre: str
    faults: tuple[FaultSpecification, ...]
    runs: int | None
    duration_s: float | None
    detection_time_limit_s: float | None


@dataclass(frozen=True, kw_only=True)
class Campaign:
    """Everything that determines a table of results.

    Attributes
    ----------
    path : Path
        File it was read from.
    benchmark, plant, voter, sensors, wind : str
        Registered benchmark, and its options.
    purpose, seed : str, int
        Address of all random numbers.
    sample_s : float
        Clock [s].
    substeps : int
        Integration steps in a sample.
    duration_s : float or None
        Length of the flights of scenarios that do not say [s].
    designs : tuple of Design
        Detectors in the order of the file.
    text : str
        Canonical YAML of the campaign with all overrides; `read_campaign` reads it back to the same campaign.
    sha256 : str
        Of the meaning without `about`, and of the designs: equal hashes give equal rows.
    """

    path: Path
    name: str
    about: str
    benchmark: str
    plant: str
    voter: str
    sensors: str
    wind: str
    purpose: Purpose
    seed: int
    sample_s: float
    substeps: int
    duration_s: float | None
    scenarios: tuple[Scenario, ...]
    dispersions: Dispersions
    designs: tuple[Design, ...]
    text: str = field(repr=False)
    sha256: str

    def files(self) -> dict[str, str]:
        """Text by name of everything to keep in a folder of results so that the campaign can be read there again."""
        found = {"campaign.yaml": self.text}
        for design in self.designs:
            found[f"detectors/{design.name}.yaml"] = design.text
            if design.plugin is not None:
                found[f"detectors/{design.plugin.file}"] = design.plugin.text
        return found


def build_detectors(campaign: Campaign, bus: Bus) -> dict[str, Detector]:
    """Detectors of a campaign by the name of their design, in the order of the file.

    Raises
    ------
    CampaignError
        The numbers of a design make no detector for this bus; located where the campaign names the design.
    """
    found: dict[str, Detector] = {}
    mistakes = []
    for design in campaign.designs:
        try:
            found[design.name] = design.build(bus)
        except DesignError as error:
            wrong = str(error)
        except (Exception, SystemExit) as error:  # a plug-in may raise anything
            wrong = f"from_design raised {reason_of(error)}"
        else:
            wrong = unsound(found[design.name], bus)
        if wrong:
            mistakes.append(Mistake(design.where, f"design {design.name!r} ({design.path}): {wrong}"))
    refuse(mistakes)
    return found
