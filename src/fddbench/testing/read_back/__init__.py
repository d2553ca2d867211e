"""Exported C read back by a parser of its own: whether it is the detector, operation by operation, for all inputs."""

from fddbench.testing.read_back.proof import Proof, prove

__all__ = ["Proof", "prove"]
