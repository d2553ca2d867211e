"""The geometry of detection filters: subspaces, invariance, and residual generators that are blind by construction.

Affine families A(rho) = A_0 + rho_1 A_1 + ... throughout; a system without parameters is one of a single matrix.
"""

from fddbench.design.geometric.bank import residual_generator
from fddbench.design.geometric.generator import ResidualGenerator, identity_error
from fddbench.design.geometric.invariance import invariant_subspace, unobservability_subspace
from fddbench.design.geometric.solvability import Solvability, solvability
from fddbench.design.geometric.subspaces import (
    TOLERANCE,
    complement,
    contains,
    image,
    intersection,
    inverse_image,
    kernel,
    sine,
    subspace_sum,
)

__all__ = [
    "TOLERANCE", "ResidualGenerator", "Solvability", "complement", "contains", "identity_error", "image", "intersection",
    "invariant_subspace", "inverse_image", "kernel", "residual_generator", "sine", "solvability", "subspace_sum",
    "unobservability_subspace",
]  # fmt: skip
