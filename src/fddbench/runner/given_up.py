"""Detectors that fail always and are not flown to the end."""

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["GivenUp"]

_LONGEST = 200


@dataclass(frozen=True, kw_only=True)
class GivenUp:
    """A detector that failed on all of the first flights with the same error at the same line.

    Attributes
    ----------
    reasons : mapping of int to str
        What it raised on each of those flights, by case.
    """

    reasons: Mapping[int, str]

    @property
    def said(self) -> str:
        """Reason of all other rows."""
        text = f"given up: on each of the first {len(self.reasons)} flights {next(iter(self.reasons.values()))}"
        return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."

    def reason(self, case: int) -> str:
        """Reason of the row of a case."""
        return self.reasons.get(case, self.said)
