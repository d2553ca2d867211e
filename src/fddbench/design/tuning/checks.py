"""Which campaigns thresholds may be tuned on, and what a target needs of them."""

from fddbench.campaign.meaning import Campaign
from fddbench.design.tuning.promise import Healthy, Target, promise
from fddbench.errors import DesignError

__all__ = ["require_enough", "require_tuning"]


def require_tuning(campaign: Campaign) -> None:
    """Refuse a campaign whose flights are there to be scored, or that has none to tune on.

    Raises
    ------
    DesignError
        It is one of both.
    """
    if campaign.purpose != "tuning":
        raise DesignError(
            f"{campaign.path} has purpose: {campaign.purpose}; thresholds chosen on flights that are scored later "
            "flatter the score. Write a campaign with purpose: tuning (its flights are never those of an evaluation)."
        )
    if all(scenario.faults for scenario in campaign.scenarios):
        raise DesignError(f"{campaign.path} has no healthy scenario; thresholds are tuned on healthy flights")


def require_enough(healthy: Healthy, target: Target, campaign: Campaign, *, fitted: int = 1) -> None:
    """Refuse a target that not even flights without a single false alarm would keep.

    Raises
    ------
    DesignError
        With the number of runs that it needs.
    """
    quiet = Healthy(alarm=healthy.alarm & False, time_s=healthy.time_s, run=healthy.run)
    best = promise(quiet, target, fitted=fitted)
    if target.kept(best):
        return
    need = target.runs_needed(fitted, best.hours / best.flights)
    unit = f"{100.0 * best.limit:.3g} %" if target.per == "flight" else f"{best.limit:.3g} per hour"
    raise DesignError(
        f"{best.flights} healthy flights of {best.runs} runs in {campaign.path} cannot promise {target.words}: without a "
        f"single false alarm in them it is {unit}. That needs about {need:,} runs without one, more with some "
        "(dispersions.monte_carlo.runs)"
    )
