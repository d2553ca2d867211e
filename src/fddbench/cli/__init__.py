"""The command line: parse, call one function, print, exit code."""

from fddbench.cli.main import entry, main

__all__ = ["entry", "main"]
