"""What readers see instead of the names of columns."""

from fddbench.units import suffix_of_name, unit_of_name

__all__ = ["OUTCOMES", "label"]

OUTCOMES = {
    "right": "right in time", "quiet": "quiet", "late": "late", "undecided": "undecided", "missed": "missed",
    "wrong_site": "healthy site declared", "false_alarm": "alarm before onset",
}  # fmt: skip
"""Outcomes in words."""


def label(name: str) -> str:
    """Axis label of a signal or parameter, its unit taken from the name.

    >>> label("reconstruction_deg_s"), label("p_mass_kg"), label("n_declared"), label("f1_loss_percent")
    ('reconstruction [deg/s]', 'mass [kg]', 'n declared', 'fault 1 loss [%]')
    """
    name = name.removeprefix("p_")
    if name[:1] == "f" and name[1:2].isdigit() and "_" in name:
        number, _, rest = name[1:].partition("_")
        return f"fault {number} {label(f'p_{rest}')}"
    unit, suffix = unit_of_name(name), suffix_of_name(name)
    words = name.removesuffix(suffix).replace("_", " ")
    return f"{words} [{unit.replace('^2', '²')}]" if suffix else words
