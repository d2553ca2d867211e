"""What a campaign would do, in words and numbers, before it burns an hour of two processors."""

from collections.abc import Iterator, Sequence
from math import ceil
from textwrap import fill
from typing import Any

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan, PlannedScenario
from fddbench.campaign.rules.dispersions import Dispersions, Distribution
from fddbench.campaign.rules.required import name_of
from fddbench.campaign.variation import at_levels
from fddbench.designs.design import Design
from fddbench.faults.specification import FaultSpecification
from fddbench.faults.timing import latest_onset_s
from fddbench.faults.varied import Varied, in_words

__all__ = ["describe", "duration", "estimated_seconds"]

_BYTES_PER_ROW = 60
_BYTES_PER_FOLDER = 200_000
_WIDTH = 100
_SECONDS = ((86_400.0, "d"), (3600.0, "h"), (60.0, "min"))
_COMMON = frozenset({"kind", "mode", "sites", "onset_s", "end_s", "correlation", "delay_s"})


def estimated_seconds(
    plan: Plan, *, seconds_per_flight_step: float = 1e-6, overhead_s: float = 1e-3, chunk: int = 256, jobs: int = 2
) -> float:
    """Wall time of a campaign [s], without start-up.

    Parameters
    ----------
    seconds_per_flight_step : float
        Processor time per sample of one flight [s]; the NumPy path does a million a second.
    overhead_s : float
        Processor time per sample of a chunk, whatever its size [s].
    chunk, jobs : int
        Flights stepped together, and processes.
    """
    busy = sum(
        mean * (scenario.n_cases * seconds_per_flight_step + ceil(scenario.n_cases / chunk) * overhead_s)
        for scenario in plan.scenarios
        for mean in [sum(scenario.samples) / len(scenario.samples)]
    )
    return busy / jobs


def describe(
    plan: Plan,
    *,
    seconds_per_flight_step: float = 1e-6,
    overhead_s: float = 1e-3,
    chunk: int = 256,
    jobs: int = 2,
    notes: Sequence[str] = (),
) -> str:
    """Text of what would run: the question, the scenarios, the dispersions, the designs, notes on them, and the bill."""
    seconds = estimated_seconds(
        plan, seconds_per_flight_step=seconds_per_flight_step, overhead_s=overhead_s, chunk=chunk, jobs=jobs
    )
    told = [fill(note, _WIDTH, initial_indent="  ", subsequent_indent="    ") for note in notes]
    parts = [
        *_head(plan.campaign),
        "",
        *_table(plan),
        "",
        *_logs(plan),
        *_rest(plan),
        *told,
        "",
        *_bill(plan, seconds, jobs),
    ]
    return "\n".join(parts)


def _head(campaign: Campaign) -> Iterator[str]:
    yield f"Campaign {campaign.name} ({campaign.path})"
    if campaign.about:
        yield fill(" ".join(campaign.about.split()), _WIDTH, initial_indent="  ", subsequent_indent="  ")
    choices = [f"{key} {name}" for key, name in campaign.choices.items()]
    yield ", ".join([f"Benchmark {campaign.benchmark}", *choices])
    substeps = f", {campaign.substeps} integration steps each" if campaign.substeps > 1 else ""
    yield f"Purpose {campaign.purpose}, seed {campaign.seed}, sample {campaign.sample_s:g} s{substeps}"
    if campaign.reconfigure:
        yield f"The aircraft acts on what {campaign.reconfigure} declares, from the next sample on"


def _table(plan: Plan) -> Iterator[str]:
    lines = [("scenario", "manoeuvre", "flights", "length", "limit", "faults")]
    lines += [_line(scenario) for scenario in plan.scenarios]
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    for line in lines:
        name, manoeuvre, *numbers, faults = line
        cells = [name.ljust(widths[0]), manoeuvre.ljust(widths[1])]
        cells += [text.rjust(width) for text, width in zip(numbers, widths[2:5], strict=True)]
        yield "  " + "  ".join([*cells, faults]).rstrip()
    short = [scenario.name for scenario in plan.scenarios if _ends_before_limit(scenario, plan.campaign.sample_s)]
    if short:
        text = f"Faults not found are undecided, not missed, where the flight ends before its limit: {', '.join(short)}"
        yield fill(text, _WIDTH)
    apart = [scenario.name for scenario in plan.scenarios if _begin_apart(scenario)]
    if apart:
        text = (
            "Faults begin at different times: the rows count from the first onset to all sites declared, the events each "
            f"fault from its own onset: {', '.join(apart)}"
        )
        yield fill(text, _WIDTH)


