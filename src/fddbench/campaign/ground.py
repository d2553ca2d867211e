"""What a campaign stands on: its benchmark, what it has chosen there, what flies."""

from dataclasses import dataclass, field
from pathlib import Path

from fddbench import kinds
from fddbench.campaign.reading.document import Document
from fddbench.campaign.rules.model import campaign_file
from fddbench.campaign.rules.references import Chosen, choose
from fddbench.errors import FddbenchError, Mistake, reason_of
from fddbench.interfaces import Benchmark, Plant

__all__ = ["Ground", "ground_of"]


@dataclass(kw_only=True)
class Ground:
    """What a campaign stands on: its benchmark, what it has chosen there, what flies, and what is wrong with these."""

    benchmark: Benchmark | None = None
    chosen: Chosen | None = None
    plant: Plant | None = None
    files: dict[str, bytes] = field(default_factory=dict)
    mistakes: list[Mistake] = field(default_factory=list)


def ground_of(document: Document, folder: Path) -> Ground:
    """Benchmark, choices and plant; foreign code may raise anything, which is told where the campaign names it."""
    found, name = Ground(), document.get("benchmark")
    if not isinstance(name, str):
        return found
    try:
        kind = kinds.find("benchmark", name, beside=folder)
        found.files |= kind.files
        benchmark = kind.member()
        campaign_file(tuple(benchmark.choices))
        found.benchmark = benchmark
        found.chosen, wrong = choose(document, benchmark, folder)
        found.mistakes += wrong
        if found.chosen is not None:
            found.files |= found.chosen.files
            found.plant = benchmark.plant(found.chosen.members)
            _require_sound(found.plant)
    except FddbenchError as error:
        found.mistakes.append(document.mistake(("benchmark",), str(error)))
    except (Exception, SystemExit) as error:
        message = f"the benchmark {name!r} cannot be used: {reason_of(error)}"
        found.mistakes.append(document.mistake(("benchmark",), message))
    if found.mistakes:
        found.plant = None
    return found


def _require_sound(plant: Plant) -> None:
    """Refuse a plant that cannot be asked, or whose sites have a unit that nobody knows.

    Raises
    ------
    FddbenchError
        With what is missing.
    """
    missing = [name for name in ("sites", "parameters", "refused_parameters", "manoeuvres") if name not in dir(plant)]
    if missing:
        raise FddbenchError(f"the plant of this benchmark has no {' and no '.join(missing)}")
    names = [site.name for site in plant.sites]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise FddbenchError(f"the fault sites {sorted(twice)} are there twice; give each its own name")
    for site in plant.sites:
        _ = site.unit
