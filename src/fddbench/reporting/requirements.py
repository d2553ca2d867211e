"""Judged requirements as plain text, as Markdown for the summary of a job, and as JUnit XML for a server that builds."""

from collections import Counter
from collections.abc import Callable, Sequence
from math import ceil, floor, isinf
from textwrap import fill
from xml.etree import ElementTree

from fddbench.metrics.requirements import Judgement
from fddbench.reporting.formats import DASH, count, rate

__all__ = ["evidence_text", "interval_text", "needed_text", "to_junit", "to_summary", "to_text", "value_text"]

_WIDTH = 80
_WORDS = {"pass": "PASS", "fail": "FAIL", "undecided": "UNDECIDED"}


def value_text(one: Judgement) -> str:
    """The value with its unit, to the digits that tell it from its limit: ``99.27 %``, ``0.12 per hour``."""
    return DASH if one.value is None else f"{_number(one, one.value)} {_unit(one)}"


def interval_text(one: Judgement) -> str:
    """Its interval, ``[98.3, 99.8]``, rounded outwards; no upper end is a dash."""
    return f"[{_end(one, one.low, floor)}, {DASH if isinf(one.high) else _end(one, one.high, ceil)}]"


def needed_text(one: Judgement) -> str:
    """What a decision would take, in words; empty where it is decided."""
    if one.verdict != "undecided":
        return ""
    if one.value is None:
        return "no flight that counts" if one.runs_used else "no run is whole yet"
    if one.runs_needed is None or one.flights_needed is None:
        return "at this rate no number of flights decides: it lies on the limit"
    runs = f"run{'' if one.runs_needed == 1 else 's'}"
    return f"about {count(one.runs_needed)} more {runs} ({count(one.flights_needed)} flights) at this rate"


def evidence_text(one: Judgement) -> str:
    """Value, interval and runs in a line."""
    planned = f" of {count(one.runs_planned)}" if one.runs_used < one.runs_planned else ""
    parts = [f"{value_text(one)} {interval_text(one)}, {count(one.runs_used)}{planned} runs"]
    if one.decided_at is not None:
        parts.append(f"decided after {count(one.decided_at)}")
    parts += filter(None, [needed_text(one)])
    if one.failed:
        parts.append(f"{count(one.failed)} flights failed")
    if one.in_sample:
        parts.append("in sample")
    return ", ".join(parts)


def to_text(judgements: Sequence[Judgement]) -> str:
    """Each requirement with a line, or two, for every detector that it is on; 80 columns."""
    lines = [f"Requirements, each verdict at any look{_each(judgements)}"]
    for called in dict.fromkeys(map(_called, judgements)):
        lines.append(fill(called, _WIDTH, subsequent_indent="  "))
        for one in judgements:
            if _called(one) == called:
                first, text = f"  {_WORDS[one.verdict]:<10} ", f"{one.detector}: {evidence_text(one)}"
                lines.append(fill(text, _WIDTH, initial_indent=first, subsequent_indent=" " * 15))
    return "\n".join(lines)


def to_summary(judgements: Sequence[Judgement], campaign: str) -> str:
    """Markdown: how many pass, and a table."""
    counts = Counter(one.verdict for one in judgements)
    told = ", ".join(f"{counts[verdict]} {verdict}" for verdict in _WORDS if counts[verdict])
    heads = ("verdict", "requirement", "detector", "value", "interval", "runs", "a decision would take")
    rows = [
        (
            f"**{one.verdict}**" if one.verdict != "pass" else one.verdict, _called(one), one.detector, value_text(one),
            interval_text(one), count(one.runs_used), needed_text(one),
        )
        for one in judgements
    ]  # fmt: skip
    table = [heads, ("---",) * len(heads), *rows]
    body = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in table]
    return "\n".join(
        [f"### {campaign}: {told}", "", *body, "", f"Each verdict holds at any look{_each(judgements)}.", ""]
    )


def to_junit(judgements: Sequence[Judgement], campaign: str) -> bytes:
    """JUnit XML: a test case for each requirement and detector; what fails or is undecided is a failure of that type."""
    missed = sum(one.verdict != "pass" for one in judgements)
    root = ElementTree.Element("testsuites", tests=str(len(judgements)), failures=str(missed), errors="0")
    suite = ElementTree.SubElement(
        root, "testsuite", name=f"fddbench.{campaign}", tests=str(len(judgements)), failures=str(missed), errors="0",
        skipped="0",
    )  # fmt: skip
    for one in judgements:
        case = ElementTree.SubElement(
            suite, "testcase", classname=f"{campaign}.{one.detector}", name=_called(one), time="0"
        )
        text = evidence_text(one)
        if one.verdict != "pass":
            found = ElementTree.SubElement(case, "failure", type=one.verdict, message=f"{one.verdict}: {text}")
            found.text = f"{_called(one)}: {one.detector}\n{text}\nscenarios: {', '.join(one.scenarios)}"
        else:
            ElementTree.SubElement(case, "system-out").text = text
    ElementTree.indent(root)
    written: bytes = ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
    return written + b"\n"


def _called(one: Judgement) -> str:
    return f"{one.name} ({one.group})" if one.group else one.name


def _each(judgements: Sequence[Judgement]) -> str:
    levels = sorted({one.confidence for one in judgements})
    return f", at {' and '.join(f'{100 * level:g} %' for level in levels)} confidence"


def _unit(one: Judgement) -> str:
    return "per hour" if one.of == "false_alarms_per_hour" else "%"


def _end(one: Judgement, value: float, outwards: Callable[[float], int]) -> str:
    """An end of the interval, never inside of it."""
    if one.of == "false_alarms_per_hour":
        return rate(value)
    digits = _digits(one)
    text = f"{outwards(round(100 * value * 10**digits, 6)) / 10**digits:.{digits}f}"
    return text.removesuffix("." + "0" * digits) if float(text) in (0.0, 100.0) else text


def _digits(one: Judgement) -> int:
    """Digits of a share in percent: one more than its limit has."""
    return max(1, len(f"{100 * one.limit:.10g}".partition(".")[2]) + 1)


def _number(one: Judgement, value: float) -> str:
    """A rate with three digits, a share in percent; never rounded to 0 or 100."""
    if one.of == "false_alarms_per_hour":
        return rate(value)
    digits = _digits(one)
    while 0.0 < value < 1.0 and digits < 9 and float(f"{100 * value:.{digits}f}") in (0.0, 100.0):
        digits += 1
    return f"{100 * value:.{digits}f}" if 0.0 < value < 1.0 else f"{100 * value:.0f}"
