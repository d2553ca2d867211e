"""What to say about each kind of wrong value: what was received with which unit, and what is allowed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from fddbench.campaign.reading.document import Address
from fddbench.errors import did_you_mean
from fddbench.units import unit_of_name

__all__ = ["Finding", "say", "shown", "unit_of"]

_LONGEST_SHOWN = 60


def unit_of(address: Address) -> str:
    """Units that the keys of an address carry, e.g. ``" [deg/s]"``, or the empty string.

    >>> unit_of(("monte_carlo", "mass_kg", "uniform", 0)), unit_of(("seed",))
    (' [kg]', '')
    """
    for part in reversed(address):
        unit = unit_of_name(part) if isinstance(part, str) else ""
        if unit:
            return f" [{unit}]"
    return ""


def shown(value: Any) -> str:
    """Received value in words, not too long."""
    if value is None:
        return "nothing (null)"
    if isinstance(value, dict):
        return "a mapping of keys" if value else "an empty mapping"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}" if value else "an empty list"
    if isinstance(value, bool):
        return "true" if value else "false"
    text = repr(value)
    text = text if len(text) <= _LONGEST_SHOWN else text[:_LONGEST_SHOWN] + "…"
    return f"the text {text}" if isinstance(value, str) else text


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A value that pydantic refuses.

    Attributes
    ----------
    kind, text : str
        Pydantic's name of the mistake, and its message.
    received : object
        The value.
    context : mapping
        Bounds, choices or the original error.
    address : Address
        Where it stands.
    allowed : tuple of str
        Keys of the block expected there; empty where a plain value is.
    """

    kind: str
    received: Any
    context: Mapping[str, Any]
    text: str
    address: Address
    allowed: tuple[str, ...]


def say(finding: Finding) -> str:
    """Message for the engineer."""
    return _WORDINGS.get(finding.kind, _as_pydantic_says)(finding)


def _number(finding: Finding) -> str:
    unit = unit_of(finding.address)
    whole = "a whole number" if finding.kind.startswith("int") else "a number"
    remedy = ". The key carries the unit: write the number alone" if unit and isinstance(finding.received, str) else ""
    return f"expected {whole}{unit}, got {shown(finding.received)}{remedy}"


def _bound(finding: Finding) -> str:
    sign = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}
    limits = [f"{sign[key]} {value}" for key, value in finding.context.items() if key in sign]
    return f"must be {' and '.join(limits)}{unit_of(finding.address)}, got {finding.received!r}"


def _choice(finding: Finding) -> str:
    choices = finding.context.get("expected", "")
    names = [name.strip("' ") for name in choices.replace(" or ", ",").split(",")]
    close = did_you_mean(finding.received, names) if isinstance(finding.received, str) else ""
    return f"must be {choices}, got {shown(finding.received)}" + (f". {close}" if close else "")


def _name(finding: Finding) -> str:
    return (
        f"{finding.received!r} is no name. A name starts with a letter or digit and has letters, digits, "
        "'.', '_' and '-' only, at most 64; it becomes a file name"
    )


def _length(finding: Finding) -> str:
    ctx = finding.context
    least, most = ctx.get("min_length"), ctx.get("max_length")
    need = f"at least {least} of them" if most is None else f"at most {most}"
    if finding.address[-1:] in (("uniform",), ("log_uniform",)):
        need = "exactly [low, high]"
    return f"needs {need}{unit_of(finding.address)}, got {shown(finding.received)}"


def _text(finding: Finding) -> str:
    remedy = "" if finding.received is None or isinstance(finding.received, dict | list) else "; put it in quotes"
    return f"expected text, got {shown(finding.received)}{remedy}"


def _block(finding: Finding) -> str:
    keys = f" ({', '.join(finding.allowed)})" if finding.allowed else ""
    return f"expected a mapping of keys{keys}, got {shown(finding.received)}"


def _list(finding: Finding) -> str:
    return f"expected a list{unit_of(finding.address)}, got {shown(finding.received)}"


def _own_words(finding: Finding) -> str:
    return str(finding.context.get("error", finding.text))


def _as_pydantic_says(finding: Finding) -> str:
    message = finding.text
    return f"{message[:1].lower()}{message[1:]}{unit_of(finding.address)}, got {shown(finding.received)}"


_Wording = Callable[[Finding], str]
_WORDINGS: dict[str, _Wording] = {
    **dict.fromkeys(("float_type", "float_parsing", "int_type", "int_parsing", "int_from_float"), _number),
    **dict.fromkeys(("greater_than", "greater_than_equal", "less_than", "less_than_equal"), _bound),
    **dict.fromkeys(("too_short", "too_long"), _length),
    **dict.fromkeys(("model_type", "model_attributes_type", "dict_type"), _block),
    **dict.fromkeys(("tuple_type", "list_type"), _list),
    "literal_error": _choice,
    "string_pattern_mismatch": _name,
    "string_type": _text,
    "value_error": _own_words,
}
