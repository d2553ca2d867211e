"""How a campaign says what differs from flight to flight: distributions, grids, sequences."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from fddbench.campaign.rules.keys import Count, Number, Positive, Strict, Values

__all__ = ["Dispersions", "Distribution", "MonteCarlo", "Normal", "TruncatedNormal"]


class Normal(Strict):
    """A bell curve.

    Attributes
    ----------
    mean, std : float
        In the unit of the parameter.
    """

    mean: Number
    std: Positive


class TruncatedNormal(Normal):
    """A bell curve, drawn again until it falls into a window.

    Attributes
    ----------
    low, high : float
        The window, in the unit of the parameter.
    """

    low: Number
    high: Number


class Distribution(Strict):
    """How a parameter is drawn; one of the three.

    Attributes
    ----------
    uniform : (low, high)
        In the unit of the parameter.
    normal, truncated_normal : mapping
        In the unit of the parameter.
    """

    uniform: Annotated[tuple[Number, ...], Field(min_length=2, max_length=2)] | None = None
    normal: Normal | None = None
    truncated_normal: TruncatedNormal | None = None


class MonteCarlo(BaseModel):
    """Flights drawn at random; every other key is a parameter.

    Attributes
    ----------
    runs : int
        Draws for each point of grid and sequence.
    sampling : {"random", "sobol", "halton", "lhs"}
        Independent draws; low-discrepancy points by the number of the run; a Latin hypercube of all runs, which fixes them.
    table : str, optional
        CSV or Parquet file beside the campaign with explicit cases: a column a parameter, a row a run.
    correlation : list of [parameter, parameter, coefficient]
        Of the bell curves behind two draws (a Gaussian copula).
    """

    model_config = ConfigDict(extra="allow", frozen=True)
    __pydantic_extra__: dict[str, Distribution]

    runs: Count
    sampling: Literal["random", "sobol", "halton", "lhs"] = "random"
    table: str | None = None
    correlation: tuple[tuple[str, str, Number], ...] = ()

    @property
    def plain(self) -> bool:
        """Whether every parameter is drawn by itself, at random."""
        return self.sampling == "random" and self.table is None and not self.correlation

    @property
    def parameters(self) -> dict[str, Distribution]:
        """Distribution by name of the parameter."""
        return dict(self.__pydantic_extra__ or {})


class Dispersions(Strict):
    """What differs from flight to flight.

    Attributes
    ----------
    grid : mapping of parameter to values
        Every combination is flown.
    sequence : mapping of parameter to values
        Lists of one length, walked together.
    monte_carlo : MonteCarlo
        Drawn at random.
    """

    grid: dict[str, Values] = Field(default_factory=dict)
    sequence: dict[str, Values] = Field(default_factory=dict)
    monte_carlo: MonteCarlo | None = None
