"""What a campaign would do, before it burns an hour of two processors."""

from collections.abc import Sequence
from pathlib import Path

from fddbench.blocks import llvm
from fddbench.campaign.check import describe
from fddbench.campaign.load import read_campaign
from fddbench.runner.assembling import assemble
from fddbench.runner.chunks import CHUNK, COMPILED_CHUNK
from fddbench.runner.flight import Flyer
from fddbench.runner.load import seconds_in_python

__all__ = ["described"]

# measured: compiled code flies some 1e7 samples a second on one core, after a start of about 1 s
_COMPILED_S, _NUMPY_S, _NUMPY_CALL_S = 1e-7, 1e-6, 1e-3


def described(path: str | Path, overrides: Sequence[str] = ()) -> str:
    """Text of what would fly, which detectors fly in Python, and how long it takes here.

    Raises
    ------
    CampaignError
        Every mistake in the campaign and its designs.
    """
    assembly = assemble(read_campaign(Path(path), overrides))
    plan = assembly.plan
    if not llvm.available():
        return describe(plan, seconds_per_flight_step=_NUMPY_S, overhead_s=_NUMPY_CALL_S, chunk=CHUNK)
    chunk = min(COMPILED_CHUNK, max(scenario.n_cases for scenario in plan.scenarios))
    bus, notes, overhead_s = assembly.loop.bus, [], 0.0
    for name, reason in Flyer(assembly).opaque.items():
        seconds = seconds_in_python(assembly.detectors[name], bus, chunk)
        overhead_s += seconds
        notes.append(
            f"{name} cannot be compiled and flies in Python, {1e3 * seconds:.2g} ms a sample and chunk: {reason}"
        )
    return describe(plan, seconds_per_flight_step=_COMPILED_S, overhead_s=overhead_s, chunk=chunk, notes=notes)
