"""The jet-engine benchmark as campaigns see it: uncertainty sets, parameters, input histories, requirements."""

from collections.abc import Mapping
from typing import Any

from fddbench.benchmarks.jet_engine.loop import JetEngineLoop
from fddbench.benchmarks.jet_engine.manoeuvres import DURATIONS_S
from fddbench.benchmarks.jet_engine.plant import MATRICES
from fddbench.benchmarks.jet_engine.uncertainty import SETS
from fddbench.errors import FddbenchError
from fddbench.interfaces import Choice, Floats, Options, Parameter, SinglePlant, Site

__all__ = ["JetEngine"]


class JetEngine(SinglePlant):
    """Linear jet engine with an uncertain Δ of norm one, three disturbances and three additive faults.

    Section 5 of the robust H∞ paper. The input histories and the detection time limit of 5 s are ours; disturbances
    are normal numbers of standard deviation 2, held 0.1 s each.
    """

    name = "jet_engine"
    about = "linear jet engine with uncertain dynamics, three disturbances and three additive faults"
    choices: Mapping[str, Choice] = {
        "plant": Choice(
            about="which engines: the set of Δ",
            options=SETS,
            says={
                "norm_bounded": "Δ uniform in the ball of spectral norm one",
                "boundary": "Δ on its surface: every singular value is one",
                "structured": "diagonal Δ, each entry uniform in (-1, 1)",
                "equation_79": "the one Δ that the paper prints, its eq. (79)",
            },
        )
    }
    sites = tuple(
        Site(
            name=f"f{row + 1}",
            kind="component",
            additive=True,
            signal="f",
            row=row,
            unit_name="",
            admissible=1.0,
            limits_s=(5.0,),
        )
        for row in range(3)
    )
    parameters: tuple[Parameter, ...] = (
        Parameter(name="delta_scale_ratio", about="share of the drawn Δ; 0 is nominal", default=1.0, low=0.0, high=1.0),
        Parameter(name="input_scale_ratio", about="share of the inputs u", default=1.0, low=0.0, high=10.0),
        Parameter(name="disturbance_scale_ratio", about="share of the disturbances", default=1.0, low=0.0, high=10.0),
    )
    manoeuvres: Mapping[str, float] = DURATIONS_S
    commands = ("u_1", "u_2", "u_3")
    shown: tuple[str, ...] = ("f_true_1", "f_true_2", "f_true_3")
    limits_from = "our choice: 5 s for each fault"
    iterations = "robust_hinf_table1"
    matrices: Mapping[str, Floats] = MATRICES

    def loop(self, options: Options) -> JetEngineLoop:
        """Engine, faults and disturbances for these options."""
        if options.substeps != 1:
            raise FddbenchError(
                f"the jet engine is stepped exactly for its discretisation: remove substeps = {options.substeps}"
            )
        return JetEngineLoop(options, self.sites)

    def ideal(self, chosen: Mapping[str, Any], parameters: Mapping[str, Floats], sample_s: float) -> str:
        """Why no bound is stated: known engines leave the ideal test nothing to doubt."""
        del chosen, parameters, sample_s
        return (
            "no sensor noise, and disturbances held for 0.1 s: with Δ known two samples betray any fault, if only by 1e-8 "
            "of it, so a bound would say 100 % and nothing of what limits detectors"
        )