def _logs(plan: Plan) -> Iterator[str]:
    """What there is to say of logs, where some are flown."""
    notes: Any = getattr(plan.plant, "notes", None)
    if notes is not None:
        yield "Logs"
        for name, said in notes(plan.campaign.sample_s).items():
            yield fill(f"{name}: {said}", _WIDTH, initial_indent="  ", subsequent_indent="    ")
        yield from _unflown(plan)


def _unflown(plan: Plan) -> Iterator[str]:
    """Logs that no case flies."""
    parameter, given = plan.plant.parameters[0], plan.campaign.dispersions
    flown = {*given.grid.get("log", ()), *given.sequence.get("log", ()), *plan.campaign.table.get("log", ())} or {1.0}
    left = [number for number in range(1, int(parameter.high) + 1) if number not in flown]
    if left:
        every = list(range(1, int(parameter.high) + 1))
        yield f"  not flown: {', '.join(map(str, left))}; every log is with `dispersions: {{grid: {{log: {every}}}}}`"


def _begin_apart(scenario: PlannedScenario) -> bool:
    onsets = [fault.onset_s for fault in scenario.faults]
    return len(onsets) > 1 and (len(set(onsets)) > 1 or isinstance(onsets[0], Varied))


def _ends_before_limit(scenario: PlannedScenario, sample_s: float) -> bool:
    if scenario.requirement_s is None:
        return False
    ends = zip(at_levels(scenario.faults), scenario.samples, strict=True)
    return any(
        (n_samples - 1) * sample_s - max(map(latest_onset_s, faults)) < scenario.requirement_s - sample_s / 2.0
        for faults, n_samples in ends
    )


def _line(scenario: PlannedScenario) -> tuple[str, str, str, str, str, str]:
    faults = "; ".join(map(_fault, scenario.faults)) or "none"
    return scenario.name, scenario.manoeuvre, f"{scenario.n_cases:,}", _length(scenario), _limit(scenario), faults


def _length(scenario: PlannedScenario) -> str:
    ends = sorted({scenario.durations_s[0], min(scenario.durations_s), max(scenario.durations_s)})
    return " to ".join(f"{end_s:g}" for end_s in (ends[0], ends[-1])[: len(ends)]) + " s"


def _limit(scenario: PlannedScenario) -> str:
    """Time from the first onset within which all must be found; from the last one where the onsets vary."""
    if scenario.requirement_s is None:
        return "-"
    if any(isinstance(time_s, Varied) for fault in scenario.faults for time_s in (fault.onset_s, fault.delay_s)):
        return f"{scenario.requirement_s:g} s"
    apart = max(map(latest_onset_s, scenario.faults)) - min(fault.onset_s for fault in scenario.faults)
    return f"{round(apart, 9) + scenario.requirement_s:g} s"


def _fault(fault: FaultSpecification) -> str:
    fields = [name for name in type(fault).model_fields if name not in _COMMON]
    given = [(fault.key(name), getattr(fault, name), type(fault).model_fields[name].default) for name in fields]
    words = [fault.kind, *(f"{key}={_short(value)}" for key, value, default in given if value != default)]
    words += [fault.mode] if fault.mode != "add" else []
    words += [f"on {'+'.join(fault.sites)} at {in_words(fault.onset_s)} s"]
    words += [fault.correlation] if len(fault.sites) > 1 else []
    words += [f"delayed by {in_words(fault.delay_s)} s"] if fault.delay_s else []
    words += [f"until {in_words(fault.end_s)} s"] if fault.end_s is not None else []
    return " ".join(words)


def _short(value: Any) -> str:
    text = in_words(value)
    return f"({text})" if " " in text else text


def _rest(plan: Plan) -> Iterator[str]:
    yield from _dispersions(plan.campaign.dispersions)
    yield "Detectors"
    for name in dict.fromkeys(design.base for design in plan.campaign.designs):
        yield from _design([design for design in plan.campaign.designs if design.base == name])
    if plan.campaign.requirements:
        few = "" if plan.n_kept == plan.n_rows else f" by the first {plan.campaign.kept_runs} runs"
        yield f"Required of them, judged after the run{few}"
    for entry in plan.campaign.requirements:
        who = f": {', '.join(entry.detectors)}" if entry.detectors else ""
        yield f"  {name_of(entry)}{who}, at {100 * entry.confidence:g} % confidence"


