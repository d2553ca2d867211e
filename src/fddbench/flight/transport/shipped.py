"""The shipped aircraft's file, and its numbers as they stand there.

Who needs a few numbers only, like the limits of flight, is spared the model that judges an aircraft: making it takes longer
than all else in a small campaign that flies another plant. Tests hold that the model says the same.
"""

from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import yaml

__all__ = ["SHIPPED", "shipped_numbers"]

SHIPPED = Path(__file__).parent / "data" / "twin_jet.yaml"
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@cache
def shipped_numbers() -> Any:
    """Parts and numbers as attributes, named as in `fddbench.flight.transport.aircraft.Aircraft`; nothing is checked."""
    return _spaces(yaml.load(SHIPPED.read_text(encoding="utf-8"), Loader=_LOADER))


def _spaces(data: Any) -> Any:
    return SimpleNamespace(**{name: _spaces(part) for name, part in data.items()}) if isinstance(data, dict) else data
