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
from fddbench.testing.campaigns import Cases, different_bits, flown, require, some_flights

__all__ = ["check_benchmark"]

_WATCHER = '''"""Watches nothing and declares nothing; or watches everything and declares it all from some sample on."""

from types import SimpleNamespace

import numpy as np
from pydantic import BaseModel

from fddbench.blocks.layout import ROW, Layout, Nothing, Row, record
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


@record
class Clock:
    samples: Row


class Declarer:
    about, recorded, states = "everything", (), Layout(Clock(samples=ROW))

    class Gains(BaseModel):
        first: float

    def __init__(self, gains, bus):
        self.first, self.n = gains.first, len(bus.sites)

    from_design = classmethod(lambda cls, gains, bus: cls(gains, bus))

    def start(self):
        return Clock(samples=0.0)

    def step(self, x, measured):
        alarm = np.where(x.samples >= self.first, 1.0, 0.0)
        return Clock(samples=x.samples + 1.0), Verdict(np.stack([alarm] * self.n), alarm)
'''

_SAMPLE_S, _NEVER = 0.01, 1e9
"""Clock of the check [s], and a sample that no flight has."""


def check_benchmark(name: str, *, beside: str | Path = ".", duration_s: float = 2.0) -> None:
    """Fly a benchmark healthy and with a fault, in every manoeuvre and with every option of its choices.

    Whatever it shows has the same bits in any company and in compiled code; a fault of size zero is the healthy flight; its
    parameters, sites and manoeuvres can be used in a campaign. A loop that reconfigures flies, while nothing is declared, as
    it flies without, and keeps the same bits when everything is declared at half of the time.

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
    with tempfile.TemporaryDirectory() as made:
        where = _folder(Path(made), name, folder, half=round(duration_s / 2.0 / _SAMPLE_S))
        for chosen in _one_by_one(benchmark):
            plant = _plant(benchmark, chosen, name)
            path = where / "check.yaml"
            path.write_text(canonical_text(_campaign(name, plant, chosen, duration_s)), encoding="utf-8")
            _fly(path, chosen)


def _plant(benchmark: Benchmark, chosen: dict[str, str], name: str) -> Plant:
    """What flies with these choices; whatever is chosen may bring its own parameters, sites and manoeuvres."""
    members = {key: benchmark.choices[key].options[option] for key, option in chosen.items()}
    plant = benchmark.plant({**default_choices(benchmark), **members})
    for parameter in plant.parameters:
        inside = parameter.low <= parameter.default <= parameter.high
        require(inside, f"the default of {parameter.name}, {parameter.default:g}, is outside of its own limits")
    require(plant.sites, f"benchmark {name!r} has no fault site")
    return plant


def _folder(made: Path, name: str, beside: Path, *, half: int) -> Path:
    """Folder with the detectors of the check, and with the files of the benchmark if it stands in one."""
    for file, content in kinds.find("benchmark", name, beside=beside).files.items():
        (made / file).parent.mkdir(parents=True, exist_ok=True)
        (made / file).write_bytes(content)
    (made / "detectors").mkdir()
    (made / "detectors" / "watcher.py").write_text(_WATCHER, encoding="utf-8")
    gains = {"watcher: Watcher": "", "silent: Declarer": f"first: {_NEVER}", "declarer: Declarer": f"first: {half}"}
    for design, numbers in gains.items():
        file, member = design.split(": ")
        text = f"kind: watcher.py:{member}\nsource: none\ntuned_on: null\ngains: {{{numbers}}}\n"
        (made / "detectors" / f"{file}.yaml").write_text(text, encoding="utf-8")
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
        "name": "check", "benchmark": name, "seed": 1, "sample_s": _SAMPLE_S, "duration_s": duration_s,
        "detectors": ["watcher"], **chosen,
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
    if getattr(loop, "reconfigures", False):
        _require_reconfigures(path, batch.cases, recorded, what)


def _require_reconfigures(path: Path, cases: Cases, recorded: list[str], what: str) -> None:
    """A loop that is told of no declaration flies as one that is told nothing; one that is told flies alike everywhere."""
    idle, silent, acting = (
        assemble(read_campaign(path, changes))
        for changes in ([], *([f"detectors=[{name}]", f"reconfigure={name}"] for name in ("silent", "declarer")))
    )
    told, untold = (flown(assembly, assembly.batch(cases), recorded).recorded for assembly in (silent, idle))
    for signal, rows in untold.items():
        same = rows.tobytes() == told[signal].tobytes()
        require(
            same, f"with {what}: {signal} differs between declared=None and rows of zeros; nothing is declared in both"
        )
    wrong = different_bits(acting, acting.batch(cases), recorded)
    require(not wrong, f"with {what}, everything declared: {wrong}")


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
