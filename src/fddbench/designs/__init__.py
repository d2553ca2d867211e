"""Tuned detectors: their files, their kinds, and whether they can fly."""
