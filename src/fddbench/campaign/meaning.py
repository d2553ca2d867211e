"""What a campaign means once everything in it has been checked and every default filled in."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fddbench.campaign.rules.dispersions import Dispersions
from fddbench.campaign.rules.model import Keep, Purpose, RequirementEntry, ScenarioEntry
from fddbench.designs.design import Design
from fddbench.faults.specification import FaultSpecification
from fddbench.interfaces import Benchmark, Floats, Plant

__all__ = ["Campaign", "Scenario"]


@dataclass(frozen=True, kw_only=True)
class Scenario:
    """A manoeuvre and the faults injected in it: the entry of the file, its faults as their kinds read them."""

    entry: ScenarioEntry
    faults: tuple[FaultSpecification, ...]

    @property
    def name(self) -> str:
        """Its name."""
        return self.entry.name


@dataclass(frozen=True, kw_only=True, eq=False)
class Campaign:
    """Everything that determines a table of results.

    Attributes
    ----------
    path : Path
        File it was read from.
    benchmark : str
        Benchmark as the campaign names it.
    bench, plant : Benchmark, Plant
        The benchmark itself, and what flies on it.
    choices, chosen : mappings
        What was chosen on it: by the key of the choice its name, and the member itself.
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
    reconfigure, reconfigure_where : str
        Name of the detector on whose declarations the aircraft acts, "" for none, and where the file says so.
    requirements : tuple of RequirementEntry
        What is required of its detectors; no part of any row.
    keep, kept_runs : str, int
        Which rows are kept: all, or of how many runs; see `fddbench.campaign.rules.model.CampaignFile`.
    text : str
        Canonical YAML of the campaign with all overrides; `read_campaign` reads it back to the same campaign.
    table : mapping of str to (n_rows,) array
        Explicit cases by name of the parameter, a row a run; empty without.
    beside : mapping of str to bytes
        Files beside the campaign that its kinds come from.
    symbols : str, list or None
        Library of operations that every detector must keep to.
    sha256 : str
        Of the meaning without `about` and what is required, of the designs and of the files: equal hashes give equal rows.
    """

    path: Path
    name: str
    about: str
    benchmark: str
    bench: Benchmark
    plant: Plant
    choices: Mapping[str, str]
    chosen: Mapping[str, Any]
    purpose: Purpose
    seed: int
    sample_s: float
    substeps: int
    duration_s: float | None
    scenarios: tuple[Scenario, ...]
    dispersions: Dispersions
    designs: tuple[Design, ...]
    reconfigure: str
    reconfigure_where: str = field(repr=False)
    requirements: tuple[RequirementEntry, ...]
    keep: Keep
    kept_runs: int
    text: str = field(repr=False)
    table: Mapping[str, Floats] = field(repr=False)
    beside: Mapping[str, bytes] = field(repr=False)
    sha256: str
    symbols: Any = None

    @property
    def shown(self) -> tuple[str, ...]:
        """Signals in the pictures of its flights: of what flies, where that says so, else of the benchmark."""
        own: tuple[str, ...] = getattr(self.plant, "shown", self.bench.shown)
        return own

    @property
    def in_sample(self) -> tuple[str, ...]:
        """Designs that were tuned on flights of this campaign and seed: their scores here flatter them."""
        own = (self.name, self.seed)
        return tuple(d.name for d in self.designs if any((seen.campaign, seen.seed) == own for seen in d.tuned_on))

    @property
    def gain_columns(self) -> tuple[str, ...]:
        """Columns of the gains that are swept, ``gain_threshold_deg_s``."""
        return tuple(dict.fromkeys(design.swept.column for design in self.designs if design.swept))

    def files(self) -> dict[str, bytes]:
        """Content by name of everything to keep in a folder of results so that the campaign can be read there again."""
        found = {"campaign.yaml": self.text.encode(), **self.beside}
        for design in self.designs:
            found[f"detectors/{design.base}.yaml"] = design.text.encode()
            found |= {f"detectors/{name}": content for name, content in design.files.items()}
        return found
