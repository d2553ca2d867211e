"""Whether a benchmark keeps the contract."""

import tempfile
from pathlib import Path

import numpy as np

from fddbench import kinds
from fddbench.campaign.load import read_campaign
from fddbench.campaign.reading.canonical import canonical_text
from fddbench.errors import FddbenchError
from fddbench.interfaces import Benchmark, Plant
from fddbench.interfaces.benchmark import default_choices
from fddbench.runner.assembling import assemble
from fddbench.testing.campaigns import different_bits, flown, require, some_flights

__all__ = ["check_benchmark"]

_WATCHER = '''"""Watches nothing and declares nothing."""

from types import SimpleNamespace

import numpy as np
from pydantic import BaseModel

from fddbench.blocks.layout import Layout, Nothing
from fddbench.interfaces import Verdict


class Watcher:
    about, recorded, watches, Gains, states = "nothing", (), (), type("Gains", (BaseModel,), {}), Layout(Nothing())

    def __init__(self, signal, rows):
        self.signal, self.rows = signal, rows

    @classmethod
    def from_design(cls, gains, bus):
        return cls(*next(iter(bus.signals.items())))

    def start(self):
        return Nothing()

    def step(self, x, measured):
        value = getattr(measured, self.signal)
        zero = 0.0 * np.abs(value[0] if self.rows else value)
        return x, Verdict(np.stack([zero])[:0], zero)
'''


def check_benchmark(name: str, *, beside: str | Path = ".", duration_s: float = 2.0) -> None:
    """Fly a benchmark healthy and with a fault, in every manoeuvre and with every option of its choices.

    Whatever it shows has the same bits in any company and in compiled code; a fault of size zero is the healthy flight; its
    parameters, sites and manoeuvres can be used in a campaign.

    Parameters
    ----------
    name : str
        A registered benchmark, or ``mine.py:Mine``.
    beside : str or Path
        Folder of that file.
    duration_s : float
        Length of the flights [s].

    Raises
    ------
    AssertionError
        With what is wrong.
    FddbenchError
        It cannot be used at all.
    """
    folder = Path(beside)
    benchmark: Benchmark = kinds.find("benchmark", name, beside=folder).member()
    plant = benchmark.plant(default_choices(benchmark))
    for parameter in plant.parameters:
        inside = parameter.low <= parameter.default <= parameter.high
        require(inside, f"the default of {parameter.name}, {parameter.default:g}, is outside of its own limits")
    require(plant.sites, f"benchmark {name!r} has no fault site")
    with tempfile.TemporaryDirectory() as made:
        where = _folder(Path(made), name, folder)
        for chosen in _one_by_one(benchmark):
            path = where / "check.yaml"
            path.write_text(canonical_text(_campaign(name, plant, chosen, duration_s)), encoding="utf-8")
            _fly(path, chosen)


def _folder(made: Path, name: str, beside: Path) -> Path:
    """Folder with the watcher, and with the files of the benchmark if it stands in one."""
    for file, content in kinds.find("benchmark", name, beside=beside).files.items():
        (made / file).parent.mkdir(parents=True, exist_ok=True)
        (made / file).write_bytes(content)
    (made / "detectors").mkdir()
    (made / "detectors" / "watcher.py").write_text(_WATCHER, encoding="utf-8")
    (made / "detectors" / "watcher.yaml").write_text(
        "kind: watcher.py:Watcher\nsource: none\ntuned_on: null\ngains: {}\n", encoding="utf-8"
    )
    return made


def _one_by_one(benchmark: Benchmark) -> list[dict[str, str]]:
    """The defaults, and every other option by itself."""
    others = [{key: name} for key, choice in benchmark.choices.items() for name in list(choice.options)[1:]]
    return [{}, *others]


def _campaign(name: str, plant: Plant, chosen: dict[str, str], duration_s: float) -> dict[str, object]:
    scenarios: list[dict[str, object]] = [
        {"name": f"healthy_{j}", "manoeuvre": manoeuvre} for j, manoeuvre in enumerate(plant.manoeuvres)
    ]
    first = next(iter(plant.manoeuvres))
    for site in plant.sites:
        fault = {"kind": "bias", "sites": [site.name], "onset_s": duration_s / 2.0, "amplitude_percent": 0.0}
        common = {"manoeuvre": first, "detection_time_limit_s": 1.0}
        scenarios.append({"name": f"zero_{site.name}", "faults": [fault], **common})
        scenarios.append({"name": f"bias_{site.name}", "faults": [{**fault, "amplitude_percent": 1.0}], **common})
    drawn = {p.name: {"uniform": [p.low, p.high]} for p in plant.parameters if p.low < p.high}
    return {
        "name": "check", "benchmark": name, "seed": 1, "duration_s": duration_s, "detectors": ["watcher"], **chosen,
        "scenarios": scenarios, "dispersions": {"monte_carlo": {"runs": 3, **drawn}},
    }  # fmt: skip


def _fly(path: Path, chosen: dict[str, str]) -> None:
    """Compare the bits of a few flights."""
    what = ", ".join(f"{key} {name}" for key, name in chosen.items()) or "the default choices"
    try:
        assembly, batch = some_flights(path, [], most=8)
    except (FddbenchError, AssertionError) as error:
        raise AssertionError(f"with {what}: {error}") from error
    loop = assembly.loop
    recorded = [*(f"measured:{name}" for name in loop.bus.signals), *(f"truth:{name}" for name in loop.truth)]
    wrong = different_bits(assembly, batch, recorded)
    require(not wrong, f"with {what}: {wrong}")
    _require_zero_is_healthy(path, recorded)


def _require_zero_is_healthy(path: Path, recorded: list[str]) -> None:
    """A fault of size zero leaves every bit as it was."""
    assembly = assemble(read_campaign(path))
    by_name = {planned.name: planned for planned in assembly.plan.scenarios}
    healthy = by_name["healthy_0"]
    for name, planned in by_name.items():
        if not name.startswith("zero_"):
            continue
        pair = assembly.batch(np.array([healthy.first_case, planned.first_case]))
        if any(pair.infeasible_reason):
            continue
        for signal, rows in flown(assembly, pair, recorded).recorded.items():
            same = rows[:, :, 0].tobytes() == rows[:, :, 1].tobytes()
            require(
                same, f"a fault of size zero on {name.removeprefix('zero_')} changes {signal}: is it added exactly?"
            )
