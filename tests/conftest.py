"""Hypothesis everywhere: the same examples every time, and no deadline on a shared machine."""

from hypothesis import settings

settings.register_profile("steady", deadline=None, derandomize=True, database=None)
settings.load_profile("steady")
