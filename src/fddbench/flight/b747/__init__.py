"""Longitudinal physics of the Boeing 747-100/200: nonlinear model, trim, scheduling parameters and affine LPV model."""
