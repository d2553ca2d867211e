"""What readers see instead of the names of columns."""

import re

from fddbench.units import suffix_of_name, unit_of_name

__all__ = ["OUTCOMES", "label", "of_a_fault"]

OUTCOMES = {
    "right": "right in time", "quiet": "quiet", "late": "late", "undecided": "undecided", "missed": "missed",
    "wrong_site": "healthy site declared", "false_alarm": "alarm before onset",
}  # fmt: skip
"""Outcomes in words."""


def of_a_fault(name: str) -> bool:
    """Whether a column holds a number of a fault, one that is drawn or swept.

    >>> of_a_fault("f1_loss_percent"), of_a_fault("fault"), of_a_fault("p_f1_ratio")
    (True, False, False)
    """
    return re.match(r"f\d+_", name) is not None


def label(name: str) -> str:
    """Axis label of a signal or parameter, its unit taken from the name.

    >>> label("reconstruction_deg_s"), label("p_mass_kg"), label("n_declared"), label("f1_loss_percent")
    ('reconstruction [deg/s]', 'mass [kg]', 'n declared', 'fault 1 loss [%]')
    """
    name = name.removeprefix("p_")
    if of_a_fault(name):
        number, _, rest = name[1:].partition("_")
        return f"fault {number} {label(f'p_{rest}')}"
    unit, suffix = unit_of_name(name), suffix_of_name(name)
    words = name.removesuffix(suffix).replace("_", " ")
    return f"{words} [{unit.replace('^2', '²')}]" if suffix else words
