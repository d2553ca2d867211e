"""Detectors that fail always and are not flown to the end."""

from dataclasses import dataclass

__all__ = ["GivenUp", "GivenUps"]

_LONGEST = 200


@dataclass(frozen=True, kw_only=True)
class GivenUp:
    """A detector that failed on all of the first flights with the same error at the same line.

    Attributes
    ----------
    reasons : tuple of (int, str)
        Each of those cases, and what the detector raised on it.
    """

    reasons: tuple[tuple[int, str], ...]

    @property
    def said(self) -> str:
        """Reason of all other rows."""
        text = f"given up: on each of the first {len(self.reasons)} flights {self.reasons[0][1]}"
        return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."

    def reason(self, case: int) -> str:
        """Reason of the row of a case."""
        return dict(self.reasons).get(case, self.said)


GivenUps = tuple[tuple[str, GivenUp], ...]
"""Detectors that are given up, by name: plain data that crosses to workers."""