def _dispersions(dispersions: Dispersions) -> Iterator[str]:
    parts = [f"grid of {name}: {_values(values)}" for name, values in sorted(dispersions.grid.items())]
    parts += [f"in sequence {name}: {_values(values)}" for name, values in dispersions.sequence.items()]
    if dispersions.monte_carlo:
        drawn = dispersions.monte_carlo
        how = {"random": "", "lhs": ", a Latin hypercube"}.get(
            drawn.sampling, f", points of {drawn.sampling.capitalize()}"
        )
        rows = f", rows of {drawn.table}" if drawn.table else ""
        parts += [f"{drawn.runs:,} Monte-Carlo runs{how}{rows}"]
        parts += [f"correlation {value:g} of {one} and {other}" for one, other, value in drawn.correlation]
        parts += [f"{name} {_distribution(value)}" for name, value in drawn.parameters.items()]
    yield "Dispersed" if parts else "No dispersions: every flight has the benchmark's default parameters"
    yield from (f"  {part}" for part in parts)


def _values(values: tuple[float, ...]) -> str:
    few = values if len(values) <= 6 else values[:3]
    return ", ".join(f"{value:g}" for value in few) + ("" if few is values else f", … {values[-1]:g} ({len(values)})")


def _distribution(distribution: Distribution) -> str:
    if distribution.uniform is not None:
        return "uniform in {:g} to {:g}".format(*distribution.uniform)
    window = distribution.truncated_normal
    bell = window or distribution.normal
    assert bell is not None
    edges = f", within {window.low:g} to {window.high:g}" if window else ""
    return f"normal, mean {bell.mean:g}, std {bell.std:g}{edges}"


def _design(variants: Sequence[Design]) -> Iterator[str]:
    """A design, and what of it is swept."""
    design = variants[0]
    seen = ", ".join(f"{entry.campaign} seed {entry.seed}" for entry in design.tuned_on) or "no campaign"
    every = f", a step every {design.every} samples" if design.every > 1 else ""
    text = f"{design.base} ({design.kind.name}{every}): {' '.join(design.source.split()).rstrip('.')}; tuned on {seen}"
    yield fill(text, _WIDTH, initial_indent="  ", subsequent_indent="    ")
    gains = [each.swept for each in variants if each.swept]
    for column in dict.fromkeys(gain.column for gain in gains):
        swept = [gain for gain in gains if gain.column == column]
        said = f"{swept[0].key} {'×' if swept[0].factor else '='} {_values(tuple(gain.value for gain in swept))}"
        yield f"    swept, a detector a value: {said}"
    if gains and len(gains) < len(variants):
        yield "    and as the design says"


def _bill(plan: Plan, seconds: float, jobs: int) -> Iterator[str]:
    n = len(plan.campaign.designs)
    flown = sum(scenario.flown_s for scenario in plan.scenarios)
    disk = plan.n_kept * _BYTES_PER_ROW + _BYTES_PER_FOLDER
    rows = f"{plan.n_cases:,} cases x {n} detector{'s' if n > 1 else ''} = {plan.n_rows:,} rows"
    yield f"{rows}, {flown / 3600:.4g} h of flight"
    if plan.n_kept < plan.n_rows:
        more = "those that fail" if plan.campaign.keep == "failures" else "those that end in an error"
        first = f"those of the first {plan.campaign.kept_runs} runs"
        yield f"All rows are counted; kept are {plan.n_kept:,}, {first}, and of others {more}"
    elif plan.campaign.keep != "all":
        yield f"All rows are kept: no scenario has more runs than kept_runs, {plan.campaign.kept_runs}"
    yield f"About {duration(seconds)} with {jobs} jobs, and {_size(disk)} on disk"


def duration(seconds: float) -> str:
    """Seconds in words, in the unit that suits: ``"26 s"``, ``"1.5 h"``."""
    for length, unit in _SECONDS:
        if seconds >= length:
            return f"{seconds / length:.2g} {unit}"
    return f"{max(seconds, 1.0):.0f} s"


def _size(n_bytes: float) -> str:
    return f"{n_bytes / 1e9:.1f} GB" if n_bytes >= 1e9 else f"{n_bytes / 1e6:.1f} MB"
