"""The package's own scorer on flights of `tests.metrics.independent`: sample by sample in NumPy, or compiled."""

from functools import lru_cache

import numpy as np
from tests.metrics.independent import limit, onset

from fddbench.blocks.kernel import Addresses, build
from fddbench.blocks.layout import Nothing
from fddbench.blocks.program import trace
from fddbench.interfaces import NEVER, Verdict
from fddbench.metrics.rows import event_columns, score_columns, statuses
from fddbench.metrics.score import FaultTimes
from fddbench.metrics.scoring import SITES as OF_SITES
from fddbench.metrics.scoring import Scoring

SITES = ("r1", "r2", "r3")
N_FAULTS, LONGEST = 3, 20
SAID = 3 + 1 + 1 + 3 + 3  # declared sites, alarm, residual, estimates and what is true of them


@lru_cache
def scoring_of(isolates, estimates, watches, sample_s):
    return Scoring(SITES, N_FAULTS, sample_s, watches=watches, isolates=isolates, estimates=estimates)


def role(flight):
    """What decides which scoring a flight has."""
    estimates = None if flight.estimate is None else OF_SITES if "r1" in flight.estimate else "voted"
    return flight.isolates, estimates, flight.watches or SITES, flight.sample_s


def constants_of(scoring, flight):
    """Constant rows of one flight, (n_rows, 1)."""
    times, faulty_from = [], np.full((3, 1), NEVER)
    for fault in flight.faults:
        begins = {site: float(first) for site, first, _ in fault}
        faulty_from = np.minimum(faulty_from, np.array([[begins.get(site, NEVER)] for site in SITES]))
        lasts = [last for *_, last in fault]
        last = NEVER if None in lasts else float(max(lasts))
        own = np.array([[float(site in begins)] for site in SITES])
        times.append(FaultTimes(first=float(onset(fault)), last=last, own=own))
    return scoring.rows(last=len(flight.declared) - 1.0, faults=times, faulty_from=faulty_from, n_cases=1)


def said_of(flight):
    """What is said at each sample, (LONGEST, SAID); past the end of the flight anything, as in a chunk."""
    rows = np.full((LONGEST, SAID), 1.0)
    rows[:, 4] = np.nan
    for k, declared in enumerate(flight.declared):
        signals = [site for site in SITES if site in flight.estimate] if flight.estimate else []
        signals = signals or list(flight.estimate or ())
        sizes = [flight.estimate[name][k] for name in signals] + [0.0] * (3 - len(signals))
        added = [flight.added[name][k] for name in signals] + [0.0] * (3 - len(signals))
        residual = flight.residual[k] if flight.residual else 0.0
        alarm = float(bool(flight.alarm and flight.alarm[k]))
        rows[k] = [*(float(site in declared) for site in SITES), alarm, residual, *sizes, *added]
    return rows


def step(scoring, x, c, said, sample, alive):
    """One sample of the scoring, fed with rows."""
    sizes, actual = {None: (None, None), OF_SITES: (said[5:8], said[8:11])}.get(scoring.estimates, (said[5], said[8]))
    verdict = Verdict(said[:3], said[4], alarm=said[3], estimate=sizes)
    return scoring.step(x, c, Nothing(), verdict, actual, sample, alive)[0]


def flown(scoring, constants, said, departed, backend):
    """Score after all samples, (n_score, n_cases); `said` is (LONGEST, SAID, n_cases)."""
    c = scoring.constants.unpack(constants)
    x = scoring.states.spread(scoring.start(c), len(departed))
    if backend == "llvm":
        return _compiled(scoring, scoring.states.pack(x), constants, said, departed)
    for k in range(LONGEST):
        x = step(scoring, x, c, said[k], float(k), k < departed)
    return scoring.states.pack(scoring.states.spread(x, len(departed)))


@lru_cache
def _kernel(scoring):
    """What is said stands in constant rows, sample after sample, so that the compiled step needs its number only."""

    def one(state, constants, normals, sample):
        del normals
        at, end = constants[scoring.constants.size :], scoring.constants.size
        now = at[:SAID]
        for k in range(1, LONGEST):
            now = np.where(sample == float(k), at[SAID * k : SAID * (k + 1)], now)
        c = scoring.constants.unpack(constants[:end])
        after = step(scoring, scoring.states.unpack(state), c, now, sample, sample < constants[-1])
        return {"state": scoring.states.pack(after)}

    rows = scoring.constants.size + SAID * LONGEST + 1
    return build(trace(one, state=scoring.states.size, constants=rows, normals=0, sample=0), backend="llvm")


def _compiled(scoring, state, constants, said, departed):
    n = len(departed)
    rows = np.concatenate([constants, said.reshape(-1, n), departed[np.newaxis]])
    addresses = Addresses(key=0, run=0, flight=0, scenario=0)
    samples = np.full(n, LONGEST, dtype=np.int64)
    return _kernel(scoring).fly(state.copy(), rows, samples, addresses, first=0, end=LONGEST).state


def scores_of(flights, backend="numpy"):
    """Columns of each flight as the package gives them, with its events; flights of one role are one chunk."""
    found = [None] * len(flights)
    for one in dict.fromkeys(map(role, flights)):
        places = [i for i, flight in enumerate(flights) if role(flight) == one]
        for i, scores in zip(places, _together([flights[i] for i in places], scoring_of(*one), backend), strict=True):
            found[i] = scores
    return found


def _together(flights, scoring, backend):
    constants = np.concatenate([constants_of(scoring, flight) for flight in flights], axis=1)
    said = np.stack([said_of(flight) for flight in flights], axis=2)
    departed = np.array([NEVER if flight.departed is None else float(flight.departed) for flight in flights])
    score = flown(scoring, constants, said, departed, backend)
    status, _ = statuses(scoring, score, infeasible=[""] * len(flights), errors=[""] * len(flights))
    limit_s = np.array([limit(f, f.faults) * f.sample_s if f.faults else np.nan for f in flights])
    columns = score_columns(scoring, score, constants, limit_s=limit_s, status=status, departed=departed)
    found = [
        dict(zip(columns, row, strict=True)) for row in zip(*(c.to_pylist() for c in columns.values()), strict=True)
    ]
    for j in range(N_FAULTS):
        has = np.array([len(flight.faults) > j for flight in flights])
        own_s = np.array(
            [limit(f, [f.faults[j]]) * f.sample_s if ok else 1.0 for f, ok in zip(flights, has, strict=True)]
        )
        events = event_columns(
            scoring,
            score,
            constants,
            event=j,
            limit_s=own_s,
            departed=departed,
            valid=np.ones(len(flights), dtype=bool),
        )
        for i in np.flatnonzero(has):
            event = {name: values[int(i)].as_py() for name, values in events.items()}
            found[i].setdefault("events", []).append(event)
    return [{"events": []} | row | {"status": name} for row, name in zip(found, status, strict=True)]
