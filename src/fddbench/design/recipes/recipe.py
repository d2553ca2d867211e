"""What the recipes of all kinds have in common: keys that are read strictly, and a way to make gains of them."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import Field, PrivateAttr

from fddbench.campaign.rules.model import Strict
from fddbench.errors import DesignError

__all__ = ["Made", "Recipe", "RecipeError", "short"]


class RecipeError(DesignError):
    """Several keys of a recipe that do not go together, told at once."""

    def __init__(self, messages: tuple[str, ...]) -> None:
        super().__init__("\n".join(messages))
        self.messages = messages

    def __reduce__(self) -> tuple[type["RecipeError"], tuple[tuple[str, ...]]]:
        """From another process as it was."""
        return type(self), (self.messages,)


@dataclass(frozen=True)
class Made:
    """What a recipe gives.

    Attributes
    ----------
    gains : mapping
        Of the kind, with thresholds that nobody has tuned yet.
    found : mapping
        What is known of the design, for its file.
    """

    gains: Mapping[str, Any]
    found: Mapping[str, Any]


class Recipe(Strict):
    """Keys of a recipe; a member of the family "recipe" has the name of the kind that it makes designs of.

    Attributes
    ----------
    found : mapping
        Written by ``fddbench design``.
    """

    found: dict[str, Any] = Field(default_factory=dict)
    _beside: Path = PrivateAttr(default=Path())

    @classmethod
    def spelled_out(cls, written: Mapping[str, Any]) -> dict[str, Any]:
        """The recipe with its short forms, if it has any, as the blocks that they are short for."""
        return dict(written)

    @property
    def beside(self) -> Path:
        """Folder of the design file, where plug-ins that the recipe names lie."""
        return self._beside

    def in_folder(self, folder: Path) -> "Recipe":
        """The same recipe, which now knows the folder that its file lies in."""
        self._beside = folder
        return self

    def gamma_of(self, gains: Mapping[str, Any]) -> float | None:
        """γ that other gains of the kind have in the problem of this recipe; None: the recipe asks for none."""
        del gains
        return None

    @abstractmethod
    def make(self) -> Made:
        """Gains of the recipe, and what was found on the way.

        Raises
        ------
        FddbenchError
            Keys do not go together, or the recipe gives no design.
        """


def short(value: float) -> float:
    """Six digits: what solvers agree on."""
    return float(f"{value:.6g}")
