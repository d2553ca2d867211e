"""What is not known about a plant: a ball of Δ, a structured Δ, or a polytope of plants."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import UncertainPlant

__all__ = [
    "Block",
    "FullBlock",
    "NormBounded",
    "Polytope",
    "RepeatedReal",
    "Structured",
    "Uncertainty",
    "block_diagonal",
    "blocks_of",
    "sample_delta",
]


class Block(Protocol):
    """One block of Δ = diag(...), equation (6); its norm is at most one."""

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""

    def sample(self, random: np.random.Generator) -> Floats:
        """Draw a Δ of the block, mostly on the boundary."""

    def steepest(self, gradient: Floats) -> Floats:
        """Return the Δ of the block that maximises ``trace(gradientᵀ Δ)``; one of its extreme points."""


@dataclass(frozen=True)
class FullBlock:
    """Any real (rows, columns) matrix of spectral norm ≤ 1."""

    rows: int
    columns: int

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.rows, self.columns

    def sample(self, random: np.random.Generator) -> Floats:
        """Half of the draws are orthogonal, a quarter has one large singular value, a quarter lies inside."""
        left, _, right = np.linalg.svd(random.standard_normal(self.shape), full_matrices=False)
        values = np.ones(min(self.shape))
        kind = random.integers(4)
        if kind == 2:
            values *= random.random(len(values))
        elif kind == 3:
            values[1:] = random.random(len(values) - 1)
        return np.asarray((left * values) @ right)

    def steepest(self, gradient: Floats) -> Floats:
        """Polar factor of the gradient."""
        left, _, right = np.linalg.svd(gradient, full_matrices=False)
        return np.asarray(left @ right)


@dataclass(frozen=True)
class RepeatedReal:
    """``δ I`` of the given size with a real ``|δ| ≤ 1``."""

    size: int = 1

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.size, self.size

    def sample(self, random: np.random.Generator) -> Floats:
        """Half of the draws are ±1."""
        inside, sign = random.uniform(-1.0, 1.0), random.choice([-1.0, 1.0])
        return np.eye(self.size) * (sign if random.random() < 0.5 else inside)

    def steepest(self, gradient: Floats) -> Floats:
        """±1 by the sign of the trace."""
        return np.eye(self.size) * (1.0 if np.trace(gradient) >= 0.0 else -1.0)


@dataclass(frozen=True)
class NormBounded:
    """Any real Δ with ‖Δ‖ ≤ 1; Lemma 4, necessary and sufficient."""


@dataclass(frozen=True)
class Structured:
    """Δ = diag(blocks) with ‖Δ‖ ≤ 1, equation (6); Lemma 5, sufficient.

    Attributes
    ----------
    blocks : tuple of Block
        In the order of the columns of FA and the rows of EA.
    """

    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Polytope:
    """The convex hull of plants, equation (7); Lemma 6, necessary and sufficient.

    Attributes
    ----------
    vertices : tuple of UncertainPlant
        Plants of the same sizes without an uncertainty channel of their own.
    """

    vertices: tuple[UncertainPlant, ...]

    def __post_init__(self) -> None:
        """Refuse an empty hull, vertices of different sizes and vertices that are uncertain themselves."""
        if not self.vertices:
            raise DesignError("a polytope needs at least one vertex, got none.")
        first = self.vertices[0]
        for number, vertex in enumerate(self.vertices):
            for name in ("A", "Bf", "Bd", "B", "C", "Df", "Dd", "D"):
                ours, theirs = getattr(vertex, name).shape, getattr(first, name).shape
                if ours != theirs:
                    raise DesignError(
                        f"{name} of vertex {number} has shape {ours} but {name} of vertex 0 has shape {theirs}."
                    )
            if vertex.FA.size or vertex.EA.size:
                raise DesignError(
                    f"vertex {number} has an uncertainty channel FA, EA of its own; give vertices as plant.at(Δ)."
                )


Uncertainty = NormBounded | Structured | Polytope


def blocks_of(uncertainty: NormBounded | Structured, plant: UncertainPlant) -> tuple[Block, ...]:
    """Blocks of Δ for the channel of `plant`; refuses blocks that do not fill it, () for a certain plant."""
    n_z, n_w = plant.H.shape
    if isinstance(uncertainty, NormBounded):
        return (FullBlock(n_w, n_z),) if n_z and n_w else ()
    rows, columns = (sum(block.shape[axis] for block in uncertainty.blocks) for axis in (0, 1))
    if (rows, columns) != (n_w, n_z):
        raise DesignError(
            f"the blocks {uncertainty.blocks} make Δ of shape {(rows, columns)}, but FA {plant.FA.shape} and "
            f"EA {plant.EA.shape} need Δ of shape {(n_w, n_z)}: columns of FA by rows of EA."
        )
    return uncertainty.blocks


def block_diagonal(blocks: list[Floats]) -> Floats:
    """Δ = diag(blocks), of shape (0, 0) when there are none."""
    rows, columns = (sum(block.shape[axis] for block in blocks) for axis in (0, 1))
    whole, row, column = np.zeros((rows, columns)), 0, 0
    for block in blocks:
        whole[row : row + block.shape[0], column : column + block.shape[1]] = block
        row, column = row + block.shape[0], column + block.shape[1]
    return whole


def sample_delta(blocks: tuple[Block, ...], count: int, seed: int) -> Floats:
    """`count` draws of Δ, (count, n_w, n_z); the first is zero, the nominal plant."""
    random = np.random.default_rng(seed)
    draws = [block_diagonal([block.sample(random) for block in blocks]) for _ in range(count)]
    draws[:1] = [np.zeros_like(draws[0])] if draws else []
    return np.array(draws)
