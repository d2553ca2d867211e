"""The contract's examples as data: 47 sequences with their scores, and ten sets of faults on one site.

``r1@12...14`` is true at samples 12 to 14, ``r1@12`` at sample 12, ``r1@12...`` from there to the end.
"""

import re
from dataclasses import dataclass, field

NEVER_ENDS = None
_TERM = re.compile(r"(?P<names>[a-z0-9+]+)@(?P<first>\d+)(?P<more>\.\.\.(?P<last>\d+)?)?")


@dataclass(frozen=True, kw_only=True)
class Sequence:
    """One line of the table.

    `faults`: one tuple a fault of (site, first, last or None: to the end). `verdict`: samples at which each site is
    declared; under ``alarm`` those of an alarm that names no site. Times in samples after k0, `false_alarm` after the
    start; None: null. `events`: (samples after its own onset or None, outcome) of each fault, where they are printed.
    """

    number: int
    case: str
    faults: tuple[tuple[tuple[str, int, int | None], ...], ...]
    verdict: dict[str, frozenset[int]]
    n_samples: int
    departed: int | None
    isolates: bool
    outcome: str
    false_alarm: int | None
    alarm: int | None
    detection: int | None
    wrong_site: int | None
    limit: int | None
    isolated: bool | None
    over_declared: bool | None
    events: tuple[tuple[int | None, str], ...] = field(default=())

    @property
    def declared(self):
        """Sites declared at each sample, (n_samples,)."""
        return tuple(
            frozenset(site for site, at in self.verdict.items() if site != "alarm" and k in at)
            for k in range(self.n_samples)
        )

    @property
    def alarms(self):
        """What the detector says itself at each sample, (n_samples,)."""
        return tuple(k in self.verdict.get("alarm", ()) for k in range(self.n_samples))


def terms(text):
    """(names, first, last; None: to the end) of each term.

    >>> terms("r1@8 r1+r2@12...14 r3@12...")
    [(('r1',), 8, 8), (('r1', 'r2'), 12, 14), (('r3',), 12, None)]
    """
    found = [_TERM.fullmatch(term) for term in text.split()]
    return [
        (
            tuple(m["names"].split("+")),
            int(m["first"]),
            int(m["last"]) if m["last"] else None if m["more"] else int(m["first"]),
        )
        for m in found
    ]


def faults_of(text):
    """Faults, separated by commas, as (site, first, last) of each of their sites; without a last sample: to the end.

    >>> faults_of("r1@10...12, r1@15 r2@16")
    ((('r1', 10, 12),), (('r1', 15, None), ('r2', 16, None)))
    """
    return tuple(
        tuple((site, first, last) for names, first, last in _lasting(line) for site in names)
        for line in text.split(",")
        if line.strip()
    )


def _lasting(line):
    """A fault written with its onset only lasts, unlike a verdict."""
    return terms(" ".join(term if "..." in term else term + "..." for term in line.split()))


def verdict_of(text, n_samples):
    """Samples at which each name is true.

    >>> verdict_of("r1@2 r1@4...", 6)
    {'r1': frozenset({2, 4, 5})}
    """
    samples = {}
    for names, first, last in terms(text):
        for name in names:
            stop = n_samples if last is None else last + 1
            samples[name] = samples.get(name, frozenset()) | frozenset(range(first, stop))
    return samples


def _events(text):
    """``2 right; - missed; declared_before``."""
    pairs = [entry.split() for entry in text.split(";") if entry.strip()]
    return tuple((int(pair[0]) if len(pair) == 2 and pair[0] != "-" else None, pair[-1]) for pair in pairs)


def _sequence(
    number, case, fault, verdict, outcome, *values, n_samples=20, departed=None, isolates=True, events=""
):  # fmt: skip
    """Values in the order of the printed columns: false alarm, alarm, detection, wrong site, limit, isolated, over."""
    names = ("false_alarm", "alarm", "detection", "wrong_site", "limit", "isolated", "over_declared")
    return Sequence(
        number=number,
        case=case,
        faults=faults_of(fault),
        verdict=verdict_of(verdict, n_samples),
        n_samples=n_samples,
        departed=departed,
        isolates=isolates,
        outcome=outcome,
        events=_events(events),
        **dict(zip(names, values, strict=True)),
    )


