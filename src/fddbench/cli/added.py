"""How a command is added: its docstring is its help."""

import argparse
from collections.abc import Callable
from inspect import cleandoc
from textwrap import fill

__all__ = ["add"]

_WIDTH = 78
"""Columns of help: those of a terminal of 80, less what argparse keeps free."""


def add(subs, name: str, command: Callable[[argparse.Namespace], int]) -> argparse.ArgumentParser:  # type: ignore[no-untyped-def]
    """Parser of a command."""
    paragraphs = cleandoc(command.__doc__ or "").split("\n\n")
    text = "\n\n".join(fill(" ".join(each.split()), _WIDTH) for each in paragraphs)
    added: argparse.ArgumentParser = subs.add_parser(
        name,
        help=paragraphs[0].replace("%", "%%"),
        description=text,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    added.set_defaults(command=command)
    return added
