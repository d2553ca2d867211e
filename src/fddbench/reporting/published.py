"""The printed tables of the papers, read from ``reports/published/``, to stand beside our own results."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import yaml

from fddbench import gallery
from fddbench.errors import FddbenchError, did_you_mean

__all__ = ["Iterations", "Published", "PublishedRow", "iterations_for", "published", "published_for"]


@dataclass(frozen=True, kw_only=True)
class PublishedRow:
    """One printed line.

    Attributes
    ----------
    variant, scenario, manoeuvre : str
        Which column or half of the table, the scenario's name as in campaigns, what was flown ("": cruise).
    n_faulty : int
        Faulty sites.
    onset_s : float or None
        Failure time [s]; None: healthy.
    true_detection_percent : float
        As printed [%].
    normalized_detection_time : float or None
        As printed [-]; None: healthy.
    detection_time_limit_s, detection_time_samples : float, int or None
        Inferred from the printed ratio; None: healthy.
    """

    variant: str
    scenario: str
    manoeuvre: str = ""
    n_faulty: int
    onset_s: float | None = None
    true_detection_percent: float
    normalized_detection_time: float | None = None
    detection_time_limit_s: float | None = None
    detection_time_samples: int | None = None
    amplitude_percent: float | None = None
    rate_percent_s: float | None = None
    variance_percent: float | None = None


@dataclass(frozen=True, kw_only=True)
class Published:
    """A printed table: where it stands, what in it is inferred, its variants by name and its rows."""

    table: int
    title: str
    source: str
    note: str
    printed: tuple[str, ...]
    inferred: tuple[str, ...]
    sample_s: float
    variants: Mapping[str, str]
    rows: tuple[PublishedRow, ...]

    def row(self, variant: str, scenario: str) -> PublishedRow | None:
        """Return the printed row of a scenario that has a detection time, None without one."""
        for row in self.rows:
            if row.variant == variant and row.scenario == scenario and row.detection_time_samples is not None:
                return row
        return None

    def named(self, scenarios: Collection[str]) -> dict[str, PublishedRow]:
        """Printed rows by the scenario that says in its own name which row it is.

        ``jam_a_onset_4_s`` is the row of ``jam_a`` in the variant ``onset_4_s``, ``healthy_nose_up`` the first fault-free one
        of the manoeuvre ``nose_up``.
        """
        found: dict[str, PublishedRow] = {}
        for row in self.rows:
            name = f"{row.scenario}_{row.variant}" if row.n_faulty else f"healthy_{row.manoeuvre}"
            if name in scenarios:
                found.setdefault(name, row)
        return found


def published(table: str) -> Published:
    """Read a printed table by the name of its file, e.g. ``"table8"``.

    Raises
    ------
    FddbenchError
        There is no such table.

    Examples
    --------
    >>> published("table8").row("simulink", "jam_a").detection_time_samples
    100
    """
    folder = gallery.folder("reports") / "published"
    known = sorted(path.stem for path in folder.glob("table*.yaml"))
    if table not in known:
        near = did_you_mean(table, known)
        raise FddbenchError(f"no published table is called {table!r}. {near}\nKnown: {', '.join(known) or 'none'}.")
    content = yaml.safe_load((folder / f"{table}.yaml").read_text(encoding="utf-8"))
    rows = tuple(PublishedRow(**row) for row in content.pop("rows"))
    printed, inferred = tuple(content.pop("printed")), tuple(content.pop("inferred"))
    return Published(**content, printed=printed, inferred=inferred, rows=rows)


def published_for(campaign: Mapping[str, Any], default: str = "") -> tuple[Published, ...]:
    """Tables that a campaign names under ``report: {published: [...]}``, else the default of its benchmark, else none."""
    named = (campaign.get("report") or {}).get("published") or ([default] if default else [])
    return tuple(published(table) for table in named)


@dataclass(frozen=True, kw_only=True)
class Iterations:
    """A printed table of an optimisation's course: title, source, what to say of it, and rows of one number each.

    Attributes
    ----------
    runs : mapping of str to mapping of int to float
        By whose run it is, the value after so many iterations.
    findings : tuple of mapping
        What stands beside it: a line of text and its value.
    """

    table: int
    title: str
    source: str
    note: str
    runs: Mapping[str, Mapping[int, float]]
    findings: tuple[Mapping[str, Any], ...]


def iterations_for(name: str) -> Iterations | None:
    """Course of the optimisation behind the designs of a benchmark by the name of its file, None for ""."""
    if not name:
        return None
    path = gallery.folder("reports") / "published" / f"{name}.yaml"
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    return Iterations(**{**content, "findings": tuple(content["findings"])})
