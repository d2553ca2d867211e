"""From the recipe in a design file to its numbers: what ``fddbench design`` runs."""

import json
import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from fddbench import kinds
from fddbench.campaign.reading.document import Address, Document, refuse
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.campaign.rules.messages import mistakes_of
from fddbench.design.recipes.recipe import Made, Recipe, RecipeError
from fddbench.designs.design_file import DesignFile, design_text
from fddbench.errors import DesignError

__all__ = ["Cooked", "cook", "recipe_of"]


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
    document = _document(path)
    recipe = _recipe(path, document)
    made = _made(recipe.in_folder(path.parent), document)
    data = {key: document.data[key] for key in ("kind", "about", "source") if key in document.data}
    written = {**document.data["recipe"], "found": dict(made.found)}
    data |= {"tuned_on": None, "recipe": written, "gains": dict(made.gains)}
    return Cooked(design_text(data), made.gains, made.found, recipe.found)


def recipe_of(path: Path) -> Recipe:
    """Recipe of a design file, with every mistake of the file told."""
    return _recipe(path, _document(path)).in_folder(path.parent)


def _document(path: Path) -> Document:
    document = read_yaml(path)
    if not isinstance(document.data, dict) or not isinstance(document.get("recipe"), dict):
        raise DesignError(
            f"{path} has no recipe. Add `recipe:` with the keys of its kind; the shipped detectors/hinf_identity.yaml and "
            "detectors/lpv_filter_approx.yaml are examples."
        )
    return document


def _made(recipe: Recipe, document: Document) -> Made:
    """Gains of the recipe; what it refuses is said with its place in the file."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what comes of numbers that are too large is refused below
            return recipe.make()
    except DesignError as error:
        texts = error.messages if isinstance(error, RecipeError) else (error.message,)
        raise DesignError("\n".join(f"{document.where(_address(document, text))}: {text}" for text in texts)) from error
    except (ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
        raise DesignError(
            f"{document.where(('recipe',))}: the numbers of this recipe give no design ({error}): they are too large, too "
            "small or too far apart. Choose units in which they are about one"
        ) from error


def _address(document: Document, text: str) -> Address:
    """What a refusal is about: the key ``recipe.…`` that it starts with, or the fault that it names; else the recipe."""
    if key := re.match(r"recipe(?:\.\w+)+", text):
        return tuple(key[0].split("."))
    fault = re.search(r"fault '([^']+)'", text)
    blocks = [key for key in ("faults", "blind_to") if fault and fault[1] in document.mapping("recipe", key)]
    return ("recipe", blocks[0], fault[1]) if fault and blocks else ("recipe",)


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
