"""JSON schemas of campaigns and designs, and the line by which a file names its schema to an editor."""

import json
from pathlib import Path
from typing import Any

from fddbench import kinds
from fddbench.api.asking import fitting_designs
from fddbench.campaign.schema.anywhere import campaign_schema
from fddbench.campaign.schema.designs import design_schema
from fddbench.campaign.schema.on_benchmark import benchmark_schema
from fddbench.errors import FddbenchError, did_you_mean, reason_of
from fddbench.interfaces import Benchmark, Options
from fddbench.interfaces.benchmark import default_choices

__all__ = ["HEADER", "schema", "schema_text"]

HEADER = "# yaml-language-server: $schema="
"""What an editor reads in a comment of a YAML file: the path of its schema, from the file."""


def schema(subject: str = "", folder: str | Path = ".") -> dict[str, Any]:
    """JSON schema (2020-12) of the campaigns on a benchmark, of those on any, or of designs.

    Parameters
    ----------
    subject : str
        Name of a benchmark, or a file of one's own, ``mine.py:Mine``; "designs"; "" for campaigns on any benchmark.
    folder : str or Path
        Where a file of one's own lies.

    Raises
    ------
    fddbench.errors.FddbenchError
        There is no such benchmark, or it cannot be used.

    Examples
    --------
    >>> schema("jet_engine")["properties"]["plant"]["anyOf"][0]["const"]
    'norm_bounded'
    """
    if not subject:
        return campaign_schema()
    if subject == "designs":
        return design_schema()
    if subject not in kinds.known("benchmark") and not kinds.is_file_kind(subject):
        known = [*kinds.known("benchmark"), "designs"]
        words = ["there is no schema of", f"{subject!r}.", did_you_mean(subject, known), f"Known: {', '.join(known)}"]
        raise FddbenchError(" ".join(filter(None, words)))
    try:
        return _of_benchmark(kinds.find("benchmark", subject, beside=Path(folder)).member(), subject)
    except FddbenchError:
        raise
    except (Exception, SystemExit) as error:  # a benchmark of somebody else's may raise anything
        raise FddbenchError(f"the benchmark {subject!r} cannot be used: {reason_of(error)}") from error


def _of_benchmark(benchmark: Benchmark, called: str) -> dict[str, Any]:
    """Schema of a benchmark with the shipped designs that fit any of its plants."""
    designs: dict[str, None] = {}
    chosen = default_choices(benchmark)
    for plant in benchmark.choices["plant"].options.values() if "plant" in benchmark.choices else [None]:
        own = chosen if plant is None else {**chosen, "plant": plant}
        designs |= dict.fromkeys(fitting_designs(benchmark.loop(Options(chosen=own))))
    return benchmark_schema(benchmark, called=called, designs=sorted(designs))


def schema_text(subject: str = "", folder: str | Path = ".") -> str:
    """`schema` as the text of a file: an entry a line down to the definitions, so that differences can be read."""
    found = schema(subject, folder)
    definitions = found.pop("$defs", {})
    lines = [f" {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}" for key, value in found.items()]
    inner = [f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}" for key, value in definitions.items()]
    lines.append(' "$defs": {\n' + ",\n".join(inner) + "\n }")
    return "{\n" + ",\n".join(lines) + "\n}\n"
