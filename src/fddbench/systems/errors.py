"""What systems refuse: matrices and signals that do not fit each other."""

from dataclasses import dataclass

from fddbench.errors import DesignError

__all__ = ["MisfitError"]


@dataclass(eq=False)
class MisfitError(DesignError):
    """Matrices make no system, or systems cannot be connected: their sizes differ, or a loop has no solution."""
