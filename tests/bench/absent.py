"""A peer that is not here, and why."""

from importlib import import_module
from types import ModuleType


class AbsentError(Exception):
    """This peer cannot fly here; its text says what is missing."""


def need(module: str) -> ModuleType:
    """A peer's module, or `AbsentError`."""
    try:
        return import_module(module)
    except ImportError as error:
        raise AbsentError(f'{module} is not installed; pip install -e ".[bench]"') from error
