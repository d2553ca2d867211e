"""Flight-path and speed tracking laws of the Boeing 747: H∞ synthesis, linear-quadratic, scheduled over the envelope."""
