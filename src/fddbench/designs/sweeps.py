"""Variants of a design: one detector for every value that a campaign sweeps a gain through."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pydantic import BaseModel, ValidationError

from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.swept import Sweep
from fddbench.campaign.rules.wording import Finding, say
from fddbench.designs.design import Design, SweptGain
from fddbench.errors import FddbenchError, Mistake, did_you_mean

__all__ = ["changed_gains", "variants"]


def variants(
    design: Design, sweeps: Mapping[str, Sweep], document: Document, address: Address
) -> tuple[list[Design], list[Mistake]]:
    """A design for every value of a sweep, and what is wrong with values that the kind refuses.

    Parameters
    ----------
    design : Design
        What is swept.
    sweeps : mapping of str to Sweep
        Values by the key of the gain; the entry of the campaign stands in the document at the address.
    """
    found: list[Design] = []
    mistakes: list[Mistake] = []
    for key, sweep in sweeps.items():
        at = (*address, "sweep", key)
        if sweep.scale is not None and not _can_be_scaled(design, key):
            mistakes.append(
                document.mistake(
                    at,
                    f"{key} of {design.name!r} holds no numbers; a sweep goes through numbers, write a design for each word",
                )
            )
            continue
        for number, (place, value) in enumerate(_placed(document, at, sweep)):
            try:
                gains = changed_gains(design, key, value, factor=sweep.scale is not None)
            except _NowhereError as error:
                mistakes.append(document.mistake(at, str(error), key=True))
                break
            except ValidationError as error:
                wrong = Mistake(place, f"{design.name} with {key} {_said(sweep, value)}: {_first(error)}")
                mistakes += [] if wrong in mistakes else [wrong]
                continue
            name, swept = f"{design.name}.{key}.{number + 1}", SweptGain(key, value, factor=sweep.scale is not None)
            found.append(replace(design, name=name, gains=gains, where=place, swept=swept))
    return found, mistakes


def changed_gains(design: Design, key: str, value: float, *, factor: bool = False) -> BaseModel:
    """Gains of a design with one of them at a value, or multiplied by a factor, checked by the kind.

    Raises
    ------
    FddbenchError
        The design has no such gain.
    pydantic.ValidationError
        The kind refuses the value.
    """
    change = (lambda old: _scaled(old, value)) if factor else (lambda _: _plain(value))
    data = _with(design.written, _dumped(design), tuple(key.split(".")), change, design.name, key)
    model: type[BaseModel] = design.kind.member.Gains
    return model.model_validate_json(json.dumps(data), strict=True)


class _NowhereError(FddbenchError):
    """A key leads to no gain."""


def _can_be_scaled(design: Design, key: str) -> bool:
    """Whether a gain holds numbers; one that is not there is told elsewhere."""
    held: list[Any] = []
    try:
        _with(design.written, _dumped(design), tuple(key.split(".")), held.append, design.name, key)
    except _NowhereError:
        return True
    return _is_numbers(held[0])


def _is_numbers(value: Any) -> bool:
    if isinstance(value, list):
        return bool(value) and all(map(_is_numbers, value))
    return isinstance(value, int | float) and not isinstance(value, bool)


def _dumped(design: Design) -> dict[str, Any]:
    """All gains as a file would write them, defaults included."""
    dumped: dict[str, Any] = json.loads(design.gains.model_dump_json(by_alias=True))
    return dumped


def _with(written: Any, whole: Any, parts: Sequence[str], change: Callable[[Any], Any], name: str, key: str) -> Any:
    """Copy of a block with one value changed; what the file leaves out is taken from the whole."""
    if not parts:
        return change(written)
    part, rest = parts[0], parts[1:]
    if isinstance(whole, list) and part.isascii() and part.isdigit() and int(part) < len(whole):
        n = int(part)
        inner = _with(written[n], whole[n], rest, change, name, key)
        return [*written[:n], inner, *written[n + 1 :]]
    if isinstance(whole, dict) and part in whole:
        inner = _with(written.get(part, whole[part]), whole[part], rest, change, name, key)
        return {**written, part: inner}
    raise _NowhereError(_no_gain(part, whole, name, key))


def _no_gain(part: str, whole: Any, name: str, key: str) -> str:
    """What to say of a key that leads nowhere."""
    known = (
        list(whole)
        if isinstance(whole, dict)
        else [str(n) for n in range(len(whole) if isinstance(whole, list) else 0)]
    )
    there = f"Known there: {', '.join(known)}" if known else "There is nothing inside"
    return " ".join(filter(None, [f"design {name!r} has no gain {key!r}.", did_you_mean(part, known), there]))


def _scaled(value: Any, factor: float) -> Any:
    """A number, or every number of a list, times a factor."""
    return [_scaled(each, factor) for each in value] if isinstance(value, list) else _plain(value * factor)


def _plain(value: float) -> float | int:
    """A number as a file writes it: a kind that wants whole numbers takes 3, not 3.0."""
    return int(value) if float(value).is_integer() else value


def _placed(document: Document, address: Address, sweep: Sweep) -> Iterator[tuple[str, float]]:
    """Every value with the place where the campaign says it."""
    listed: Mapping[str, Any] = document.mapping(*address)
    inside = next((name for name in ("grid", "scale") if name in listed), None)
    for number, value in enumerate(sweep.values):
        at = (*address, inside, number) if inside else address if listed else (*address, number)
        yield document.where(at), value


def _said(sweep: Sweep, value: float) -> str:
    return f"× {value:g}" if sweep.scale is not None else f"= {value:g}"


def _first(error: ValidationError) -> str:
    """The first finding of a kind, in words."""
    detail = error.errors(include_url=False)[0]
    finding = Finding(
        kind=detail["type"], received=detail["input"], context=detail.get("ctx", {}), text=detail["msg"],
        address=("gains", *detail["loc"]), allowed=(),
    )  # fmt: skip
    at = ".".join(map(str, detail["loc"]))
    return f"{at} {say(finding)}" if at else say(finding)
