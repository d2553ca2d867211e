"""Sensor faults: what a campaign writes, and the one step that flies them all."""
