"""From the recipe in a design file to its numbers: what ``fddbench design`` runs."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from fddbench import kinds
from fddbench.campaign.reading.document import Document, refuse
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.campaign.rules.messages import mistakes_of
from fddbench.design.recipes.recipe import Recipe
from fddbench.designs.design_file import DesignFile, design_text
from fddbench.errors import DesignError

__all__ = ["Cooked", "cook"]


@dataclass(frozen=True)
class Cooked:
    """A design made anew: text of its file, its gains, what was found now, and what the file said before."""

    text: str
    gains: Mapping[str, Any]
    found: Mapping[str, Any]
    before: Mapping[str, Any]


def cook(path: Path) -> Cooked:
    """Design of the recipe in a design file, its thresholds untuned.

    Raises
    ------
    FddbenchError
        The file has no recipe, mistakes in it, or the recipe gives no design.
    """
    document = read_yaml(path)
    if not isinstance(document.data, dict) or not isinstance(document.get("recipe"), dict):
        raise DesignError(
            f"{path} has no recipe. Add `recipe:` with the keys of its kind; the shipped detectors/hinf_identity.yaml and "
            "detectors/lpv_filter_approx.yaml are examples."
        )
    recipe = _recipe(path, document)
    made = recipe.in_folder(path.parent).make()
    data = {key: document.data[key] for key in ("kind", "about", "source") if key in document.data}
    written = {**document.data["recipe"], "found": dict(made.found)}
    data |= {"tuned_on": None, "recipe": written, "gains": dict(made.gains)}
    return Cooked(design_text(data), made.gains, made.found, recipe.found)


def _recipe(path: Path, document: Document) -> Recipe:
    """The recipe as its kind reads it, with every mistake of the file told."""
    kind = document.get("kind")
    if kind not in kinds.known("recipe"):
        raise DesignError(
            f"{path} is a design of kind {kind!r}; recipes make designs of the kinds {', '.join(kinds.known('recipe'))}"
        )
    model = kinds.load("recipe", kind)
    mistakes, recipe = [], None
    try:
        DesignFile.model_validate_json(json.dumps(document.data), strict=True)
    except ValidationError as error:
        mistakes += mistakes_of(error, document, model=DesignFile)
    try:
        recipe = model.model_validate_json(json.dumps(model.spelled_out(document.mapping("recipe"))), strict=True)
    except ValidationError as error:
        mistakes += mistakes_of(error, document, model=model, at=("recipe",))
    refuse(mistakes)
    assert isinstance(recipe, Recipe)
    return recipe
