"""C text as a tree: comments and directives taken out, types that pycparser must know put in."""

import re
from typing import Any

from fddbench.errors import FddbenchError

__all__ = ["ReadBackError", "functions_of", "parsed"]

_TYPES = "typedef unsigned long uint64_t; typedef unsigned int uint32_t; typedef _Bool bool;\n"


class ReadBackError(FddbenchError):
    """C that does something an export never does."""


def parsed(*texts: str) -> Any:
    """Tree of some files, the header first.

    Raises
    ------
    ReadBackError
        It is no C, or pycparser is not installed.
    """
    try:
        from pycparser import c_parser
    except ImportError as error:
        raise ReadBackError("reading C back needs pycparser: pip install pycparser") from error
    text = re.sub(r"/\*.*?\*/", " ", "\n".join(texts), flags=re.DOTALL)
    text = re.sub(r"^\s*#.*$", "", text, flags=re.MULTILINE)
    try:
        return c_parser.CParser().parse(_TYPES + text)
    except Exception as error:
        raise ReadBackError(f"this is no C that can be read: {error}") from error


def functions_of(tree: Any) -> dict[str, Any]:
    """Definitions of functions by name."""
    return {node.decl.name: node for node in tree.ext if type(node).__name__ == "FuncDef"}
