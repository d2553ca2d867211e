"""Three hypotheses, "this sensor tells the truth", tested against the two lateral equations of motion."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import largest, total
from fddbench.detection.confirmation import samples
from fddbench.detection.yaw_rate_best.difference import Difference, DifferenceState
from fddbench.detection.yaw_rate_best.evidence import Evidence, EvidenceState
from fddbench.detection.yaw_rate_best.gains import YawRateBestGains
from fddbench.detection.yaw_rate_best.lateral_model import LateralModel
from fddbench.detection.yaw_rate_best.witnesses import Witnesses, WitnessState
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict

__all__ = ["YawRateBest"]

_SIGNALS = (
    "phi_deg", "beta_deg", "p_deg_s", "r_voted_deg_s", "surface_deg", "v_tas_m_s", "mass_kg", "x_cg_ratio",
    "altitude_ft", "v_cas_kt",
)  # fmt: skip


@record
class YawRateBestState:
    """Witnesses, distances between sensors, evidence, and what is declared."""

    witnesses: WitnessState
    difference: DifferenceState
    evidence: EvidenceState
    declared: Rows


class YawRateBest:
    """Declares every sensor that the motion of the aircraft contradicts, for good; a later one may be added.

    **Idea.** Two faulty sensors that agree win every vote, so sensors must be compared with the aircraft, not with each
    other. Of three sensors three hypotheses are kept, "this one tells the truth", each a *witness*: two small Kalman filters
    fed by this sensor alone. One holds the yaw moment against it, ``r' = N_v V beta + N_p p + N_r r + N_u u + a``, where the
    vane measures the very air that turns the aircraft, so a gust is no surprise; a is what the model does not know, and is
    forgotten in seconds. The other holds the side force against it: where the nose goes, the path must follow the bank angle,
    ``(v/V)' = g phi / V - r + ... + d``, and the vane shows path less gust. A slow ramp of 0.05 deg/s^2 hides in a, but not
    for long in the second: it would fly a turn that no bank angle explains. d hardly changes and takes in biases of gyros,
    vane and bank angle, so that no bias needs to be known.

    **Decision.** While the sensors differ by more than healthy ones do (offsets are learned), each witness sums its squared
    innovations, smoothed and divided by their level in this air; half of a difference of two sums is a log-likelihood ratio.
    What air and model do wrong is the same for all three and drops out but for what points along the fault. A sensor is
    declared when its sum exceeds that of the best witness by `evidence_one`, two at once by `evidence_two`. No timer, no
    vote; shape, size and sign of the fault are free, so opposite pairs, oscillations and freezes are nothing special, and all
    sensors are treated alike. The estimate is the voted signal less the mean of the sensors that are not declared.

    **Model assumed.** The table of the design: rigid aircraft, small sideslip, measured mass, X_cg, altitude and airspeed 10
    % wrong are in order. **Blind** to what leaves the sensors equal (three frozen in cruise), to faults below `differ_deg_s`,
    and for as long as an aircraft model can be as wrong as the fault is large: an oscillation of 1.5 deg/s that starts at
    phase 0 has moved the sensor by 0.29 deg/s after 0.36 s. **Noisy** where the air turns the aircraft past the vane (gust
    gradients) and where incidence or speed leave the table. **Knobs:** the two evidences (``fddbench tune``) trade time for
    wrong sites; floors say how far the model is trusted in calm air, `level_ratio` in rough air; the unknown acceleration of
    the recipe decides how long the moment equation remembers, the unknown turn rate how slow a ramp may be. **Cost:** 413
    operations a sample on the published model, 559 on the twin-jet, where the published scheme has 867.

    References
    ----------
    Deckert, Desai, Deyst, Willsky (1977), F-8 DFBW sensor failure identification using analytic redundancy, IEEE Transactions
    on Automatic Control 22(5), 795-803: like sensors that differ start likelihood ratios on the equations of motion.
    Magill (1965), Optimal adaptive estimation of sampled stochastic processes, IEEE Transactions on Automatic Control 10(4),
    434-439: hypotheses as a bank of filters. Willsky, Jones (1976), A generalized likelihood ratio approach to the detection
    and estimation of jumps in linear systems, IEEE Transactions on Automatic Control 21(1), 108-112. The complementary use of
    moment and force equation and the levels are ours.

    Examples
    --------
    >>> from fddbench.testing import check_detector
    >>> check_detector("yaw_rate_best")
    """

    about = "three hypotheses, this sensor tells the truth, against the yaw-moment and side-force equations"
    recorded = ("evidence_1", "evidence_2", "evidence_3", "difference_ratio")
    Gains = YawRateBestGains
    estimates = "r_voted_deg_s"

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: YawRateBestGains, bus: Bus) -> None:
        T = bus.sample_s
        self.watches = bus.redundant("r_deg_s")
        self.model = LateralModel(gains.table)
        self.witnesses = Witnesses(gains, _share(T, gains.smooth_s))
        rest = samples("rest_s", gains.rest_s, T)
        self.difference = Difference(gains, _share(T, gains.differ_s), T / gains.offset_s, rest)
        # means over smooth_s are as good as independent every two of these
        self.evidence = Evidence(gains, T / (2.0 * gains.smooth_s), T / gains.level_s, 1.0 - _share(T, gains.memory_s))
        self.states = Layout(
            YawRateBestState(
                witnesses=self.witnesses.states.shape,
                difference=self.difference.states.shape,
                evidence=self.evidence.states.shape,
                declared=3,
            )
        )

    @classmethod
    def from_design(cls, gains: YawRateBestGains, bus: Bus) -> "YawRateBest":
        """Monitor for a bus; needs three yaw-rate sensors, 13 lateral surfaces, and the clock of the design."""
        bus.require(*_SIGNALS)
        watched = bus.redundant("r_deg_s", least=3)
        if len(watched) != 3 or bus.signals["surface_deg"] != 13:
            raise DesignError(
                f"needs 3 sensors on r_deg_s and 13 rows of surface_deg, this benchmark has {len(watched)} and "
                f"{bus.signals['surface_deg']}"
            )
        if abs(gains.sample_s - bus.sample_s) > 1e-9 * bus.sample_s:
            raise DesignError(
                f"sample_s: the gains are for {gains.sample_s} s, this campaign samples every {bus.sample_s} s; change "
                "recipe.sample_s and run fddbench design, or change sample_s"
            )
        return cls(gains, bus)

    def start(self, c: Nothing) -> YawRateBestState:
        """Nothing seen, nothing declared."""
        del c
        return YawRateBestState(
            witnesses=self.witnesses.start(),
            difference=self.difference.start(),
            evidence=self.evidence.start(),
            declared=0.0,
        )

    def step(
        self, x: YawRateBestState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[YawRateBestState, Verdict]:
        """Verdict after one sample."""
        del c, n
        r_deg_s = measured.r_deg_s
        difference, ratio, differ, gathering = self.difference.step(
            x.difference, x.witnesses.begun, r_deg_s, measured.p_deg_s, x.declared
        )
        witnesses, innovations = self.witnesses.step(
            x.witnesses, self.model.drives(measured), r_deg_s, measured.beta_deg
        )
        evidence, against = self.evidence.step(x.evidence, innovations, x.declared, gathering)
        declared = np.where((against > 1.0) & differ, 1.0, x.declared)
        trusted = 1.0 - declared
        estimate = measured.r_voted_deg_s - total(trusted * r_deg_s) / total(trusted)
        after = YawRateBestState(witnesses=witnesses, difference=difference, evidence=evidence, declared=declared)
        shown = {f"evidence_{i + 1}": against[i] for i in range(3)} | {"difference_ratio": ratio}
        return after, Verdict(declared, largest(against), signals=shown, estimate=estimate)


def _share(sample_s: float, time_s: float) -> float:
    """Share of what is new in a first-order mean."""
    return float(1.0 - exp(np.array(-sample_s / time_s)))
