"""Law: sums that begin anew with each stretch are those of the independent scorer, which knows the detection."""

from dataclasses import replace
from functools import partial
from random import Random

import numpy as np
import pytest
from tests.metrics.flights import SITES, faulty_from_of, random_flights
from tests.metrics.independent import end, onset, score

from fddbench.blocks.kernel import Addresses, build
from fddbench.blocks.program import trace
from fddbench.metrics.estimate import add_errors, bias_and_rms
from fddbench.metrics.found import NEVER, changed, found_by_alarm, found_by_sites, in_flight, outside

ROW = partial(np.full, 1)


def _one_pass(flight, signals, settling):
    """(count, bias, rms) of one flight, sample by sample."""
    faults = [_constants(flight, fault, signals) for fault in flight.faults]
    numbers, sums = [ROW(NEVER) for _ in faults], [(ROW(0.0),) * 3 for _ in faults]
    faulty_from = np.array(faulty_from_of(flight))[:, np.newaxis]
    previous, alarm_before = np.zeros((3, 1)), ROW(0.0)
    for k in range(len(flight.declared)):
        sample, active = ROW(float(k)), ROW(k <= flight.last)
        declared = np.array([[float(site in flight.declared[k])] for site in SITES])
        alarm = ROW(float(flight.A(k)))
        errors = np.array([[flight.estimate[name][k] - flight.added[name][k]] for name in signals])
        when = {"sample": sample, "active": active}
        wrong, news = outside(declared, faulty_from, sample), changed(declared, previous)
        for j, (own, shows, first, last) in enumerate(faults):
            before, life = numbers[j], {"first": first, "last": last}
            numbers[j] = (
                found_by_sites(before, own, declared, wrong=wrong, news=news, **life, **when)
                if flight.isolates
                else found_by_alarm(before, alarm, alarm_before, **life, **when)
            )
            sums[j] = add_errors(
                sums[j], errors, shows, found=numbers[j], before=before, settling=ROW(settling), last=last, **when
            )
        previous, alarm_before = declared, alarm
    last_scored = ROW(flight.last)
    found = [
        in_flight(one, first=fault[2], last_scored=last_scored) for one, fault in zip(numbers, faults, strict=True)
    ]
    summed = tuple(np.array(rows) for rows in zip(*sums, strict=True))
    return [float(one[0]) for one in bias_and_rms(summed, found=np.array(found))]


def _constants(flight, fault, signals):
    own = {site for site, *_ in fault}
    lasts = NEVER if any(last is None for *_, last in fault) else end(fault, 10**6)
    return (
        np.array([[float(site in own)] for site in SITES]),
        np.array([[float(name in own or name not in SITES)] for name in signals]),
        ROW(float(onset(fault))),
        ROW(float(lasts)),
    )


@pytest.mark.parametrize("signals", [("r1", "r2", "r3"), ("r2", "r3"), ("voted",)])
@pytest.mark.parametrize("settling", [1, 3])
def test_one_pass_sums_what_looking_back_sums(signals, settling):
    random, counted = Random(settling), 0
    for flight in random_flights(2500, seed=settling):
        if not flight.faults:
            continue
        n = len(flight.declared)
        numbers = [{name: [random.gauss(0, 1) for _ in range(n)] for name in signals} for _ in range(2)]
        flight = replace(flight, estimate=numbers[0], added=numbers[1], sample_s=1.0 / settling)
        expected = score(flight)
        count, bias, rms = _one_pass(flight, signals, float(settling))
        if expected["estimate_bias"] is None:
            assert count == 0.0
            continue
        counted += 1
        assert bias == pytest.approx(expected["estimate_bias"], abs=1e-12)
        assert rms == pytest.approx(expected["estimate_rms"], rel=1e-12)
    assert counted > 100


@pytest.mark.parametrize("backend", ["numpy", "llvm"])
def test_it_can_be_traced_and_gives_the_same_bits(backend):
    if backend == "llvm":
        pytest.importorskip("llvmlite")
    rng, n = np.random.default_rng(1), 400
    number = rng.choice([NEVER, -1.0, 3.0, 5.0], (2, n))
    constants = np.concatenate(
        [
            rng.normal(size=(3, n)),
            rng.integers(0, 2, (3, n)),
            number,
            rng.integers(1, 3, (1, n)),
            rng.integers(4, 9, (2, n)),
        ]
    )

    def step(state, constants):
        c = constants
        rows = {"found": c[6], "before": c[7], "settling": c[8], "last": c[9], "sample": c[10], "active": c[10] < 8.0}
        after = np.stack(add_errors((state[0], state[1], state[2]), c[:3], c[3:6], **rows))
        return {"state": after, "y": np.stack(bias_and_rms(after[:, np.newaxis], found=c[6:7]))}

    state = rng.normal(size=(3, n)) ** 2
    program = trace(step, state=3, constants=len(constants))
    addresses = Addresses(key=0, run=0, flight=0, scenario=0)
    flown = build(program, recorded=("y",), backend=backend).fly(
        state.copy(), constants, np.ones(n, dtype=np.int64), addresses, first=0, end=1
    )
    np.testing.assert_array_equal(flown.recorded["y"][0], step(state, constants)["y"])
