"""The design of a recipe with one of its keys changed: what a trade-off between the numbers of a recipe is made of."""

import copy
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.design.recipe import Cooked, cook
from fddbench.errors import DesignError, did_you_mean

__all__ = ["changed_design"]


def changed_design(path: Path, key: str, value: Any, output: Path) -> Cooked:
    """Make the design of a recipe with one key at another value, and write it.

    Parameters
    ----------
    path : Path
        Design file with a recipe.
    key : str
        Key of the recipe, dots between levels: ``filter_pole_1_s``, ``weights.corruption``, ``scheme.input_lag_s``.
    value : anything that YAML can hold
    output : Path
        Where the new file goes; what the recipe names beside the old one must lie beside it too.

    Raises
    ------
    FddbenchError
        The recipe has no such key, or it gives no design with this value.
    """
    data = copy.deepcopy(read_yaml(path).data)
    if not isinstance(data, dict) or not isinstance(data.get("recipe"), dict):
        raise DesignError(f"{path} has no recipe, so that nothing in it can be changed")
    data["recipe"].pop("found", None)
    block, parts = data["recipe"], key.split(".")
    for depth, part in enumerate(parts):
        if not isinstance(block, dict) or (part not in block and len(parts) > 1):
            _refuse(path, key, parts[: depth + 1], block)
        if depth < len(parts) - 1:
            block = block[part]
    block[parts[-1]] = value  # one of the recipe itself may have its default so far: its kind tells of misspelt ones
    data["about"] = f"{data.get('about') or path.stem}; {key} = {_said(value)}"
    output.write_text(yaml.safe_dump(data | {"gains": {}}, sort_keys=False, allow_unicode=True), encoding="utf-8")
    cooked = cook(output)
    output.write_text(cooked.text, encoding="utf-8")
    return cooked


def _refuse(path: Path, key: str, parts: Sequence[str], block: Any) -> None:
    known = sorted(block) if isinstance(block, dict) else []
    raise DesignError(
        f"the recipe of {path} has no key {'.'.join(parts)!r}, asked for as {key!r}. {did_you_mean(parts[-1], known)} "
        f"Known there: {', '.join(known) or 'nothing'}"
    )


def _said(value: Any) -> str:
    """Short text of a value."""
    return yaml.safe_dump(value, default_flow_style=True, width=10_000).strip().removesuffix("...").strip()
