"""The keys of a recipe that makes a `parity_space` of a linear plant, and the relations that they give."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from fddbench.design.parity import best_parity_vector, extended, parity_vectors
from fddbench.design.recipes.hinf_entries import Matrix
from fddbench.design.recipes.hinf_making import named_plant
from fddbench.design.recipes.recipe import Made, Recipe, short
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import DiscreteLti, StateSpace, UncertainPlant

__all__ = ["ParitySpaceRecipe"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class ParitySpaceRecipe(Recipe):
    """How the numbers of a `parity_space` design come about: for each fault the best relation blind to others.

    Attributes
    ----------
    plant : str, or mapping of str to matrix
        A benchmark with `matrices`, or the fields of `fddbench.systems.UncertainPlant` themselves.
    sample_s : float
        Clock [s]; the plant is discretised by Tustin's rule.
    order : int
        Order s of the relations; they look at s + 1 samples.
    decouple : list of "faults" and "disturbances"
        What relation i is blind to, whatever its course: the other faults, the disturbances.
    disturbance : float
        Standard deviation of a sample of the disturbances [-]; what is not decoupled is noise.
    state : float or None
        Standard deviation of each state before the window, which is then noise as well; None: any state, and the relations
        are blind to it. Slow states are nearly constant over a short window, and what is blind to them hardly sees a lasting
        fault.
    window_s, confirm_s : float
        Evaluation of the residuals, copied into the gains.
    """

    plant: str | dict[str, Matrix]
    sample_s: Positive
    order: Annotated[int, Field(ge=1, le=200)]
    decouple: tuple[Literal["faults", "disturbances"], ...] = ("faults",)
    disturbance: Positive
    state: Positive | None = None
    window_s: Positive
    confirm_s: NonNegative

    def make(self) -> Made:
        """Relations, scaled to read one for a lasting fault of one."""
        plant = named_plant(self.plant)
        rows, sizes = zip(*(self._relation(plant, i) for i in range(plant.Bf.shape[1])), strict=True)
        gains = {
            "sample_s": self.sample_s, "V": [row.tolist() for row in rows], "window_s": self.window_s,
            "confirm_s": self.confirm_s, "thresholds": [1.0] * len(rows), "estimates_faults": True,
        }  # fmt: skip
        return Made(gains=gains, found={"residual_std": [short(size) for size in sizes]})

    def _relation(self, plant: UncertainPlant, i: int) -> tuple[Floats, float]:
        """Row of V of fault i, newest sample first, and the standard deviation of its residual."""
        others = [j for j in range(plant.Bf.shape[1]) if j != i]
        unknown = {"faults": (plant.Bf[:, others], plant.Df[:, others]), "disturbances": (plant.Bd, plant.Dd)}
        E_x, E_y = (np.hstack([np.zeros((n, 0)), *(unknown[name][k] for name in self.decouple)])
                    for k, n in ((0, plant.n_x), (1, len(plant.C))))  # fmt: skip
        seen, H_d = self._window(plant, E_x, E_y)
        blind_to = seen if self.state is None else seen[:, :0]
        vectors = parity_vectors(blind_to, H_d, f"the {' and '.join(self.decouple) or 'state'} beside fault {i + 1}")
        lasting = self._window(plant, plant.Bf[:, [i]], plant.Df[:, [i]])[1].sum(axis=1)
        noise = np.hstack(
            [self._window(plant, plant.Bd, plant.Dd)[1] * self.disturbance, seen * (self.state or 0.0)]
        )  # fmt: skip
        scale = float(np.abs(vectors @ lasting).max())
        if scale < 1e-9:
            raise DesignError(
                f"recipe.order: no relation of order {self.order} sees a lasting fault {i + 1}; make it longer"
            )
        v, ratio = best_parity_vector(vectors, np.outer(lasting, lasting), noise @ noise.T)
        v = v / (v @ lasting)
        of_inputs = -v @ self._window(plant, plant.B, plant.D)[1]
        samples = [
            np.concatenate(pair)
            for pair in zip(_samples(v, len(plant.C)), _samples(of_inputs, plant.B.shape[1]), strict=True)
        ]
        return np.concatenate(samples[::-1]), float(1.0 / np.sqrt(ratio))

    def _window(self, plant: UncertainPlant, B: Floats, D: Floats) -> tuple[Floats, Floats]:
        """O and H of a window from some of the inputs, discretised."""
        system = DiscreteLti.of(StateSpace(plant.A, B, plant.C, D), self.sample_s)
        A, B, C, D = (M[..., 0] for M in (system.A, system.B, system.C, system.D))
        return extended(A, B, C, D, self.order)


def _samples(row: Floats, n: int) -> list[Floats]:
    """A row over the window, sample by sample, oldest first."""
    return [row[k : k + n] for k in range(0, len(row), n)]
