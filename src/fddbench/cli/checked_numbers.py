"""Numbers that arguments take, with what is said of others."""

import argparse

__all__ = ["flights", "jobs", "probability", "runs", "share"]


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
    if not text.isascii() or not text.isdigit() or not 1 <= int(text) <= 10_000:
        raise argparse.ArgumentTypeError(f"need a whole number from 1 to 10000, got {text!r}")
    return int(text)


def runs(text: str) -> int:
    """Number of Monte-Carlo runs."""
    if not text.isascii() or not text.isdigit() or not 1 <= int(text) <= 10_000_000:
        raise argparse.ArgumentTypeError(f"need a whole number from 1 to 10000000, got {text!r}")
    return int(text)


def jobs(text: str) -> int:
    """Number of workers."""
    if not text.isascii() or not text.isdigit() or not 1 <= int(text) <= 256:
        raise argparse.ArgumentTypeError(f"need a whole number from 1 to 256, got {text!r}")
    return int(text)
