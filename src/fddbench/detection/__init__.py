"""Detectors: residual generators and the logic that declares faults."""
