"""The blocks of a recipe: references, weights and sets of plants as a file writes them, and what they make."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from fddbench.campaign.rules.model import Strict
from fddbench.design.uncertainty import Block, FullBlock, NormBounded, Polytope, RepeatedReal, Structured, Uncertainty
from fddbench.design.weights import Weights
from fddbench.errors import DesignError
from fddbench.systems import StateSpace, UncertainPlant

__all__ = ["Matrix", "ReferenceEntry", "Row", "UncertaintyEntry", "WeightsEntry", "plant_of", "spelled_out"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Count = Annotated[int, Field(ge=1)]
Row = Annotated[tuple[Number, ...], Field(min_length=1)]
Matrix = Annotated[tuple[Row, ...], Field(min_length=1)]
Matrices = dict[str, Matrix]


def spelled_out(recipe: Mapping[str, Any]) -> dict[str, Any]:
    """The recipe with its short forms as blocks: ``uncertainty: norm_bounded``, ``W_d: 2.0`` and ``W_d: [2.0, 1.0]``."""
    whole = dict(recipe)
    if isinstance(whole.get("uncertainty"), str):
        whole["uncertainty"] = {"set": whole["uncertainty"]}
    if isinstance(whole.get("weights"), dict):
        whole["weights"] = {name: _weight_block(value) for name, value in whole["weights"].items()}
    return whole


def _weight_block(value: Any) -> Any:
    """A number or a list of numbers as the block that it is short for."""
    if isinstance(value, bool):
        return value
    return {"gain": value} if isinstance(value, int | float) else {"d": value} if isinstance(value, list) else value


class _Diagonal(Strict):
    """First-order channels side by side, ``d_i + c_i b_i / (s - a_i)``; without a, b and c the constants d."""

    a: Row | None = None
    b: Row | None = None
    c: Row | None = None
    d: Row | None = None

    def diagonal(self, what: str) -> StateSpace:
        """Return it as a system; `what` it is, for messages."""
        given = [row for row in (self.a, self.b, self.c, self.d) if row is not None]
        if self.d is not None and len(given) == 1:
            return StateSpace.gain(np.diag(self.d))
        if len(given) < 4 or len({len(row) for row in given}) > 1:
            raise DesignError(f"{what} has d alone, or a, b, c and d of one length")
        return StateSpace.diagonal(*given)


class ReferenceEntry(_Diagonal):
    """Reference model, diagonal by a, b, c, d or any by its matrices.

    Attributes
    ----------
    a, b, c, d : numbers, one per fault
        ``d_i + c_i b_i / (s - a_i)``; without a, b and c the constant gain d.
    A, B, C, D : matrices
        ``x' = A x + B f, r = C x + D f``; without A, B and C the constant gain D. A triangular one suits faults that never
        come together: residual i need not be blind to the faults before it.
    """

    A: Matrix | None = None
    B: Matrix | None = None
    C: Matrix | None = None
    D: Matrix | None = None

    def system(self) -> StateSpace:
        """Return it as a system."""
        given = {name: getattr(self, name) for name in "ABCD" if getattr(self, name) is not None}
        if not given:
            return self.diagonal("a reference")
        if any(getattr(self, name) is not None for name in "abcd"):
            raise DesignError("a reference is diagonal by a, b, c, d or has matrices A, B, C, D, not both")
        if set(given) == {"D"}:
            return StateSpace.gain(_matrix("D", given["D"]))
        if len(given) < 4:
            raise DesignError(f"a reference has D alone, or A, B, C and D; got {', '.join(given)}")
        return StateSpace(*(_matrix(name, rows) for name, rows in given.items()))


class WeightEntry(_Diagonal):
    """Weight of signals: a number for all, numbers d, or first-order channels a, b, c, d with stable poles a."""

    gain: Number | None = None

    def system(self, name: str, n: int) -> StateSpace:
        """Return it as a system for n signals."""
        if self.gain is None:
            return self.diagonal(name)
        if any(getattr(self, letter) is not None for letter in "abcd"):
            raise DesignError(f"{name} has a gain alone, or d, or a, b, c and d")
        return StateSpace.gain(self.gain * np.eye(n))


class WeightsEntry(Strict):
    """Sizes of faults, disturbances and inputs, which γ weighs as unit signals otherwise.

    Attributes
    ----------
    W_f, W_d, W_u : WeightEntry
        A number, a list of numbers, or ``{a, b, c, d}``.
    """

    W_f: WeightEntry | None = None
    W_d: WeightEntry | None = None
    W_u: WeightEntry | None = None

    def weights(self, plant: UncertainPlant) -> Weights:
        """Return them for a plant."""
        sizes = dict(zip(("W_f", "W_d", "W_u"), plant.inputs, strict=True))
        entries = {name: getattr(self, name) for name in sizes}
        return Weights(**{name: e.system(name, sizes[name]) for name, e in entries.items() if e is not None})


class BlockEntry(Strict):
    """One block of a structured Δ: ``{repeated_real: n}`` is δ I of size n, ``{full: [rows, columns]}`` any matrix."""

    repeated_real: Count | None = None
    full: Annotated[tuple[Count, ...], Field(min_length=2, max_length=2)] | None = None

    def block(self) -> Block:
        """Return it as a block."""
        if (self.repeated_real is None) == (self.full is None):
            raise DesignError("a block of uncertainty.structured is {repeated_real: n} or {full: [rows, columns]}")
        return RepeatedReal(self.repeated_real) if self.repeated_real is not None else FullBlock(*(self.full or ()))


class UncertaintyEntry(Strict):
    """What is not known about the plant: ``norm_bounded``, ``{structured: [blocks]}`` or ``{polytope: [plants]}``.

    Attributes
    ----------
    set : {"norm_bounded"}
        Any Δ of norm one; the default.
    structured : list of BlockEntry
        Blocks down the diagonal of Δ.
    polytope : list of mapping of str to matrix
        Vertices: matrices of a plant, or ``{delta: matrix}``, the plant of the recipe at this Δ.
    """

    set: Literal["norm_bounded"] | None = None
    structured: Annotated[tuple[BlockEntry, ...], Field(min_length=1)] | None = None
    polytope: Annotated[tuple[Matrices, ...], Field(min_length=1)] | None = None

    def uncertainty(self, plant: UncertainPlant) -> Uncertainty:
        """Return it as a set of plants about one."""
        if sum(value is not None for value in (self.set, self.structured, self.polytope)) != 1:
            raise DesignError(
                "recipe.uncertainty is norm_bounded, {structured: [blocks]} or {polytope: [plants]}: one of them"
            )
        if self.structured is not None:
            return Structured(tuple(entry.block() for entry in self.structured))
        if self.polytope is not None:
            return Polytope(tuple(_vertex(number, given, plant) for number, given in enumerate(self.polytope)))
        return NormBounded()


def _vertex(number: int, given: Matrices, plant: UncertainPlant) -> UncertainPlant:
    """One vertex of a polytope."""
    where = f"recipe.uncertainty.polytope[{number}]"
    if "delta" not in given:
        return plant_of(given, where)
    if len(given) > 1:
        raise DesignError(f"{where} is the plant at one delta or has matrices of its own, not both: {', '.join(given)}")
    delta, (n_z, n_w) = _matrix("delta", given["delta"]), plant.H.shape
    if delta.shape != (n_w, n_z):
        raise DesignError(f"{where}: delta is {delta.shape}, the plant takes Δ of shape {(n_w, n_z)}")
    return plant.at(delta)


def plant_of(given: Mapping[str, Any], where: str) -> UncertainPlant:
    """Plant of matrices by name; `where` they stand, for messages."""
    known = list(UncertainPlant.__dataclass_fields__)
    unknown = set(given) - set(known)
    if unknown:
        raise DesignError(
            f"{where}: no matrix of a plant is called {', '.join(sorted(unknown))}; known: {', '.join(known)}"
        )
    try:
        return UncertainPlant(**{name: np.array(rows, dtype=float) for name, rows in given.items()})
    except (TypeError, ValueError) as error:
        raise DesignError(
            f"{where} makes no plant: {error}. A, Bf, Bd, B, C, Df, Dd and D are needed, as matrices with rows of "
            "equal length; the uncertainty channel is zero where it is not given"
        ) from error


def _matrix(name: str, rows: Matrix) -> Any:
    """Rows as an array."""
    if len({len(row) for row in rows}) > 1:
        raise DesignError(
            f"the rows of {name} have lengths {[len(row) for row in rows]}; a matrix has rows of one length"
        )
    return np.array(rows, dtype=float)
