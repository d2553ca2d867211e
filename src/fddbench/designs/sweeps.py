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

__all__ = ["changed_gains", "gain_of", "variants", "with_gains"]


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
        if design.code:
            mistakes.append(
                document.mistake(at, f"{design.name!r} flies the C of {design.code}, whose numbers are in the C")
            )
            continue
        if sweep.scale is not None and not _can_be_scaled(design, key):
            mistakes.append(
                document.mistake(
                    at,
                    f"{key} of {design.name!r} holds no numbers; a sweep goes through numbers, write a design for each word",
                )
            )
            continue
        for number, (place, value) in enumerate(_placed(document, at, sweep)):
            name, swept = f"{design.name}.{key}.{number + 1}", SweptGain(key, value, factor=sweep.scale is not None)
            try:
                made = with_gains(design, changed_gains(design, key, swept.applied), name)
            except _NowhereError as error:
                mistakes.append(document.mistake(at, str(error), key=True))
                break
            except ValidationError as error:
                wrong = Mistake(place, f"{design.name} with {key} {_said(sweep, value)}: {_first(error)}")
                mistakes += [] if wrong in mistakes else [wrong]
                continue
            found.append(replace(made, where=place, swept=swept))
    return found, mistakes


def changed_gains(design: Design, key: str, change: Callable[[Any], Any]) -> dict[str, Any]:
    """Gains of a design as its file writes them, one of them changed; what the file leaves out has its default.

    Parameters
    ----------
    key : str
        Key of the gain; one inside others by dots, an item of a list by its number from 0.
    change : callable
        Makes the new value of the old one.

    Raises
    ------
    FddbenchError
        The design has no such gain.
    """
    changed: dict[str, Any] = _with(design.written, _dumped(design), tuple(key.split(".")), change, design.name, key)
    return changed


def gain_of(design: Design, key: str) -> Any:
    """What a design has as this gain, as a file writes it.

    Raises
    ------
    FddbenchError
        The design has no such gain.
    """
    held: list[Any] = []
    changed_gains(design, key, held.append)
    return held[0]


def with_gains(design: Design, written: Mapping[str, Any], name: str) -> Design:
    """Design of another name with these gains, checked by the kind.

    Raises
    ------
    pydantic.ValidationError
        The kind refuses them.
    """
    model: type[BaseModel] = design.kind.member.Gains
    gains = model.model_validate_json(json.dumps(written), strict=True)
    return replace(design, name=name, gains=gains, written=written)


class _NowhereError(FddbenchError):
    """A key leads to no gain."""


def _can_be_scaled(design: Design, key: str) -> bool:
    """Whether a gain holds numbers; one that is not there is told elsewhere."""
    try:
        return _is_numbers(gain_of(design, key))
    except _NowhereError:
        return True


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
