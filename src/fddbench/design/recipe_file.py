"""The keys of a recipe in a design file and what values they take."""

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from fddbench.campaign.rules.model import Strict
from fddbench.errors import DesignError
from fddbench.systems import StateSpace

__all__ = ["Recipe", "ReferenceEntry"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Row = Annotated[tuple[Number, ...], Field(min_length=1)]
_SECOND_STEP = 0.02


class ReferenceEntry(Strict):
    """Diagonal reference model ``d_i + c_i b_i / (s - a_i)``.

    Attributes
    ----------
    a, b, c, d : numbers, one per fault
        Without a, b and c the constant gain d.
    """

    a: Row | None = None
    b: Row | None = None
    c: Row | None = None
    d: Row

    def system(self) -> StateSpace:
        """Return it as a system."""
        a, b, c, d = self.a, self.b, self.c, self.d
        if a is None and b is None and c is None:
            return StateSpace.gain(np.diag(d))
        if a is None or b is None or c is None or not len(a) == len(b) == len(c) == len(d):
            raise DesignError("a reference has d alone, or a, b, c and d of one length")
        return StateSpace.diagonal(a, b, c, d)


class Recipe(Strict):
    """How the numbers of a `hinf_filter` design come about.

    Attributes
    ----------
    plant : str, or mapping of str to matrix
        A benchmark with `matrices`, or the fields of `fddbench.systems.UncertainPlant` themselves.
    method : {"fixed_reference", "free_reference", "exact_inverse"}
        `synthesize`, `optimize_reference` (Algorithm 1 from this reference), or ``r = Df⁻¹ (y - C x̂ - D u)``.
    reference : ReferenceEntry
        The identity when left out.
    relax : float
        How much larger than the optimum γ of the filter that flies may be [-].
    window_s, confirm_s : float
        Evaluation of the residuals, copied into the gains.
    found : mapping
        Written by the command: γ of this filter, the optimum, the lower bound, margins of the certificate.
    """

    plant: str | dict[str, tuple[Row, ...]]
    method: Literal["fixed_reference", "free_reference", "exact_inverse"]
    reference: ReferenceEntry | None = None
    relax: Annotated[float, Field(gt=0.0, le=1.0)] = _SECOND_STEP
    window_s: Annotated[float, Field(gt=0.0)]
    confirm_s: Annotated[float, Field(ge=0.0)]
    found: dict[str, Any] = Field(default_factory=dict)
