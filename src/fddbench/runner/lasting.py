"""What is kept of flights themselves while they are flown with NumPy."""

from typing import Any

from fddbench.interfaces import Floats, Sample
from fddbench.runner.assembly import Assembly, Batch

__all__ = ["ConsequenceFlight"]


class ConsequenceFlight:
    """What is kept of the flights of a batch themselves, fed with what the loop shows sample by sample."""

    def __init__(self, assembly: Assembly, batch: Batch) -> None:
        self.consequences, n_cases = assembly.consequences, len(batch.cases)
        self.constants = assembly.scoring.constants.unpack(batch.score_constants)
        self.state = self.consequences.states.spread(self.consequences.start(), n_cases)

    def step(self, seen: Sample, sample: float, departed: Floats) -> None:
        """Take one more sample."""
        c = self.constants
        when: dict[str, Any] = {"k0": c.k0, "last": c.last, "sample": sample, "alive": sample < departed}
        self.state = self.consequences.step(self.state, seen.truth, **when)

    def rows(self) -> Floats:
        """All that is kept, (n_rows, n_cases)."""
        packed: Floats = self.consequences.states.pack(self.state, len(self.constants.k0))
        return packed
