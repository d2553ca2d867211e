"""Scheduling parameters from what is measured: one file an aircraft."""
