"""The summary as a paper prints it: LaTeX, Markdown, HTML."""

from collections.abc import Sequence
from typing import Any

import pandas as pd

from fddbench.reporting.formats import count, interval, percent, present, seconds

__all__ = ["paper_table", "to_html", "to_latex", "to_markdown"]


def paper_table(summary: pd.DataFrame, by: Sequence[str] = ()) -> pd.DataFrame:
    """Text of a summary: scenario, detector, flights, right and healthy sites declared with intervals, times, false alarms.

    Of healthy flights right is the share that stayed quiet, without an interval of its own: false alarms have one.
    """
    return pd.DataFrame([_line(line, by) for line in summary.to_dict("records")])


def _line(line: dict[Any, Any], by: Sequence[str]) -> dict[str, str]:
    return {
        "scenario": str(line["scenario"]),
        **{name: _value(line[name]) for name in by},
        "detector": str(line["detector"]) + (" (in sample)" if line["in_sample"] else ""),
        "flights": count(line["flown"]),
        "right [%]": _share(line, "right"),
        "wrong site [%]": _share(line, "wrong_site"),
        "late": count(line["late"]),
        "missed": count(line["missed"]),
        "undecided": count(line["undecided"]),
        "false alarms [%]": _share(line, "alarms"),
        "median [s]": seconds(line["detection_time_median_s"]),
        "maximum [s]": seconds(line["detection_time_max_s"]),
    }


def _value(value: Any) -> str:
    """What a line is split by."""
    if not present(value):
        return "–"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _share(line: dict[Any, Any], name: str) -> str:
    ends = interval(line[f"{name}_low_percent"], line[f"{name}_high_percent"])
    value = line[f"{name}_percent"]
    return percent(value) + (f" ({ends})" if ends else "") if present(value) else percent(None)


def to_latex(table: pd.DataFrame) -> str:
    r"""A tabular environment, with booktabs; underscores and percent signs are escaped, the dots of an interval are words.

    >>> print(to_latex(pd.DataFrame({"a_b [%]": ["1.0 (0.5 … 2.0)"]})).splitlines()[2])
    a\_b [\%] \\
    """
    plain = table.map(lambda text: text.replace(" … ", "--").replace("\u202f", r"\,").replace("–", "--"))
    text: str = plain.to_latex(index=False, escape=False)
    return _escaped(text)


def _escaped(text: str) -> str:
    for sign, escaped in (("_", r"\_"), ("%", r"\%"), ("<", "$<$"), (">", "$>$")):
        text = text.replace(sign, escaped)
    return text


def to_markdown(table: pd.DataFrame) -> str:
    """A table of GitHub's Markdown; numbers to the right."""
    names = [str(name) for name in table.columns]
    words = {"scenario", "detector"}
    rule = ["---" if name in words else "---:" for name in names]
    rows = [names, rule, *([str(cell).replace("|", r"\|") for cell in row] for row in table.itertuples(index=False))]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def to_html(table: pd.DataFrame) -> str:
    """A table element; what is in it stays text."""
    text: str = table.to_html(index=False, escape=True, border=0)
    return text + "\n"
