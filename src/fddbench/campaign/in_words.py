"""What there is to name on a benchmark, in words: for `fddbench list` and for the schema of an editor."""

from typing import Any

from fddbench.interfaces import Choice, Parameter, Site

__all__ = ["option_in_words", "options_in_words", "parameter_in_words", "said", "site_in_words"]


def said(member: Any) -> str:
    """What a member says of itself: its `about`, or the first line of its docstring."""
    text = getattr(member, "about", "") or (getattr(member, "__doc__", None) or "").split("\n")[0]
    return str(text)


def option_in_words(member: Any) -> str:
    """What an option of a choice says of itself; of a preset of numbers, the numbers."""
    if getattr(member, "about", ""):
        return str(member.about)
    if isinstance(member, type):
        return said(member)
    fields = getattr(member, "__dataclass_fields__", {})
    given = {name: getattr(member, name) for name in fields if getattr(member, name) is not None}
    return ", ".join(f"{name} {value}" for name, value in given.items()) if given else said(member)


def options_in_words(choice: Choice) -> dict[str, str]:
    """What each option of a choice is."""
    return {name: choice.says.get(name) or option_in_words(member) for name, member in choice.options.items()}


def site_in_words(site: Site) -> str:
    """What a fault site is: where it sits, what 100 % is, its stops and its time limits."""
    unit = f" {site.unit_name}" if site.unit_name else ""
    limits = ", ".join(f"{limit:g} s" for limit in site.limits_s)
    parts = [f"{site.kind} on {site.signal}", f"100 % = {site.admissible:g}{unit}"]
    parts += [f"stops {site.stops[0]:g} … {site.stops[1]:g}{unit}"] if max(map(abs, site.stops)) < float("inf") else []
    parts += [f"to be found in {limits} (one, two, … faulty)" if len(site.limits_s) > 1 else f"to be found in {limits}"]
    return ", ".join(parts if site.limits_s else [*parts[:-1], "a scenario states the limit"])


def parameter_in_words(one: Parameter) -> str:
    """Default, range and meaning of a parameter."""
    return f"{one.default:g} ({one.low:g} … {one.high:g}), {one.about}"
