"""What a schema says of each key: its unit in the title, its meaning from the docstring of the model."""

import re
from inspect import getdoc
from typing import Any

from pydantic import BaseModel

from fddbench.units import unit_of_name

__all__ = ["about", "described", "titled"]

_ENTRY = re.compile(r"^(?P<names>[A-Za-z_][\w, ]*?)(?: : .*)?$")


def about(model: type[BaseModel]) -> str:
    """What a model is: its docstring up to the list of its keys."""
    return " ".join((getdoc(model) or "").split("\nAttributes\n")[0].split())


def titled(key: str, text: str = "") -> dict[str, str]:
    """Title of a key with its unit, and what it means.

    >>> titled("mass_kg", "aircraft mass")
    {'title': 'mass_kg [kg]', 'description': 'aircraft mass'}
    """
    unit = unit_of_name(key)
    title = {"title": f"{key} [{unit}]" if unit else key}
    return {**title, "description": text} if text else title


def described(schema: dict[str, Any], model: type[BaseModel]) -> dict[str, Any]:
    """Schema of a model with a title and a description for each of its keys, and the text of the model without them."""
    texts = _texts(model)
    fields = {field.alias or name: name for name, field in model.model_fields.items()}
    for key, value in schema.get("properties", {}).items():
        value.pop("title", None)
        value |= titled(key, texts.get(fields.get(key, key), ""))
    schema.pop("title", None)
    if about(model):
        schema["description"] = about(model)
    return schema


def _texts(model: type[BaseModel]) -> dict[str, str]:
    """Meaning by name of the field, as the docstrings of a model and of those that it stands on say."""
    found: dict[str, str] = {}
    for one in reversed(model.__mro__):
        if issubclass(one, BaseModel) and one is not BaseModel and one.__doc__:
            found |= _attributes(getdoc(one) or "")
    return found


def _attributes(text: str) -> dict[str, str]:
    """Entries of the section Attributes of a docstring."""
    if "\nAttributes\n" not in text:
        return {}
    lines = text.split("\nAttributes\n", 1)[1].splitlines()[1:]
    found: dict[str, list[str]] = {}
    names: list[str] = []
    for line in lines:
        entry = _ENTRY.match(line) if line and not line.startswith(" ") else None
        if entry:
            names = [name.strip() for name in entry["names"].split(",")]
            found |= {name: [] for name in names}
        elif line.startswith("    "):
            for name in names:
                found[name].append(line.strip())
        elif line:
            break  # the next section, or prose
    return {name: " ".join(words).replace("``", "") for name, words in found.items()}
