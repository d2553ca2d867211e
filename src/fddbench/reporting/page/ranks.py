"""The ranking as cells of a table."""

from collections.abc import Sequence

from fddbench.reporting.formats import DASH, count, interval, percent
from fddbench.reporting.page.ranking import Rank
from fddbench.reporting.tables import Cell

__all__ = ["rank_lines", "silence"]


def rank_lines(ranks: Sequence[Rank]) -> list[tuple[int, str, str, list[Cell]]]:
    """Number, name, notes and cells of each detector, best first."""
    return [(line.number, line.detector, _notes(line), _cells(line)) for line in ranks]


def silence(ranks: Sequence[Rank]) -> str:
    """What no false alarm leaves open, in the numbers of the first detector that has none; "" where none has none."""
    quiet = [line for line in ranks if line.distinct_flights and not line.alarms]
    if not quiet:
        return ""
    line = quiet[0]
    flights = f"none in {count(line.distinct_flights)} flight{'' if line.distinct_flights == 1 else 's'}"
    if line.alarms_high_percent is None:
        return f"{flights} of one run leaves everything open"
    by_run, units = (
        ("", line.distinct_flights)
        if line.runs == line.distinct_flights
        else (f" of {count(line.runs)} runs", line.runs)
    )
    many = f"about {line.alarms_high_percent * units / 100.0:.1f} in as many"
    why = f"{many} runs, for flights of one run are one witness" if by_run else many
    return f"{flights}{by_run} leaves up to {percent(line.alarms_high_percent)} % ({why})"


def _notes(line: Rank) -> str:
    marks = ("in sample" if line.in_sample else "", "sees the voted signal" if line.voted else "")
    return ", ".join(filter(None, marks))


def _cells(line: Rank) -> list[Cell]:
    if not line.faulty:
        return [*[Cell(DASH)] * 4, _alarms(line), Cell(DASH)]
    of = f"of {count(line.decided)}"
    wrong = line.outcomes.get("wrong_site", 0)
    slow = line.outcomes.get("late", 0) + line.outcomes.get("missed", 0)
    parts = [f"{count(line.outcomes[name])} {name}" for name in ("late", "missed") if line.outcomes.get(name)]
    worst = line.weakest
    return [
        _right(line),
        Cell(count(wrong), of, alarm=wrong > 0) if line.names_sites else Cell(DASH, "names no site"),
        Cell(count(slow), ", ".join(parts) if len(parts) > 1 else of, alarm=slow > 0),
        Cell(count(line.undecided), f"of {count(line.faulty)}" if line.undecided else ""),
        _alarms(line),
        Cell(
            worst.scenario,
            f"{count(worst.failed)} of {count(worst.decided)} failed{f', {worst.also} more' if worst.also else ''}",
        )
        if worst
        else Cell("none failed"),
    ]


def _right(line: Rank) -> Cell:
    of = line.right
    if of.share is None:
        return Cell(DASH, "none decided")
    ends = interval(100.0 * of.low, 100.0 * of.high) if of.low is not None and of.high is not None else "no interval"
    return Cell(f"{percent(100.0 * of.share)} %", f"{ends}, {count(of.runs)} run{'' if of.runs == 1 else 's'}")


def _alarms(line: Rank) -> Cell:
    if not line.distinct_flights:
        return Cell(DASH, "no score" if line.lost else "no healthy stretch")
    high = f", ≤ {percent(line.alarms_high_percent)} %" if line.alarms_high_percent is not None else ""
    runs = f" of {count(line.runs)} run{'' if line.runs == 1 else 's'}" if line.runs != line.distinct_flights else ""
    flights = f"of {count(line.distinct_flights)} flight{'' if line.distinct_flights == 1 else 's'}"
    return Cell(count(line.alarms), f"{flights}{runs}{high}", alarm=line.alarms > 0)
