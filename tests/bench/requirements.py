"""How often requirements pass falsely, and how soon they are decided: ``python -m tests.bench.requirements [CAMPAIGNS]``.

Each line is many made-up campaigns of up to 1500 aircraft. A false pass at any of the 1500 looks counts, which is more than at
fifteen. Nine scenarios hang together by the correlation rho in two ways: every aircraft has a share of its own (beta), or is
with probability rho one in which all nine end alike (alike).
"""

import sys
from math import log

import numpy as np

from fddbench.metrics.anytime import bets, log_capital
from fddbench.metrics.evidence import Rate, Share

MOST = 1500


def share_of_aircraft(rng, truth, scenarios, rho, how):
    """Right flights of each aircraft, (MOST,)."""
    if scenarios == 1:
        return (rng.random(MOST) < truth).astype(float)
    if how == "beta":
        spread = (1.0 - rho) / rho
        return rng.binomial(scenarios, rng.beta(truth * spread, (1.0 - truth) * spread, MOST)).astype(float)
    alike, one = rng.random(MOST) < rho, rng.random(MOST) < truth
    return np.where(alike, scenarios * one, rng.binomial(scenarios, truth, MOST)).astype(float)


def shares(rng, campaigns, *, truth, limit=0.98, scenarios=9, rho=0.05, how="beta", more=True):
    """Aircraft after which each campaign knows that the share is more than the limit; infinity for not within MOST."""
    for _ in range(campaigns):
        hits = share_of_aircraft(rng, truth, scenarios, rho, how)
        of = Share(hits=hits, decided=np.full(MOST, float(scenarios)), failed=np.zeros(MOST), rows=scenarios)
        yield known(of, limit, more)


def rates(rng, campaigns, *, per_hour, limit, flights=4, length_s=60.0, how="constant", more=False):
    """The same for a rate: alarms of a constant rate, at once or never, in half of the aircraft, or alike in all flights."""
    for _ in range(campaigns):
        shape = (MOST, 1 if how == "alike" else flights)
        hours = length_s / 3600.0
        hazard = np.full(shape, per_hour)
        if how == "half":  # alarms over exposure stays what it was: half of the aircraft alarm within moments
            hazard = np.where(rng.random((MOST, 1)) < 0.5, half_rate(per_hour, hours), 1e-12)
        first = rng.exponential(1.0, shape) / hazard
        if how == "at once":
            share = per_hour * hours / (1.0 + per_hour * hours)
            first = np.where(rng.random(shape) < share, 0.0, np.inf)
        alarm, time = (
            np.broadcast_to(first < hours, (MOST, flights)),
            np.broadcast_to(np.minimum(first, hours), (MOST, flights)),
        )
        none = np.zeros(MOST)
        of = Rate(
            alarms=alarm.sum(axis=1).astype(float), hours=time.sum(axis=1), failed=none, failed_hours=none,
            flights=flights, most_hours=flights * hours,
        )  # fmt: skip
        yield known(of, limit, more)


def half_rate(per_hour, hours):
    """Rate of half of the aircraft at which alarms over exposure of all is `per_hour`."""
    low, high = per_hour, 1e6
    for _ in range(80):
        middle = (low + high) / 2.0
        some = 1.0 - np.exp(-middle * hours)
        low, high = (middle, high) if some / (some / middle + hours) < per_hour else (low, middle)
    return low


def known(of, limit, more):
    """Aircraft after which it is known; infinity for never."""
    over = log_capital(of.gains(limit, more=more), bets(of.mean(limit, more=more))) >= log(20.0)
    return over.argmax() + 1.0 if over.any() else np.inf


def told(name, found):
    """Print a line."""
    at = np.array(list(found))
    median = f"{np.median(at):.0f}" if np.isfinite(np.median(at)) else "-"
    print(f"{name:<58}{100 * np.mean(np.isfinite(at)):6.1f} %   {median:>5}", flush=True)


CASES = ((1, 0.0, "beta"), (9, 0.05, "beta"), (9, 0.05, "alike"), (9, 0.5, "beta"), (9, 0.5, "alike"))


def main(campaigns):
    """All lines."""
    rng = np.random.default_rng(13)
    print(f"{campaigns} campaigns a line; decided within {MOST} aircraft, and the median of aircraft")
    for scenarios, rho, how in CASES:
        named = f"{scenarios} scenario{'s' * (scenarios > 1)}, rho {rho:g}, {how}"
        for truth in (0.98, 0.99, 0.995):
            given = {"truth": truth, "scenarios": scenarios, "rho": rho, "how": how}
            told(f"share >= 0.98 passes, truth {truth:g}, {named}", shares(rng, campaigns, **given))
        for truth in (0.98, 0.97, 0.95):
            given = {"truth": truth, "scenarios": scenarios, "rho": rho, "how": how, "more": False}
            told(f"share >= 0.98 fails, truth {truth:g}, {named}", shares(rng, campaigns, **given))
    for limit in (1.0, 20.0):
        for how in ("constant", "at once", "half", "alike"):
            given = {"limit": limit, "how": how}
            told(f"rate <= {limit:g} passes, truth the same, {how}", rates(rng, campaigns, per_hour=limit, **given))
            told(f"rate <= {limit:g} passes, truth half, {how}", rates(rng, campaigns, per_hour=limit / 2, **given))
            told(
                f"rate <= {limit:g} fails, truth the same, {how}",
                rates(rng, campaigns, per_hour=limit, more=True, **given),
            )
            told(
                f"rate <= {limit:g} fails, truth twice, {how}",
                rates(rng, campaigns, per_hour=2 * limit, more=True, **given),
            )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2000)