# number, case, fault, verdict,
#           outcome, false alarm, alarm, detection, wrong site, limit, isolated, over
# fmt: off
SEQUENCES = (
    _sequence(1, "found", "r1@10", "r1@13...",
              "right", None, 3, 3, None, 5, True, False),
    _sequence(2, "at the limit itself", "r1@10", "r1@15...",
              "right", None, 5, 5, None, 5, True, False),
    _sequence(3, "one sample after it", "r1@10", "r1@16...",
              "late", None, 6, 6, None, 5, True, False),
    _sequence(4, "never", "r1@10", "",
              "missed", None, None, None, None, 5, False, False),
    _sequence(5, "flight ends before the limit, at 14", "r1@10", "",
              "undecided", None, None, None, None, 5, False, False, n_samples=15),
    _sequence(6, "flight ends on the limit, at 15", "r1@10", "",
              "missed", None, None, None, None, 5, False, False, n_samples=16),
    _sequence(7, "let go", "r1@10", "r1@12...13",
              "missed", None, 2, None, None, 5, False, False),
    _sequence(8, "let go, flight ends before the limit, at 14", "r1@10", "r1@11...12",
              "undecided", None, 1, None, None, 5, False, False, n_samples=15),
    _sequence(9, "let go, taken up in time", "r1@10", "r1@12...13 r1@15...",
              "right", None, 2, 5, None, 5, True, False),
    _sequence(10, "let go, taken up late", "r1@10", "r1@12...13 r1@17...",
              "late", None, 2, 7, None, 5, True, False),
    _sequence(11, "flickers, on at the end", "r1@10", "r1@11 r1@13 r1@15 r1@17 r1@19",
              "late", None, 1, 9, None, 5, True, False),
    _sequence(12, "flickers, off at the end", "r1@10", "r1@11 r1@13 r1@15 r1@17",
              "missed", None, 1, None, None, 5, False, False),
    _sequence(13, "blip before, then right", "r1@10", "r2@5...6 r1@12...",
              "false_alarm", 5, 2, 2, None, 5, True, False),
    _sequence(14, "stands before, right one added", "r1@10", "r2@5... r1@12...",
              "false_alarm", 5, None, None, 0, 5, False, True),
    _sequence(15, "stands before, exchanged for the right one", "r1@10", "r2@5...11 r1@12...",
              "false_alarm", 5, None, 2, 0, 5, True, False),
    _sequence(16, "right site, one sample early", "r1@10", "r1@9...",
              "false_alarm", 9, None, None, None, 5, True, False),
    _sequence(17, "right site early, let go, raised again", "r1@10", "r1@8 r1@12...",
              "false_alarm", 8, 2, 2, None, 5, True, False),
    _sequence(18, "right, then a healthy one too", "r1@10", "r1@12... r2@14...",
              "wrong_site", None, 2, None, 4, 5, False, True),
    _sequence(19, "two, resolved to the right one", "r1@10", "r1@12... r2@12...13",
              "wrong_site", None, 2, 4, 2, 5, True, True),
    _sequence(20, "the wrong one only", "r1@10", "r2@12...",
              "wrong_site", None, 2, None, 2, 5, False, False),
    _sequence(21, "pair: one after the other", "r1+r2@10", "r1@12... r2@14...",
              "right", None, 2, 4, None, 5, True, False),
    _sequence(22, "pair: only one", "r1+r2@10", "r1@12...",
              "missed", None, 2, None, None, 5, False, False),
    _sequence(23, "delayed pair", "r1@10 r2@13", "r1@11... r2@15...",
              "right", None, 1, 5, None, 8, True, False),
    _sequence(24, "delayed pair, second declared on its first sample", "r1@10 r2@13", "r1@11... r2@13...",
              "right", None, 1, 3, None, 8, True, False),
    _sequence(25, "delayed pair, second declared one sample early", "r1@10 r2@13", "r1@11... r2@12...",
              "wrong_site", None, 1, None, 2, 8, True, True),
    _sequence(26, "ends, found while it lasts, released", "r1@10...12", "r1@11...13",
              "right", None, 1, 1, None, 5, False, False),
    _sequence(27, "ends, let go on its last sample", "r1@10...12", "r1@11",
              "missed", None, 1, None, None, 5, False, False),
    _sequence(28, "ends, declared only afterwards", "r1@10...12", "r1@14...",
              "missed", None, 4, None, None, 5, True, False),
    _sequence(29, "intermittent, latched", "r1@10...12, r1@15...17", "r1@11...",
              "right", None, 1, 1, None, 10, True, False, events="1 right; declared_before"),
    _sequence(30, "intermittent, followed", "r1@10...12, r1@15...17", "r1@11...12 r1@16...17",
              "right", None, 1, 6, None, 10, False, False, events="1 right; 1 right"),
    _sequence(31, "intermittent, only the second", "r1@10...12, r1@15...17", "r1@16...",
              "missed", None, 6, None, None, 10, True, False, events="- missed; 1 right"),
    _sequence(32, "second fault elsewhere", "r1@10, r2@14", "r1@12... r2@16...",
              "right", None, 2, 6, None, 9, True, False, events="2 right; 2 right"),
    _sequence(33, "second fault not found", "r1@10, r2@14", "r1@12...",
              "missed", None, 2, None, None, 9, False, False, events="2 right; - missed"),
    _sequence(34, "first ended and released, second found", "r1@10...12, r2@14", "r1@11...12 r2@16...",
              "right", None, 1, 6, None, 9, False, False, events="1 right; 2 right"),
    _sequence(35, "departs at 14, nothing declared", "r1@10", "",
              "missed", None, None, None, None, 5, False, False, departed=14),
    _sequence(36, "departs at 16, nothing declared", "r1@10", "",
              "missed", None, None, None, None, 5, False, False, departed=16),
    _sequence(37, "departs at 14, found", "r1@10", "r1@12...",
              "right", None, 2, 2, None, 5, True, False, departed=14),
    _sequence(38, "departs before the onset", "r1@10", "",
              "undecided", None, None, None, None, 5, None, None, departed=8),
    _sequence(39, "onset 0, declared at 0", "r1@0", "r1@0...",
              "right", None, 0, 0, None, 5, True, False),
    _sequence(40, "only detects", "r1@10", "alarm@12...",
              "right", None, 2, 2, None, 5, None, None, isolates=False),
    _sequence(41, "only detects, a blip", "r1@10", "alarm@12",
              "right", None, 2, 2, None, 5, None, None, isolates=False),
    _sequence(42, "only detects, late", "r1@10", "alarm@16...",
              "late", None, 6, 6, None, 5, None, None, isolates=False),
    _sequence(43, "only detects, stands before", "r1@10", "alarm@5...",
              "false_alarm", 5, None, None, None, 5, None, None, isolates=False),
    _sequence(44, "isolates, alarm without a site", "r1@10", "alarm@12...",
              "missed", None, 2, None, None, 5, False, False),
    _sequence(45, "healthy", "", "",
              "quiet", None, None, None, None, None, None, None),
    _sequence(46, "healthy, a site without an alarm", "", "r1@7",
              "false_alarm", 7, None, None, None, None, None, None),
    _sequence(47, "healthy, from the first sample on", "", "r1@0...",
              "false_alarm", 0, None, None, None, None, None, None),
)
# fmt: on


