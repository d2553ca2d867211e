"""What a word in a campaign means: the YAML 1.2 core rules, where ``1e-3`` is a number and ``on`` is a word."""

import math
import re

__all__ = ["Scalar", "resolve"]

Scalar = str | int | float | bool | None

_LONGEST_NUMBER = 60
_NULL = frozenset({"", "~", "null", "Null", "NULL"})
_BOOL = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_INT = re.compile(r"[-+]?[0-9]+")
_BASED = re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")


def resolve(text: str) -> Scalar:
    """Value of an unquoted word by the YAML 1.2 core schema.

    Raises
    ------
    ValueError
        The word is a number that is not finite or has too many digits.

    Examples
    --------
    >>> [resolve(word) for word in ("1e-3", "010", "on", "true", "0x1F", "12:30", "~")]
    [0.001, 10, 'on', True, 31, '12:30', None]
    """
    if text in _NULL:
        return None
    if text in _BOOL:
        return _BOOL[text]
    if _NOT_FINITE.fullmatch(text):
        raise ValueError(f"{text} is not a number that can be flown; write a finite one")
    if _INT.fullmatch(text) or _BASED.fullmatch(text) or _FLOAT.fullmatch(text):
        return _number(text)
    return text


def _number(text: str) -> int | float:
    if len(text) > _LONGEST_NUMBER:
        raise ValueError(f"a number of {len(text)} characters; at most {_LONGEST_NUMBER} are read")
    if _INT.fullmatch(text):
        return int(text, 10)
    if _BASED.fullmatch(text):
        return int(text, 0)
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text} is beyond the largest number, 1.8e308; write a finite one")
    return value
