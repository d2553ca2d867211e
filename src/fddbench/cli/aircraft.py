"""The command that shows what an aircraft is like."""

import argparse

__all__ = ["modes"]


def modes(args: argparse.Namespace) -> int:
    """Show trim and natural modes of the aircraft with six degrees of freedom over its envelope.

    Linearised numerically, without its laws, at the 108 points of Table 5 of the yaw-rate paper; angles in deg, modes in
    rad/s or 1/s, control anticipation parameter in 1/(g s^2).
    """
    from fddbench.api.aircraft import modes as table

    found = table(args.aircraft)
    shown = found[found["infeasible_reason"] == ""] if args.feasible else found
    print(
        shown.to_string(index=False, float_format=lambda value: f"{value:.3g}" if abs(value) < 100 else f"{value:.0f}")
    )
    return 0
