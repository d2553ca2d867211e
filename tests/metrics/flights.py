"""Random flights for scorers: several faults, delays, ends, sites that share faults, departures, early and late alarms."""

from random import Random

from hypothesis import strategies as st
from tests.metrics.independent import Flight

SITES = ("r1", "r2", "r3")
NEVER = float(2**53)


def faulty_from_of(flight):
    """First faulty sample of each site, `NEVER` for a healthy one."""
    onsets = [(site, float(first)) for fault in flight.faults for site, first, _ in fault]
    return [min([first for own, first in onsets if own == site], default=NEVER) for site in SITES]


@st.composite
def faults(draw, n_samples):
    """One fault: one or two sites, the second perhaps delayed, to the end or over after a while; it may lie beyond."""
    own = draw(st.lists(st.sampled_from(SITES), min_size=1, max_size=2, unique=True))
    first = draw(st.integers(0, n_samples + 1))
    delay = draw(st.sampled_from([0, 0, 1, 3]))
    onsets = [first + i * delay for i in range(len(own))]
    last = draw(st.one_of(st.none(), st.integers(max(onsets), max(onsets) + 6)))
    return tuple((site, onset, last) for site, onset in zip(own, onsets, strict=True))


@st.composite
def flights(draw, max_faults=3):
    """A flight and what a detector says: values that stand for a while, often the truth, often one sample off it."""
    n = draw(st.integers(1, 16))
    several = tuple(draw(st.lists(faults(n), max_size=max_faults)))
    isolates, allowed = draw(st.booleans()), draw(st.integers(1, 8))
    declared, alarm = _verdict(draw, n, several)
    return Flight(
        faults=several,
        declared=declared if isolates else (frozenset(),) * n,
        alarm=alarm,
        isolates=isolates,
        departed=draw(st.one_of(st.none(), st.integers(0, n + 2))),
        requirement=lambda sites: allowed + len(sites),
    )


def _verdict(draw, n, several):
    """(declared, alarm): turned at random samples to a random set, or to what is faulty there."""
    faulty = [frozenset(site for fault in several for site, first, _ in fault if first <= k) for k in range(n)]
    anything = st.one_of(st.just("truth"), st.frozensets(st.sampled_from(SITES)))
    turns = draw(st.dictionaries(st.integers(0, n - 1), anything, max_size=6))
    flips = draw(st.sets(st.integers(0, n - 1), max_size=4))
    declared, alarm, said, on = [], [], frozenset(), False
    for k in range(n):
        said = turns.get(k, said)
        on = on != (k in flips)
        declared.append(faulty[k] if said == "truth" else said)
        alarm.append(on)
    return tuple(declared), tuple(alarm)


def random_flights(how_many, seed=0):
    """The same kind of flights without hypothesis, thousands at once; departures, ends and turns crowd at the onsets."""
    random = Random(seed)
    return [_random_flight(random) for _ in range(how_many)]


def _random_flight(random):
    n = random.randint(1, 16)
    several = []
    for _ in range(random.choice([0, 1, 1, 1, 2, 2, 3])):
        own = random.sample(SITES, random.choice([1, 1, 2]))
        first, delay = random.randint(0, n + 1), random.choice([0, 0, 1, 3])
        onsets = [first + i * delay for i in range(len(own))]
        last = random.choice([None, onsets[-1] + random.randint(0, 6)])
        several.append(tuple((site, onset, last) for site, onset in zip(own, onsets, strict=True)))
    faulty = [frozenset(site for fault in several for site, first, _ in fault if first <= k) for k in range(n)]
    declared, alarm, said, on = [], [], frozenset(), False
    turning = random.choice([0.05, 0.2, 0.5])
    for k in range(n):
        if random.random() < turning:
            said = random.choice(["truth", "truth", frozenset(), frozenset(random.sample(SITES, random.randint(1, 2)))])
        on = on != (random.random() < turning)
        declared.append(faulty[k] if said == "truth" else said)
        alarm.append(on)
    isolates, allowed = random.random() < 0.6, random.randint(1, 8)
    return Flight(
        faults=tuple(several),
        declared=tuple(declared) if isolates else (frozenset(),) * n,
        alarm=tuple(alarm) if random.random() < 0.3 or not isolates else (False,) * n,
        isolates=isolates,
        departed=random.choice([None, None, random.randint(0, n + 2)]),
        requirement=lambda sites: allowed + len(sites),
    )
