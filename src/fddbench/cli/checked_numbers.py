"""Numbers that arguments take, with what is said of others."""

import argparse

__all__ = ["flights", "jobs", "probability", "runs", "seed", "share"]


def share(text: str) -> float:
    """Share of flights."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value < 1.0:
        raise argparse.ArgumentTypeError(f"need a share from 0 to below 1, e.g. 0.01 for 1 %, got {text!r}")
    return value


def probability(text: str) -> float:
    """Probability of a false alarm."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 < value < 1.0:
        raise argparse.ArgumentTypeError(f"need a probability above 0 and below 1, e.g. 1e-6, got {text!r}")
    return value


def flights(text: str) -> int:
    """Number of flights."""
    return _whole(text, 1, 10_000)


def jobs(text: str) -> int:
    """Number of workers."""
    return _whole(text, 1, 256)


def runs(text: str) -> int:
    """Number of Monte-Carlo runs."""
    return _whole(text, 1, 10_000_000)


def seed(text: str) -> int:
    """Seed of a draw."""
    return _whole(text, 0, 2**64 - 1)


def _whole(text: str, least: int, most: int) -> int:
    digits = text.isascii() and text.isdigit() and len(text) <= len(str(most))  # longer ones take int too long
    if not digits or not least <= int(text) <= most:
        raise argparse.ArgumentTypeError(f"need a whole number from {least} to {most}, got {text!r}")
    return int(text)