@dataclass(frozen=True, kw_only=True)
class Composition:
    """Faults on one site whose healthy reading is 0 1 2 ... 9 and whose stops are -12 and 12.

    `faults`: (kind, size, first, last or None), in any order; a jam's size is its place, a runaway's that of a sample.
    """

    faults: tuple[tuple[str, float, int, int | None], ...]
    reading: tuple[int, ...]


def _composition(faults, reading):
    return Composition(faults=faults, reading=tuple(int(text) for text in reading.split()))


STOPS = (-12.0, 12.0)

COMPOSITIONS = (
    _composition((("bias", 2, 3, None), ("freeze", 0, 6, None)), "0 1 2 5 6 7 7 7 7 7"),
    _composition((("freeze", 0, 3, None), ("bias", 2, 6, None)), "0 1 2 2 2 2 4 4 4 4"),
    _composition((("bias", 2, 3, 7), ("freeze", 0, 5, None)), "0 1 2 5 6 6 6 6 6 6"),
    _composition((("bias", 2, 3, 4), ("freeze", 0, 5, None)), "0 1 2 5 6 6 6 6 6 6"),
    _composition((("freeze", 0, 3, 6),), "0 1 2 2 2 2 2 7 8 9"),
    _composition((("freeze", 0, 0, None),), "0 0 0 0 0 0 0 0 0 0"),
    _composition((("freeze", 0, 4, None), ("bias", 2, 4, None)), "0 1 2 3 5 5 5 5 5 5"),
    _composition((("jam", 5, 2, None), ("freeze", 0, 5, 7)), "0 1 5 5 5 5 5 5 5 5"),
    _composition((("runaway", 3, 2, None),), "0 1 2 6 10 12 12 12 12 12"),
    _composition((("runaway", 3, 2, None), ("freeze", 0, 5, None), ("bias", -2, 7, None)), "0 1 2 6 10 10 10 8 8 8"),
)
