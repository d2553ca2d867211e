"""Requirements of a campaign: what is wrong with them, and which scenarios and detectors each is on."""

from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase

from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.dispersions import Dispersions
from fddbench.campaign.rules.model import CampaignFile, RequirementEntry
from fddbench.errors import Mistake, did_you_mean
from fddbench.metrics.requirements import AT_LEAST, OF_FAULTS

__all__ = ["chosen", "name_of", "requirement_mistakes"]

_SHARES = (*AT_LEAST, "wrong_site_share", "false_alarm_share")


def requirement_mistakes(document: Document, written: CampaignFile, faulty: Sequence[bool]) -> Iterator[Mistake]:
    """Everything that cannot be judged; `faulty` says of each scenario whether it has faults."""
    names: set[str] = set()
    for number, entry in enumerate(written.requirements):
        at: Address = ("requirements", number)
        yield from _limits(document, at, entry)
        yield from _scenarios(document, at, entry, {s.name: f for s, f in zip(written.scenarios, faulty, strict=True)})
        yield from _matched(document, (*at, "detectors"), entry.detectors, written.detector_names, "detector")
        yield from _parts(document, at, entry, written.dispersions)
        yield from _runs(document, at, entry, written)
        name = name_of(entry)
        if name in names:
            yield document.mistake(at, f"a second requirement called {name!r}; give one of them a name of its own")
        names.add(name)


def chosen(patterns: Sequence[str], known: Sequence[str]) -> tuple[str, ...]:
    """Names that one of the patterns fits, all without a pattern, in their order.

    >>> chosen(["jam_*"], ["healthy", "jam_a", "jam_b"])
    ('jam_a', 'jam_b')
    """
    return tuple(name for name in known if not patterns or any(fnmatchcase(name, pattern) for pattern in patterns))


def name_of(entry: RequirementEntry) -> str:
    """Name of a requirement: its own, or what it is of, how much and where."""
    if entry.name is not None:
        return entry.name
    words: list[str] = [entry.of]
    words += [f"at least {entry.at_least:g}"] if entry.at_least is not None else []
    words += [f"at most {entry.at_most:g}"] if entry.at_most is not None else []
    words += [f"in {entry.share:g}"] if entry.share is not None else []
    words += [f"of {', '.join(entry.scenarios)}"] if entry.scenarios else []
    words += [f"per {entry.per}"] if entry.per is not None else []
    return " ".join(words)


def _limits(document: Document, at: Address, entry: RequirementEntry) -> Iterator[Mistake]:
    """The number that is required, under the key that suits the measure."""
    needed, other = ("at_least", "at_most") if entry.of == "right_share" else ("at_most", "at_least")
    limit = getattr(entry, needed)
    if getattr(entry, other) is not None:
        yield document.mistake((*at, other), f"{entry.of} is required with `{needed}:`, not `{other}:`", key=True)
    elif limit is None:
        yield document.mistake(at, f"{entry.of} needs a limit; write `{needed}:`")
    elif entry.of in _SHARES and entry.of != "normalized_detection_time" and not 0.0 < limit < 1.0:
        message = (
            f"a share between 0 and 1, both excluded, got {limit:g}. Write 98 % as 0.98; that it is exactly 0 or 1 no number "
            "of flights can show"
        )
        yield document.mistake((*at, needed), message)
    elif limit <= 0.0:
        yield document.mistake((*at, needed), f"must be > 0, got {limit:g}; that it is 0 no number of flights can show")
    timed = entry.of == "normalized_detection_time"
    if timed and entry.share is None:
        message = "a time is kept by a share of the flights; write which, `share: 0.95`"
        yield document.mistake(at, message)
    elif not timed and entry.share is not None:
        yield document.mistake((*at, "share"), "only normalized_detection_time has a share; remove it", key=True)


def _scenarios(
    document: Document, at: Address, entry: RequirementEntry, faulty: Mapping[str, bool]
) -> Iterator[Mistake]:
    yield from _matched(document, (*at, "scenarios"), entry.scenarios, tuple(faulty), "scenario")
    if entry.of not in OF_FAULTS:
        return
    healthy = [number for number, name in enumerate(entry.scenarios) if faulty.get(name) is False]
    if not any(faulty.values()):
        message = f"{entry.of} counts flights with faults; no scenario of this campaign has any"
        yield document.mistake((*at, "of"), message)
        return
    for number in healthy:
        message = (
            f"{entry.of} counts flights with faults, and scenario {entry.scenarios[number]!r} has none; require "
            "false_alarm_share or false_alarms_per_hour of it"
        )
        yield document.mistake((*at, "scenarios", number), message)
    if not healthy and not any(faulty[name] for name in chosen(entry.scenarios, tuple(faulty)) or faulty):
        yield document.mistake((*at, "scenarios"), f"{entry.of} counts flights with faults; none of these has any")


def _matched(
    document: Document, at: Address, patterns: Sequence[str], known: Sequence[str], what: str
) -> Iterator[Mistake]:
    for number, pattern in enumerate(patterns):
        if not chosen([pattern], known):
            parts = (did_you_mean(pattern, known), f"Its {what}s: {', '.join(known)}")
            hint = " ".join(filter(None, parts))
            message = f"no {what} of this campaign is called {pattern!r}. {hint}{_without(document, f'{what}s')}"
            yield document.mistake((*at, number), message)


def _without(document: Document, *address: str) -> str:
    """Cure for requirements that an override of the command line made pointless."""
    changed = document.where(address).startswith("--set")
    return ". Without requirements: --set requirements=[]" if changed else ""


def _parts(document: Document, at: Address, entry: RequirementEntry, dispersions: Dispersions) -> Iterator[Mistake]:
    known = ("scenario", *dispersions.grid, *dispersions.sequence)
    if entry.per is not None and entry.per not in known:
        hint = " ".join(filter(None, [did_you_mean(entry.per, known), f"Known here: {', '.join(known)}"]))
        message = (
            f"judged one by one are scenarios, or values of a parameter in grid or sequence, got {entry.per!r}. {hint}"
        )
        yield document.mistake((*at, "per"), message)


def _runs(document: Document, at: Address, entry: RequirementEntry, written: CampaignFile) -> Iterator[Mistake]:
    """Evidence comes from aircraft that are drawn independently of each other."""
    drawn = written.dispersions.monte_carlo
    if drawn is not None and (drawn.sampling != "random" or drawn.table is not None):
        what = f"table {drawn.table}" if drawn.table is not None else f"sampling: {drawn.sampling}"
        message = (
            f"a requirement is judged aircraft by aircraft, each drawn by itself; with {what} they are not. Remove the "
            "requirements here, or draw with sampling: random"
        )
        yield document.mistake(at, message)
        return
    of = chosen(entry.scenarios, [scenario.name for scenario in written.scenarios])
    runs = [s.runs or (drawn.runs if drawn else 1) for s in written.scenarios if s.name in of]
    if runs and min(runs) < 2:
        message = (
            "a requirement is judged over Monte-Carlo runs, and there is one run; write dispersions: {monte_carlo: {runs: "
            f"1000}}}}{_without(document, 'dispersions', 'monte_carlo', 'runs')}"
        )
        yield document.mistake(at, message)
